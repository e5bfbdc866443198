//! The tooth of a surface: what its bare ground is like under the fingertip.
//!
//! Heights are at most 0, the level of the highest peaks, on which a brush rests. Woven grounds are
//! a plain weave: warp and weft as arched threads that go over and under each other, each of a
//! strength of its own, with slubs. Primed panels and papers are noise of several octaves. All of it
//! is a function of place and seed.

use maulstick_types::paint::TILE;

use crate::tile::{TILE_CELLS, TileId};

/// How a ground is made.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Make {
    /// Threads by this distance, m.
    Woven { pitch_m: f64 },
    /// Noise whose largest bumps are this wide, m.
    Grained { size_m: f64 },
}

/// A kind of tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    name: &'static str,
    /// From the highest peak to the deepest valley, m.
    depth_m: f64,
    make: Make,
}

const KINDS: [Kind; 4] = [
    Kind {
        name: "linen",
        depth_m: 80e-6,
        make: Make::Woven { pitch_m: 0.9e-3 },
    },
    Kind {
        name: "cotton",
        depth_m: 55e-6,
        make: Make::Woven { pitch_m: 0.65e-3 },
    },
    Kind {
        name: "panel",
        depth_m: 10e-6,
        make: Make::Grained { size_m: 2e-3 },
    },
    Kind {
        name: "paper",
        depth_m: 45e-6,
        make: Make::Grained { size_m: 1.2e-3 },
    },
];

/// The tooth of one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tooth {
    kind: Kind,
    seed: u64,
    cell_m: f64,
}

impl Tooth {
    /// The names of the teeth.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|kind| kind.name)
    }

    /// The tooth called `name` on cells of `cell_m`; none if there is no such tooth.
    #[must_use]
    pub fn new(name: &str, seed: u64, cell_m: f64) -> Option<Self> {
        let kind = *KINDS.iter().find(|kind| kind.name == name)?;
        Some(Self { kind, seed, cell_m })
    }

    /// From the highest peak to the deepest valley, and from bump to bump, m.
    #[must_use]
    pub fn relief_m(&self) -> [f64; 2] {
        let wide = match self.kind.make {
            Make::Woven { pitch_m } => pitch_m,
            Make::Grained { size_m } => size_m,
        };
        [self.kind.depth_m, wide]
    }

    /// Heights of a tile's cells, m, row after row from the bottom.
    #[must_use]
    pub fn tile(&self, id: TileId) -> Box<[f32]> {
        let mut heights = Vec::with_capacity(TILE_CELLS);
        for y in 0..TILE {
            for x in 0..TILE {
                let at = [
                    (f64::from(id.x) * TILE as f64 + x as f64 + 0.5) * self.cell_m,
                    (f64::from(id.y) * TILE as f64 + y as f64 + 0.5) * self.cell_m,
                ];
                heights.push(self.height_m(at) as f32);
            }
        }
        heights.into_boxed_slice()
    }

    /// Height at a place of the surface, m: from −depth to 0.
    #[must_use]
    pub fn height_m(&self, at: [f64; 2]) -> f64 {
        let share = match self.kind.make {
            Make::Woven { pitch_m } => self.weave(at.map(|m| m / pitch_m)),
            Make::Grained { size_m } => self.grain(at.map(|m| m / size_m)),
        };
        self.kind.depth_m * (share.clamp(0.0, 1.0) - 1.0)
    }

    /// Height of a plain weave with threads 1 apart, 0 to 1.
    fn weave(&self, [x, y]: [f64; 2]) -> f64 {
        // Threads wander a little.
        let u = x + 0.25 * (self.noise(1, [0.35 * x, 0.09 * y]) - 0.5);
        let v = y + 0.25 * (self.noise(2, [0.09 * x, 0.35 * y]) - 0.5);
        let (i, j) = (u.floor(), v.floor());
        let arch = |t: f64| 1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0);
        let (warp, weft) = (arch(u - i), arch(v - j));
        let over = if (i + j).rem_euclid(2.0) < 0.5 {
            1.0
        } else {
            -1.0
        };
        let strength = |axis: u64, thread: f64, along: f64| {
            let own = self.hash(axis, [thread as i64, 0]);
            0.72 + 0.2 * own + 0.16 * (self.noise(axis + 8, [0.15 * along, 7.3 * thread]) - 0.5)
        };
        let warp = strength(3, i, v) * warp * (0.55 + 0.45 * over * weft);
        let weft = strength(4, j, u) * weft * (0.55 - 0.45 * over * warp.min(1.0));
        0.97 * warp.max(weft) + 0.06 * (self.noise(5, [3.0 * x, 3.0 * y]) - 0.5) + 0.03
    }

    /// Noise of four octaves, 0 to 1.
    fn grain(&self, at: [f64; 2]) -> f64 {
        let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1.0);
        for octave in 0..4 {
            sum += weight * self.noise(20 + octave, at.map(|v| v * scale));
            (weight, scale) = (0.5 * weight, 2.1 * scale);
        }
        sum / 0.9375
    }

    /// Smooth noise on a lattice of side 1, 0 to 1.
    fn noise(&self, channel: u64, [x, y]: [f64; 2]) -> f64 {
        let (i, j) = (x.floor(), y.floor());
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let (u, v) = (ease(x - i), ease(y - j));
        let corner = |di: i64, dj: i64| self.hash(channel, [i as i64 + di, j as i64 + dj]);
        let row = |dj: i64| corner(0, dj) + (corner(1, dj) - corner(0, dj)) * u;
        row(0) + (row(1) - row(0)) * v
    }

    /// A number in 0 to 1 for each lattice point (finaliser of Murmur 3, Appleby).
    fn hash(&self, channel: u64, [i, j]: [i64; 2]) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tooth_fills_its_depth_and_no_more() {
        for kind in KINDS {
            let tooth = Tooth::new(kind.name, 1, 2.5e-4).expect("known");
            let tile = tooth.tile(TileId { x: 3, y: 5 });
            let low = tile.iter().copied().fold(f32::MAX, f32::min);
            let high = tile.iter().copied().fold(f32::MIN, f32::max);
            let depth = kind.depth_m as f32;
            assert!(low >= -depth && high <= 0.0, "{}: {low} {high}", kind.name);
            assert!(high - low > 0.5 * depth, "{}: {low} {high}", kind.name);
        }
        assert!(Tooth::new("silk", 1, 2.5e-4).is_none());
    }

    #[test]
    fn the_seed_makes_the_tooth_and_tiles_join() {
        let tooth = Tooth::new("linen", 1, 2.5e-4).expect("known");
        let other = Tooth::new("linen", 2, 2.5e-4).expect("known");
        let id = TileId { x: 0, y: 0 };
        assert_eq!(tooth.tile(id), tooth.tile(id));
        assert_ne!(tooth.tile(id), other.tile(id));
        // The last column of a tile and the first of the next differ as neighbours do.
        let (left, right) = (tooth.tile(id), tooth.tile(TileId { x: 1, y: 0 }));
        let step = |a: f32, b: f32| (a - b).abs();
        let within: f32 = (0..TILE)
            .map(|y| step(left[y * TILE + 40], left[y * TILE + 41]))
            .sum();
        let across: f32 = (0..TILE)
            .map(|y| step(left[y * TILE + 63], right[y * TILE]))
            .sum();
        assert!(across < 3.0 * within, "{across} {within}");
    }
}
