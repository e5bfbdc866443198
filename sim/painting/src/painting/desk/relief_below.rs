//! Relief of a surface below a brush, for the force on the hand: tooth, dried paint, and a little of the wet paint.
//!
//! Each height is the mean over a cell that is a millimetre wide on the desk, because a head rests on several threads
//! at once. Wet paint counts with a share of its height, as it is pressed flat, by the rheology of the surface's model.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::tile::TileId;
use maulstick_model::rheology::Rheology;
use maulstick_num::geometry::Rigid;
use maulstick_types::brush::{BrushRelief, Solve};
use maulstick_types::haptics::height_bytes;
use maulstick_types::paint::TILE;

use super::Desk;
use crate::painting::optics::thinner_slot;
use crate::painting::surfaces::SurfaceState;

/// Least side of a cell on the desk, m; a wider cell of the paint is used as it is.
const CELL_M: f64 = 1e-3;
/// Cells along a side: the hand may go half of it before the next relief comes.
const SIDE: u32 = 24;
/// Greatest number of points along the side of a cell whose mean is its height.
const POINTS: i64 = 4;
/// Height of a tip above which it feels nothing soon, m of the desk.
const FAR_M: f64 = 0.03;

impl Desk {
    /// Relief below a brush, of a head's length, m, as it was solved; none for one that is far from the surface.
    pub(crate) fn relief_below(&self, head_m: f64, solve: &Solve) -> Option<BrushRelief> {
        let surface = self.surfaces.find(solve.surface)?;
        let zoom = self
            .scene
            .surfaces
            .iter()
            .find(|it| it.id == surface.id)?
            .zoom;
        let tip = Rigid::from(&solve.pose).point(DVec3::NEG_Z * (head_m / solve.zoom));
        if !tip.is_finite() || tip.z * zoom > FAR_M {
            return None;
        }
        let cell_m = (CELL_M / zoom).max(surface.cell_m);
        let first = [tip.x, tip.y].map(|at| (at / cell_m).floor() as i32 - SIDE as i32 / 2);
        let mut heights = Heights::of(surface, thinner_slot(&self.scene));
        let points = ((cell_m / surface.cell_m).ceil() as i64).clamp(1, POINTS);
        let cells = (0..SIDE as i32).flat_map(|j| (0..SIDE as i32).map(move |i| [i, j]));
        let heights_um = cells.map(|cell| {
            let corner = [0, 1].map(|i| f64::from(first[i] + cell[i]) * cell_m);
            (heights.mean_m(corner, cell_m, points) * 1e6).round() as i16
        });
        Some(BrushRelief {
            surface: surface.id,
            cell_m,
            side: SIDE,
            first,
            heights_um: height_bytes(heights_um),
        })
    }
}

/// Heights of a surface's cells, read tile by tile on demand.
struct Heights<'a> {
    surface: &'a SurfaceState,
    thinner: Option<usize>,
    tiles: BTreeMap<TileId, TileHeights>,
}

/// Inputs of a tile's heights.
struct TileHeights {
    tooth_m: Arc<[f32]>,
    dry: Option<Arc<[f32]>>,
    wet: Option<Arc<Planes>>,
}

impl<'a> Heights<'a> {
    fn of(surface: &'a SurfaceState, thinner: Option<usize>) -> Self {
        Self {
            surface,
            thinner,
            tiles: BTreeMap::new(),
        }
    }

    /// Mean height of a square, m; beside the surface it is 0.
    fn mean_m(&mut self, corner: [f64; 2], side_m: f64, points: i64) -> f64 {
        let place = |start: f64, k: i64| {
            let at = start + side_m * (k as f64 + 0.5) / points as f64;
            (at / self.surface.cell_m).floor() as i64
        };
        let [xs, ys] = corner.map(|start| {
            let all: Vec<i64> = (0..points).map(|k| place(start, k)).collect();
            all
        });
        let mut sum = 0.0;
        for y in &ys {
            for x in &xs {
                sum += self.height_m([*x, *y]);
            }
        }
        sum / (points * points) as f64
    }

    fn height_m(&mut self, cell: [i64; 2]) -> f64 {
        let limits = self.surface.store.cells().map(i64::from);
        if (0..2).any(|i| !(0..limits[i]).contains(&cell[i])) {
            return 0.0;
        }
        let side = TILE as i64;
        let id = TileId {
            x: (cell[0] / side) as u32,
            y: (cell[1] / side) as u32,
        };
        let at = ((cell[1] % side) * side + cell[0] % side) as usize;
        let surface = self.surface;
        let rheology = &surface.model.rheology;
        let tile = self.tiles.entry(id).or_insert_with(|| {
            let tile = surface.store.version(id).tile.as_ref();
            TileHeights {
                tooth_m: surface.bare.relief.tile(id),
                dry: tile.and_then(|tile| Some(tile.dry()?.height())),
                wet: tile.map(|tile| tile.wet()),
            }
        });
        let dry = tile.dry.as_ref().map_or(0.0, |dry| f64::from(dry[at]));
        let wet = tile
            .wet
            .as_ref()
            .map_or(0.0, |wet| stiff(wet, at, self.thinner, rheology));
        f64::from(tile.tooth_m[at]) + (dry + rheology.bears * wet) * QUANTUM_M
    }
}

/// Quanta of the wet paint of a cell by the yield stress that its thinner leaves it.
fn stiff(wet: &Planes, at: usize, thinner: Option<usize>, rheology: &Rheology) -> f64 {
    let (mut all, mut thin) = (0.0, 0.0);
    for (slot, plane) in wet {
        all += plane[at];
        if Some(*slot) == thinner {
            thin += plane[at];
        }
    }
    if all <= 0.0 {
        return 0.0;
    }
    f64::from(all * (rheology.yields)(thin / all))
}
