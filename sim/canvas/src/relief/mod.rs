//! Relief of a bare ground; a window adds the dried paint when it is opened.

mod lattice_noise;
pub mod ride;
pub mod tooth;
pub mod tooth_picture;
mod weave;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use tooth::Tooth;
use tooth_picture::PictureTooth;

use crate::planes::TILE_CELLS;
use crate::tile::TileId;

/// Greatest number of tiles with cached heights.
const CACHED_TILES_MAX: usize = 1024;

/// Source of the heights.
#[derive(Debug)]
enum Shape {
    Flat,
    Tooth(Tooth),
    Picture(PictureTooth),
}

/// The relief of a surface, which catches paint.
#[derive(Debug)]
pub struct Relief {
    shape: Shape,
    cell_m: f64,
    tiles: Mutex<BTreeMap<TileId, Arc<[f32]>>>,
}

impl Relief {
    /// The relief of a bare ground.
    #[must_use]
    pub fn new(tooth: Tooth, cell_m: f64) -> Self {
        Self::of(Shape::Tooth(tooth), cell_m)
    }

    /// The relief of a bare ground whose tooth is a picture.
    #[must_use]
    pub fn pictured(tooth: PictureTooth, cell_m: f64) -> Self {
        Self::of(Shape::Picture(tooth), cell_m)
    }

    /// A surface without tooth.
    #[must_use]
    pub fn flat(cell_m: f64) -> Self {
        Self::of(Shape::Flat, cell_m)
    }

    fn of(shape: Shape, cell_m: f64) -> Self {
        Self {
            shape,
            cell_m,
            tiles: Mutex::default(),
        }
    }

    /// Cells per metre.
    #[must_use]
    pub fn cells_per_m(&self) -> f32 {
        (1.0 / self.cell_m) as f32
    }

    /// From the highest bare peak to the deepest valley, m.
    #[must_use]
    pub fn depth_m(&self) -> f64 {
        match &self.shape {
            Shape::Tooth(tooth) => tooth.relief_m()[0],
            Shape::Picture(tooth) => tooth.depth_m(),
            Shape::Flat => 0.0,
        }
    }

    /// Heights of a tile's cells, m; 0 is the level of the highest bare peaks.
    #[must_use]
    pub fn tile(&self, id: TileId) -> Arc<[f32]> {
        let mut tiles = self.tiles.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(heights) = tiles.get(&id) {
            return Arc::clone(heights);
        }
        let heights: Arc<[f32]> = match &self.shape {
            Shape::Tooth(tooth) => tooth.tile(id).into(),
            Shape::Picture(tooth) => tooth.tile(id).into(),
            Shape::Flat => vec![0.0; TILE_CELLS].into(),
        };
        if tiles.len() >= CACHED_TILES_MAX {
            // Whatever the direction of work over the surface, the farthest tile is not the next one.
            let ends = [tiles.first_key_value(), tiles.last_key_value()];
            let [first, last] = ends.map(|end| end.map_or(0, |(other, _)| other.y.abs_diff(id.y)));
            if first > last {
                tiles.pop_first();
            } else {
                tiles.pop_last();
            }
        }
        tiles.insert(id, Arc::clone(&heights));
        heights
    }
}
