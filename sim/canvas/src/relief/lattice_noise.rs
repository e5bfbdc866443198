//! Smooth noise from a seed: the same bytes on every machine.

/// Value noise on lattices of side 1, with independent channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LatticeNoise {
    /// Seed of all values.
    pub(crate) seed: u64,
}

impl LatticeNoise {
    /// Noise at a place, 0 to 1.
    #[must_use]
    pub(crate) fn at(&self, channel: u64, [x, y]: [f64; 2]) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (ease(x - i), ease(y - j));
        let corner = |di: i64, dj: i64| self.hash(channel, [i as i64 + di, j as i64 + dj]);
        let row = |dj: i64| corner(0, dj) + (corner(1, dj) - corner(0, dj)) * u;
        row(0) + (row(1) - row(0)) * v
    }

    /// Noise along the line of number `line`, 0 to 1; lines are independent.
    #[must_use]
    pub(crate) fn along(&self, channel: u64, line: i64, x: f64) -> f64 {
        let i = x.floor();
        let [from, to] = [0, 1].map(|di| self.hash(channel, [i as i64 + di, line]));
        from + (to - from) * ease(x - i)
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
