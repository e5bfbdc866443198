//! The ledger: origin and whereabouts of all paint.
//!
//! Tube, cleaner and the brush modes that create or remove paint are booked at every transfer; brush, canvas and
//! palette are counted from their planes. The paint from tubes and modes must be in the others to the quantum.

use std::collections::BTreeMap;

use maulstick_canvas::quantum::{BySlot, Counts, SLOTS, add};
use serde::Serialize;

/// Booked paint.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Ledger {
    tube: BySlot<u64>,
    cleaner: BySlot<u64>,
    /// Paint given by modes less paint taken by them; a conversion to another paint model takes one paint and gives as
    /// much of another.
    #[serde(default)]
    mode: BySlot<i64>,
}

impl Ledger {
    /// A mode gave, or took where it is negative.
    pub fn from_mode(&mut self, counts: &[i64; SLOTS]) {
        let pairs = self.mode.iter_mut().zip(counts);
        pairs.for_each(|(own, count)| *own += count);
    }

    /// Books paint from a mode.
    pub fn from_mode_counts(&mut self, counts: &Counts) {
        self.from_mode(&counts.map(|count| count as i64));
    }

    /// Books paint from the tubes.
    pub fn from_tube(&mut self, counts: &Counts) {
        add(&mut self.tube, counts);
    }

    /// Paint booked since `before`; negative where it was taken back.
    #[must_use]
    pub fn since(&self, before: &Self) -> Booked {
        let less = |own: &Counts, before: &Counts| {
            let less: [i64; SLOTS] =
                std::array::from_fn(|slot| own[slot] as i64 - before[slot] as i64);
            less.into()
        };
        Booked {
            tube: less(&self.tube, &before.tube),
            cleaner: less(&self.cleaner, &before.cleaner),
            mode: std::array::from_fn(|slot| self.mode[slot] - before.mode[slot]).into(),
        }
    }

    /// True if [`book`](Self::book) leaves no account negative.
    #[must_use]
    pub(crate) fn can_book(&self, booked: &Booked, times: i64) -> bool {
        let covers = |own: &Counts, booked: &[i64; SLOTS]| {
            let mut pairs = own.iter().zip(booked);
            pairs.all(|(own, booked)| own.checked_add_signed(times * booked).is_some())
        };
        covers(&self.tube, &booked.tube) && covers(&self.cleaner, &booked.cleaner)
    }

    /// Repeats bookings with `times` 1, or reverses them with −1.
    pub fn book(&mut self, booked: &Booked, times: i64) {
        let turn = |own: &mut Counts, booked: &[i64; SLOTS]| {
            for (own, booked) in own.iter_mut().zip(booked) {
                *own = own.saturating_add_signed(times * booked);
            }
        };
        turn(&mut self.tube, &booked.tube);
        turn(&mut self.cleaner, &booked.cleaner);
        self.from_mode(&booked.mode.map(|count| times * count));
    }

    /// Expected paint by slot: that from tubes and modes less that to the cleaner.
    #[must_use]
    pub fn due(&self) -> [i64; SLOTS] {
        std::array::from_fn(|slot| {
            let given = (self.tube[slot] as i64).wrapping_add(self.mode[slot]);
            given.wrapping_sub(self.cleaner[slot] as i64)
        })
    }

    /// Books paint to the cleaner.
    pub fn to_cleaner(&mut self, counts: &Counts) {
        add(&mut self.cleaner, counts);
    }
}

/// Paint booked over a period, by slot.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Booked {
    tube: BySlot<i64>,
    cleaner: BySlot<i64>,
    #[serde(default)]
    mode: BySlot<i64>,
}

impl Booked {
    /// Expected gain by slot: paint from tubes and modes less paint to the cleaner.
    #[must_use]
    pub fn due(&self) -> [i64; SLOTS] {
        std::array::from_fn(|slot| {
            let given = self.tube[slot].wrapping_add(self.mode[slot]);
            given.wrapping_sub(self.cleaner[slot])
        })
    }

    /// Adds later bookings.
    pub fn add(&mut self, later: &Self) {
        let sum = |own: &mut [i64; SLOTS], later: &[i64; SLOTS]| {
            own.iter_mut()
                .zip(later)
                .for_each(|(own, later)| *own += later);
        };
        sum(&mut self.tube, &later.tube);
        sum(&mut self.cleaner, &later.cleaner);
        sum(&mut self.mode, &later.mode);
    }
}

/// Counted paint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Stocks {
    /// On all brushes.
    pub brush: BySlot<u64>,
    /// On the canvas.
    pub canvas: BySlot<u64>,
    /// On the palette.
    pub palette: BySlot<u64>,
    /// Dried, on canvas and palette.
    pub dry: BySlot<u64>,
}

