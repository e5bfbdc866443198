//! Random numbers of a seed.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

/// Random numbers of a seed.
pub(crate) struct Random(Pcg32);

impl Random {
    /// Those of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg32::new(seed, 0x6669_6c6c))
    }

    /// A number in 0..1.
    pub(crate) fn chance(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / (f64::from(u32::MAX) + 1.0)
    }

    /// A number of mean 0 and this standard deviation, within twice that: of a sum of twelve even ones.
    pub(crate) fn about(&mut self, deviation: f64) -> f64 {
        let sum: f64 = (0..12).map(|_| self.chance()).sum();
        deviation * (sum - 6.0).clamp(-2.0, 2.0)
    }

    /// A number below `count`, which is above 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.chance() * count as f64) as usize).min(count - 1)
    }
}
