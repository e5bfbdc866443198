//! Disorder of the bristles. It changes with each stroke, so that no two have the same streaks or ends.

use super::{Head, STATIONS, place_along, smoothstep};

/// Width of a tress of bristles that stray together, by half the head's width.
const TRESS: f32 = 0.16;
/// Greatest offset of a tress, by half the head's width and thickness there.
const STRAY: f32 = 0.04;
/// Shortening of the shortest bristle, by the head's length.
const RAGGED: f32 = 0.01;
/// Numbers of the planes of noise: across the width, across the thickness, along.
const PLANES: [u64; 3] = [11, 12, 13];

impl Head {
    /// This head with its bristles in the disorder of a seed; seed 0 leaves them as in the brush file.
    #[must_use]
    pub fn disordered(&self, seed: u64) -> Self {
        let mut head = self.clone();
        if self.rigid || seed == 0 {
            return head;
        }
        // The bristles of a pointed brush cling to each other.
        let blunt = self.half_m[STATIONS - 1][0] / self.half_m[0][0];
        let length = self.length_m as f32;
        for (strip, root) in self.roots.iter().enumerate() {
            let place = [root[0] / TRESS, root[1] / TRESS];
            let [across, aside, along] = PLANES.map(|plane| noise(seed ^ (plane << 32), place));
            let single = unit(seed, [strip as i64, i64::MAX]);
            let stray = [across, aside].map(|v| STRAY * (2.0 * v - 1.0));
            let shorter = RAGGED * blunt.min(1.0) * length * 0.5 * (along + single);
            for station in 0..STATIONS {
                let at = place_along(station);
                let bent = smoothstep(at) as f32;
                let i = station * self.strips + strip;
                head.closed[0][i] += bent * stray[0] * self.half_m[station][0];
                head.closed[1][i] += bent * stray[1] * self.half_m[station][1];
                head.closed[2][i] += at as f32 * shorter;
            }
        }
        head
    }
}

/// Smooth noise on a lattice of side 1, 0 to 1.
#[must_use]
pub fn noise(seed: u64, [x, y]: [f32; 2]) -> f32 {
    let (i, j) = (x.floor(), y.floor());
    let ease = |t: f32| t * t * (3.0 - 2.0 * t);
    let (u, v) = (ease(x - i), ease(y - j));
    let corner = |di: i64, dj: i64| unit(seed, [i as i64 + di, j as i64 + dj]);
    let row = |dj: i64| corner(0, dj) + (corner(1, dj) - corner(0, dj)) * u;
    row(0) + (row(1) - row(0)) * v
}

/// Hash of a place as a number in 0 to 1 (finaliser of Murmur 3, Appleby).
#[must_use]
pub fn unit(seed: u64, place: [i64; 2]) -> f32 {
    let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d;
    for v in place {
        h = (h ^ v as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
        h ^= h >> 33;
        h = h.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        h ^= h >> 33;
    }
    (h >> 40) as f32 / 16_777_216.0
}
