//! What a brush carries.

use maulstick_brush::BrushFile;
use maulstick_types::Mixture;

use crate::quantum::{Counts, QUANTUM_M, SLOTS};

/// The paint on a brush: counts by slot, spread as one film over the head's surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrushLoad {
    counts: Counts,
}

impl BrushLoad {
    /// A clean brush.
    #[must_use]
    pub fn clean() -> Self {
        Self { counts: [0; SLOTS] }
    }

    /// Counts by slot.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// All counts.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Takes all paint off.
    pub fn take_all(&mut self) -> Counts {
        std::mem::replace(&mut self.counts, [0; SLOTS])
    }

    /// Takes `amount` of a slot off; the caller has seen that it is there.
    pub fn take(&mut self, slot: usize, amount: u64) {
        self.counts[slot] -= amount;
    }

    /// Fills a clean brush from tubes and returns what they gave: the film of the brush file over
    /// the head's surface, divided by the mixture's shares, in cells of `cell_m`.
    pub fn fill(&mut self, file: &BrushFile, mixture: &[(usize, f64)], cell_m: f64) -> Counts {
        let whole = file.load.film_um * 1e-6 / QUANTUM_M * head_cells(file, cell_m);
        let mut given = [0; SLOTS];
        for (slot, share) in mixture {
            given[*slot] += (whole * share) as u64;
        }
        crate::quantum::add(&mut self.counts, &given);
        given
    }

    /// Thickness of the film, in units.
    #[must_use]
    pub fn film_units(&self, head_cells: f64) -> f64 {
        self.total() as f64 / (crate::quantum::QUANTA_PER_UNIT * head_cells)
    }
}

/// The head's surface in cells.
#[must_use]
pub fn head_cells(file: &BrushFile, cell_m: f64) -> f64 {
    file.surface_m2() / (cell_m * cell_m)
}

/// A mixture by slots.
pub fn by_slot<E>(
    mixture: &Mixture,
    mut slot: impl FnMut(&str) -> Result<usize, E>,
) -> Result<Vec<(usize, f64)>, E> {
    mixture
        .parts
        .iter()
        .map(|part| Ok((slot(&part.paint)?, part.share)))
        .collect()
}
