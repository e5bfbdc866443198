//! Lateness of ticks, in bins of a microsecond like the peer's.

use std::collections::BTreeMap;

/// Counts of ticks by how many whole microseconds they were late.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Histogram {
    counts: BTreeMap<u64, u64>,
}

impl Histogram {
    /// Adds ticks that were late by `us` and less than one more.
    pub(super) fn add(&mut self, us: u64, ticks: u64) {
        *self.counts.entry(us).or_default() += ticks;
    }

    /// Number of ticks.
    pub(super) fn ticks(&self) -> u64 {
        self.counts.values().sum()
    }

    /// Lateness not exceeded by a share of the ticks, µs, with the ticks spread evenly over their bin.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        let wanted = share * self.ticks() as f64;
        let mut before = 0.0;
        for (us, ticks) in &self.counts {
            let ticks = *ticks as f64;
            if before + ticks >= wanted && ticks > 0.0 {
                return *us as f64 + (wanted - before) / ticks;
            }
            before += ticks;
        }
        f64::NAN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantile_lies_within_the_bin_that_holds_it() {
        let mut histogram = Histogram::default();
        for (us, ticks) in [(17, 2), (20, 6), (1192, 2)] {
            histogram.add(us, ticks);
        }
        assert_eq!(histogram.ticks(), 10);
        for (share, us) in [(0.1, 17.5), (0.2, 18.0), (0.5, 20.5), (0.9, 1192.5)] {
            let found = histogram.quantile(share);
            assert!((found - us).abs() < 1e-12, "{share}: {found}, not {us}");
        }
        assert!(Histogram::default().quantile(0.5).is_nan());
    }
}
