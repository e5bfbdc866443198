//! Disorder of the bristles. It changes with each stroke, so that no two have the same streaks or ends, and along it:
//! tresses part and regroup within some centimetres, so that no streak goes on to the end.

use std::sync::Arc;

use super::{Head, STATIONS, place_along, smoothstep};
use crate::file::BrushFile;
use crate::file::sections::Hair;

/// Width of a tress of bristles that stray together, by half the head's width.
const TRESS: f32 = 0.16;
/// Greatest offset of a tress of hog bristles and of soft hair, by half the head's width and thickness there.
const STRAY: [f32; 2] = [0.16, 0.015];
/// Difference between the longest and the shortest tress of hog and of soft hair, by the head's length.
const RAGGED: [f64; 2] = [0.035, 0.008];
/// Additional difference of a single bristle at the rim, by its own; half of it shortens all of them there.
const RIM: f32 = 4.0;
/// Power of the place from the middle to the rim by which that grows.
const RIM_POWER: i32 = 8;
/// Thickness of the head by the distance at which its bristles differ in length: worn bristles stand in ranks.
const RANK: f32 = 3.0;
/// Greatest offset of the bristles of hog and of soft hair at a rim, which come and go together, m, and the most of it by
/// half the head's width.
const RIM_STRAY_M: [f32; 2] = [0.65e-3, 0.06e-3];
const RIM_STRAY_MOST: f32 = 0.15;
/// Way along which they do, m.
const RIM_REGROUPS_M: f64 = 3e-3;
/// Greatest way by which the points of a tress of a worn head of hog and of soft hair lie before or behind the others on
/// the surface, m, and the most of it by half the head's width.
const WORN_M: [f32; 2] = [1.3e-3, 0.06e-3];
const WORN_MOST: f64 = 0.315;
/// Width of a tress by that of one that is worn alike.
const WORN_TRESS: f32 = 0.42;
/// Width of a tress by that of one at the rim.
const RIM_TRESS: f32 = 0.15;
/// Way along which tresses regroup, m.
const REGROUPS_M: f64 = 25e-3;
/// Number by which half of the strips have the capacity of another one in a stroke.
const OTHERS: i64 = 1 << 40;
/// Numbers of the planes of noise: across the width, across the thickness, along, at the rim, of the worn points.
const PLANES: [u64; 5] = [11, 12, 13, 14, 15];
/// How far the lattice of each reaches.
const LATTICE: [[usize; 2]; 5] = [[7, 7], [7, 7], [7, 3], [1, 1], [3, 0]];

/// How far the strips of a head stray.
#[derive(Clone, Debug)]
pub(super) struct Straying {
    /// True for a blade, whose strips never shift.
    pub(super) rigid: bool,
    /// Share of a single bristle's variation that a strip keeps: one over the number of bristles it stands for.
    single_share: f32,
    /// Greatest offset of a tress, by half the head's width and thickness there.
    stray: f32,
    /// Greatest additional offset at the rim, by half the head's width.
    rim_stray: f32,
    /// Difference between the longest and the shortest tress, stations.
    ragged: f32,
    /// Stations by which the point of each strip is drawn back along it; empty where none is.
    pub(super) drawn_back: Vec<f32>,
    /// Greatest way by which a tress's points lie before or behind the head's, m.
    worn_m: f32,
    /// Way by which the point of each strip lies before the others on the surface, m; empty where none does.
    pub(super) ahead: Vec<f32>,
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
            rim_stray: (RIM_STRAY_M[soft] / file.radius_m(0.0) as f32).min(RIM_STRAY_MOST),
            ragged: (RAGGED[soft] * blunt) as f32 * (STATIONS - 1) as f32,
            drawn_back: Vec::new(),
            worn_m: (WORN_M[soft] as f64 * blunt).min(WORN_MOST * file.radius_m(0.0)) as f32,
            ahead: Vec::new(),
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
        let own = &self.straying;
        if own.rigid || seed == 0 {
            return head;
        }
        let tresses = Regrouping::at(way_m / REGROUPS_M);
        let rims = Regrouping::at(way_m / RIM_REGROUPS_M);
        let turns = [tresses, tresses, tresses, rims, tresses];
        let [wide, deep, long, sides, points] = std::array::from_fn(|plane| {
            Plane::of(&turns[plane], seed ^ (PLANES[plane] << 32), LATTICE[plane])
        });
        head.straying.drawn_back.clear();
        head.straying.ahead.clear();
        let mut closed = [0, 1].map(|axis| Vec::clone(&self.closed[axis]));
        for (strip, root) in self.roots.iter().enumerate() {
            let other = unit(seed, [strip as i64, OTHERS]);
            if other < 0.5 {
                let other = (2.0 * other * self.strips as f32) as usize;
                head.capacity[strip] = self.capacity[other.min(self.strips - 1)];
            }
            let place = [root[0] / TRESS, root[1] / TRESS];
            let single = tresses.between(seed, |seed| unit(seed, [strip as i64, i64::MAX])) - 0.5;
            let rim = root[0].abs().max(root[1].abs()).powi(RIM_POWER);
            let single = own.single_share * single * (1.0 + RIM * rim) + 0.5 * RIM * rim;
            let along = long.at([place[0], root[1] * RANK]);
            let drawn_back = 0.5 * own.ragged * (along + single);
            head.straying.drawn_back.push(drawn_back);
            let worn = points.at([place[0] * WORN_TRESS, 0.0]) / tresses.spread();
            head.straying.ahead.push(2.0 * own.worn_m * worn);
            let [across, aside] = [&wide, &deep].map(|plane| 2.0 * own.stray * plane.at(place));
            let at_side = 2.0 * own.rim_stray * root[0].abs().powi(RIM_POWER);
            let across = across + at_side * sides.at(place.map(|place| place * RIM_TRESS));
            for station in 0..STATIONS {
                let bent = smoothstep(place_along(station)) as f32;
                let i = station * self.strips + strip;
                closed[0][i] += bent * across * self.half_m[station][0];
                closed[1][i] += bent * aside * self.half_m[station][1];
            }
        }
        for (plane, closed) in head.closed.iter_mut().zip(closed) {
            *plane = Arc::new(closed);
        }
        head
    }
}

