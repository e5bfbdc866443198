//! How high paint in layers is shown: as its highest piece is, over air or not.

use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_canvas::tile::{Tile, TileId};

use crate::columns::{has_layers, tile_columns};

/// Thickness from which on a piece over air is shown above it, cells: a lip as thin as the cells are wide would be specks.
const THICK: f32 = 2.0;

/// Counted paint whose ridges may overhang.
#[derive(Clone, Copy, Debug)]
pub struct Overhangs;

impl ShowPaint for Overhangs {
    fn height(&self, bare: &BlankSurface, id: TileId, tile: &Tile) -> Vec<f32> {
        let mut heights = Counted.height(bare, id, tile);
        if has_layers(tile) {
            let relief = bare.relief.tile(id);
            let cell_m = 1.0 / f64::from(bare.relief.cells_per_m());
            for (cell, ends) in tile_columns(&bare.relief, id, tile, cell_m) {
                if let [.., bottom, top] = ends[..]
                    && top - bottom >= THICK * cell_m as f32
                {
                    heights[cell] = top - relief[cell];
                }
            }
        }
        heights
    }
}
