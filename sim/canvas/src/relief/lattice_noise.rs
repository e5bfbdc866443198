//! Smooth noise from a seed: the same bytes on every machine.

use std::array;
use std::cell::Cell;

/// Number of channels.
const CHANNELS: usize = 32;
/// Number of neighbouring lines of a channel whose corners are kept.
const LINES: usize = 4;

/// The values at the corners of a lattice square.
#[derive(Clone, Copy, Debug, Default)]
struct Corners {
    /// Its lower left corner; `None` before any is known.
    at: Option<[i64; 2]>,
    /// Lower left, lower right, upper left, upper right.
    values: [f64; 4],
}

/// Value noise on lattices of side 1, with [`CHANNELS`] independent channels. The corners of the last squares are kept:
/// the next place mostly lies between them again.
#[derive(Debug)]
pub(crate) struct LatticeNoise {
    /// Seed of all values.
    seed: u64,
    last: [Cell<Corners>; CHANNELS * LINES],
}

impl LatticeNoise {
    /// The noise of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        let last = array::from_fn(|_| Cell::default());
        Self { seed, last }
    }

    /// Noise at a place, 0 to 1.
    #[must_use]
    pub(crate) fn at(&self, channel: u64, [x, y]: [f64; 2]) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (ease(x - i), ease(y - j));
        let [low, low_right, high, high_right] = self.corners(channel, [i as i64, j as i64]);
        let (below, above) = (low + (low_right - low) * u, high + (high_right - high) * u);
        below + (above - below) * v
    }

    /// Noise along the line of number `line`, 0 to 1; lines are independent.
    #[must_use]
    pub(crate) fn along(&self, channel: u64, line: i64, x: f64) -> f64 {
        let i = x.floor();
        let [from, to, ..] = self.corners(channel, [i as i64, line]);
        from + (to - from) * ease(x - i)
    }

    /// The values of the square with this lower left corner.
    fn corners(&self, channel: u64, [i, j]: [i64; 2]) -> [f64; 4] {
        let kept = &self.last[channel as usize * LINES + j.rem_euclid(LINES as i64) as usize];
        let known = kept.get();
        if known.at == Some([i, j]) {
            return known.values;
        }
        let values =
            [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[di, dj]| self.hash(channel, [i + di, j + dj]));
        kept.set(Corners {
            at: Some([i, j]),
            values,
        });
        values
    }

    /// A number in 0 to 1 for each lattice point (finaliser of Murmur 3, Appleby).
    #[must_use]
    pub(crate) fn hash(&self, channel: u64, [i, j]: [i64; 2]) -> f64 {
        let mut h = self.seed ^ channel.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        for v in [i as u64, j as u64] {
            h = (h ^ v).wrapping_mul(0xff51_afd7_ed55_8ccd);
            h ^= h >> 33;
            h = h.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
            h ^= h >> 33;
        }
        (h >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

/// Eases t from 0 to 1, level at both ends.
#[must_use]
pub(crate) fn ease(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}
