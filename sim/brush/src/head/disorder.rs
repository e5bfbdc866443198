//! Disorder of the bristles. It changes with each stroke, so that no two have the same streaks or ends, and along it:
//! tresses part and regroup within some centimetres, so that no streak goes on to the end.

use super::{Head, STATIONS, place_along, smoothstep};
use crate::file::BrushFile;
use crate::file::sections::Hair;

/// Width of a tress of bristles that stray together, by half the head's width.
const TRESS: f32 = 0.16;
/// Greatest offset of a tress of hog bristles and of soft hair, by half the head's width and thickness there.
const STRAY: [f32; 2] = [0.08, 0.015];
/// Shortening of the shortest bristle of hog and of soft hair, by the head's length.
const RAGGED: [f64; 2] = [0.02, 0.006];
/// Additional shortening of a single bristle at the rim, by its own.
const RIM: f32 = 4.0;
/// Power of the place from the middle to the rim by which that grows.
const RIM_POWER: i32 = 8;
/// Way along which tresses regroup, m.
const REGROUPS_M: f64 = 25e-3;
/// Numbers of the planes of noise: across the width, across the thickness, along.
const PLANES: [u64; 3] = [11, 12, 13];

/// How far the strips of a head stray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Straying {
    /// True for a blade, whose strips never shift.
    pub(super) rigid: bool,
    /// Share of a single bristle's variation that a strip keeps: one over the number of bristles it stands for.
    single_share: f32,
    /// Greatest offset of a tress, by half the head's width and thickness there.
    stray: f32,
    /// Shortening of the shortest bristle, m.
    ragged_m: f32,
}

impl Straying {
    pub(super) fn of(file: &BrushFile) -> Self {
        let soft = usize::from(file.head.hair != Hair::Hog);
        // The bristles of a pointed brush cling to each other.
        let blunt = (file.radius_m(1.0) / file.radius_m(0.0)).min(1.0);
        Self {
            rigid: file.head.hair == Hair::Steel,
            single_share: (1.0 / file.strips.stands_for) as f32,
            stray: STRAY[soft],
            ragged_m: (RAGGED[soft] * blunt * file.length_m()) as f32,
        }
    }
}

impl Head {
    /// Share of a single bristle's variation that a strip keeps, which stands for several.
    #[must_use]
    pub fn single_share(&self) -> f32 {
        self.straying.single_share
    }

    /// This head with its bristles in the disorder of a seed, after a way of the stroke in m; seed 0 leaves them as in
    /// the brush file.
    #[must_use]
    pub fn disordered(&self, seed: u64, way_m: f64) -> Self {
        let mut head = self.clone();
        let Straying {
            rigid,
            single_share,
            stray,
            ragged_m,
        } = self.straying;
        if rigid || seed == 0 {
            return head;
        }
        let turns = way_m / REGROUPS_M;
        let (turn, part) = (turns.floor(), smoothstep(turns - turns.floor()) as f32);
        let seeds = [0, 1].map(|next| seed ^ ((turn as u64 + next) << 40));
        let regrouped = |of: &dyn Fn(u64) -> f32| {
            let [before, after] = seeds.map(of);
            before + (after - before) * part
        };
        for (strip, root) in self.roots.iter().enumerate() {
            let place = [root[0] / TRESS, root[1] / TRESS];
            let [across, aside, along] =
                PLANES.map(|plane| regrouped(&|seed| noise(seed ^ (plane << 32), place)));
            let single = regrouped(&|seed| unit(seed, [strip as i64, i64::MAX]));
            let rim = root[0].abs().max(root[1].abs()).powi(RIM_POWER);
            let single = (0.5 + single_share * (single - 0.5)) * (1.0 + RIM * rim);
            let stray = [across, aside].map(|v| stray * (2.0 * v - 1.0));
            let shorter = ragged_m * 0.5 * (along + single);
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