/// The ledger as a file; volumes in m³, with those from tubes and modes negative, so that all accounts sum to zero.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LedgerReport {
    /// Volume of all paints by account, m³.
    pub accounts_m3: BTreeMap<&'static str, f64>,
    /// Volume by paint and account, m³.
    pub paints_m3: BTreeMap<String, BTreeMap<&'static str, f64>>,
    /// Paint given by tubes and modes less paint found, quanta; 0, or paint was created or destroyed.
    pub quanta_missing: i64,
    /// Steps of the paint model.
    pub steps: u64,
    /// Cells that footprints covered, summed over the steps.
    pub footprint_cells: u64,
    /// Cells of the canvas with paint on them.
    pub covered_cells: u64,
    /// Time of the performance from its first to its last state, s.
    pub seconds: f64,
}

/// The other figures of a report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tallies {
    /// As [`LedgerReport::steps`].
    pub steps: u64,
    /// As [`LedgerReport::footprint_cells`].
    pub footprint_cells: u64,
    /// As [`LedgerReport::covered_cells`].
    pub covered_cells: u64,
    /// As [`LedgerReport::seconds`].
    pub seconds: f64,
}

/// Balances the books. `names` are the paints by slot, `quantum_m3` is a quantum's volume.
#[must_use]
pub(crate) fn balance(
    ledger: &Ledger,
    stocks: &Stocks,
    names: &[String],
    quantum_m3: f64,
    tallies: Tallies,
) -> LedgerReport {
    let accounts: [(&'static str, &Counts); 5] = [
        ("brush", &stocks.brush),
        ("canvas", &stocks.canvas),
        ("palette", &stocks.palette),
        ("dry", &stocks.dry),
        ("cleaner", &ledger.cleaner),
    ];
    let volume = |count: u64| count as f64 * quantum_m3;
    let sum = |counts: &Counts| counts.iter().sum::<u64>();
    let negative = |count: u64| if count == 0 { 0.0 } else { -volume(count) };
    // Paint given by a mode is negative, like that of a tube.
    let from_mode = |count: i64| match count {
        0 => 0.0,
        count => -(count as f64) * quantum_m3,
    };
    let row = |tube: u64, mode: i64, found: &dyn Fn(&Counts) -> u64| {
        let given = [("tube", negative(tube)), ("mode", from_mode(mode))];
        let found = accounts
            .iter()
            .map(|(name, counts)| (*name, volume(found(counts))));
        given.into_iter().chain(found).collect()
    };
    let paints_m3 = names.iter().enumerate().take(SLOTS).map(|(slot, name)| {
        let own = row(ledger.tube[slot], ledger.mode[slot], &|counts| counts[slot]);
        (name.clone(), own)
    });
    // Slot by slot, so that too much of one paint cannot hide too little of another.
    let quanta_missing = (0..SLOTS)
        .map(|slot| {
            let found: u64 = accounts.iter().map(|(_, counts)| counts[slot]).sum();
            ledger.tube[slot] as i64 + ledger.mode[slot] - found as i64
        })
        .max_by_key(|missing| missing.abs())
        .unwrap_or(0);
    LedgerReport {
        accounts_m3: row(sum(&ledger.tube), ledger.mode.iter().sum(), &sum),
        paints_m3: paints_m3.collect(),
        quanta_missing,
        steps: tallies.steps,
        footprint_cells: tallies.footprint_cells,
        covered_cells: tallies.covered_cells,
        seconds: tallies.seconds,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_missing_quantum_is_seen() {
        let mut ledger = Ledger::default();
        let mut given = [0; SLOTS];
        (given[0], given[1]) = (1000, 7);
        ledger.from_tube(&given);
        let mut stocks = Stocks::default();
        (stocks.canvas[0], stocks.brush[0], stocks.palette[1]) = (600, 400, 7);
        let names = ["A".to_owned(), "B".to_owned()];
        let report = |stocks: &Stocks| balance(&ledger, stocks, &names, 1e-18, Tallies::default());
        assert_eq!(report(&stocks).quanta_missing, 0);
        let total: f64 = report(&stocks).accounts_m3.values().sum();
        assert!(total.abs() < 1e-30);
        stocks.canvas[0] -= 1;
        assert_eq!(report(&stocks).quanta_missing, 1);
        (stocks.canvas[0], stocks.palette[1]) = (601, 6);
        assert_ne!(
            report(&stocks).quanta_missing,
            0,
            "one paint does not stand in for another"
        );
    }
}
