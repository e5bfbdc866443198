//! The tooth of a surface: the fine relief of its bare ground.
//!
//! Heights are at most 0, the level of the highest peaks, on which a brush rests. Woven grounds are a primed plain
//! weave (`weave.rs`); primed panels and papers are noise of several octaves. All of it is a function of place and
//! seed.

use maulstick_types::paint::TILE;

use super::lattice_noise::LatticeNoise;
use super::weave::Weave;
use crate::planes::TILE_CELLS;
use crate::tile::TileId;

/// Construction of a ground.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Make {
    /// Threads at this pitch, m, and the share of their length that is slubs.
    Woven { pitch_m: f64, slubs: f64 },
    /// Noise with largest bumps of this width, m.
    Grained { size_m: f64 },
}

/// A kind of tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    name: &'static str,
    /// Depth of the deepest valley below the highest peak, m.
    depth_m: f64,
    make: Make,
}

const KINDS: [Kind; 4] = [
    Kind {
        name: "linen",
        depth_m: 80e-6,
        make: Make::Woven {
            pitch_m: 0.9e-3,
            slubs: 0.3,
        },
    },
    Kind {
        name: "cotton",
        depth_m: 55e-6,
        make: Make::Woven {
            pitch_m: 0.65e-3,
            slubs: 0.12,
        },
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

/// Side of a cell per sample of its tooth, m: a coarse cell has the mean of its tooth.
const SAMPLED_M: f64 = 0.125e-3;
/// Greatest number of samples of a cell.
const SAMPLES_MOST: u32 = 16;

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

    /// The tooth called `name` on cells of `cell_m`; `None` if there is no such tooth.
    #[must_use]
    pub fn new(name: &str, seed: u64, cell_m: f64) -> Option<Self> {
        let kind = *KINDS.iter().find(|kind| kind.name == name)?;
        Some(Self { kind, seed, cell_m })
    }

    /// From the highest peak to the deepest valley, and from bump to bump, m.
    #[must_use]
    pub fn relief_m(&self) -> [f64; 2] {
        let wide = match self.kind.make {
            Make::Woven { pitch_m, .. } => pitch_m,
            Make::Grained { size_m } => size_m,
        };
        [self.kind.depth_m, wide]
    }

    /// Heights of a tile's cells, m, row after row from the bottom: means of samples, of which no two stand in one row
    /// or column of a cell.
    #[must_use]
    pub fn tile(&self, id: TileId) -> Box<[f32]> {
        let count = (self.cell_m / SAMPLED_M).ceil() as u32;
        let count = count.next_power_of_two().min(SAMPLES_MOST);
        let samples = f64::from(count);
        let share = |of: u32| f64::from(of) / 4_294_967_296.0 + 0.5 / samples;
        let rooks: Vec<[f64; 2]> = (0..count)
            .map(|i| [(f64::from(i) + 0.5) / samples, share(i.reverse_bits())])
            .collect();
        let noise = LatticeNoise::new(self.seed);
        let mut heights = Vec::with_capacity(TILE_CELLS);
        for y in 0..TILE {
            for x in 0..TILE {
                let corner = [
                    f64::from(id.x) * TILE as f64 + x as f64,
                    f64::from(id.y) * TILE as f64 + y as f64,
                ];
                let sum: f64 = (rooks.iter())
                    .map(|rook| {
                        self.height_m(&noise, [0, 1].map(|i| (corner[i] + rook[i]) * self.cell_m))
                    })
                    .sum();
                heights.push((sum / samples) as f32);
            }
        }
        heights.into_boxed_slice()
    }

    /// Height at a place of the surface, m: from −depth to 0.
    fn height_m(&self, noise: &LatticeNoise, at: [f64; 2]) -> f64 {
        let share = match self.kind.make {
            Make::Woven { pitch_m, slubs } => {
                Weave { noise, slubs }.height(at.map(|m| m / pitch_m))
            }
            Make::Grained { size_m } => grain(noise, at.map(|m| m / size_m)),
        };
        self.kind.depth_m * (share.clamp(0.0, 1.0) - 1.0)
    }
}

/// Noise of four octaves, 0 to 1.
fn grain(noise: &LatticeNoise, at: [f64; 2]) -> f64 {
    let (mut sum, mut weight, mut scale) = (0.0, 0.5, 1.0);
    for octave in 0..4 {
        sum += weight * noise.at(20 + octave, at.map(|v| v * scale));
        (weight, scale) = (0.5 * weight, 2.1 * scale);
    }
    sum / 0.9375
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
        // The last column of a tile and the first of the next differ like neighbours.
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