/// A way as turns in which bristles regroup.
#[derive(Clone, Copy, Debug)]
struct Regrouping {
    turn: u64,
    /// Part of the way from this turn to the next, 0 to 1.
    part: f32,
}

impl Regrouping {
    fn at(turns: f64) -> Self {
        let turn = turns.floor();
        let part = smoothstep(turns - turn) as f32;
        Self {
            turn: turn as u64,
            part,
        }
    }

    /// Standard deviation of a value between two turns by that of one at a turn.
    fn spread(&self) -> f32 {
        let rest = 1.0 - self.part;
        (self.part * self.part + rest * rest).sqrt()
    }

    /// A value that goes from that of this turn's seed to that of the next one's.
    fn between(&self, seed: u64, of: impl Fn(u64) -> f32) -> f32 {
        let [before, after] = [0, 1].map(|next| of(seed ^ ((self.turn + next) << 40)));
        before + (after - before) * self.part
    }
}

/// Noise on a lattice between two turns, its corners computed once for all strips.
struct Plane {
    reach: [usize; 2],
    corners: Vec<f32>,
}

impl Plane {
    /// The plane of a seed, from −`reach` to `reach` along each axis.
    fn of(turn: &Regrouping, seed: u64, reach: [usize; 2]) -> Self {
        let [wide, high] = reach.map(|reach| 2 * reach + 1);
        let corners = (0..wide * high).map(|i| {
            let place = [i % wide, i / wide];
            let place = [0, 1].map(|axis| place[axis] as i64 - reach[axis] as i64);
            turn.between(seed, |seed| unit(seed, place)) - 0.5
        });
        let corners = corners.collect();
        Self { reach, corners }
    }

    /// The noise at a place, as [`noise`] less ½; beyond its reach that of its border.
    fn at(&self, place: [f32; 2]) -> f32 {
        let wide = 2 * self.reach[0] + 1;
        let axis = |i: usize| {
            let most = (2 * self.reach[i]) as f32;
            let at = (place[i] + self.reach[i] as f32).clamp(0.0, most);
            let low = at.floor().min((most - 1.0).max(0.0));
            let t = at - low;
            (low as usize, t * t * (3.0 - 2.0 * t))
        };
        let ((i, u), (j, v)) = (axis(0), axis(1));
        let row = |j: usize| {
            let [near, far] = [i, (i + 1).min(wide - 1)].map(|i| self.corners[j * wide + i]);
            near + (far - near) * u
        };
        let next = (j + 1).min(2 * self.reach[1]);
        row(j) + (row(next) - row(j)) * v
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_is_the_noise_of_its_turns() {
        let turn = Regrouping::at(3.3);
        let plane = Plane::of(&turn, 77, [7, 3]);
        for i in 0..500 {
            let [x, y] = [11, 12].map(|salt| unit(salt, [i, 0]) - 0.5);
            let place = [13.9 * x, 5.9 * y];
            let expected = turn.between(77, |seed| noise(seed, place)) - 0.5;
            assert!((plane.at(place) - expected).abs() < 1e-5, "{place:?}");
        }
        let other = Plane::of(&Regrouping::at(4.3), 77, [7, 3]);
        assert!((other.at([0.5, 0.5]) - plane.at([0.5, 0.5])).abs() > 1e-3);
    }
}
