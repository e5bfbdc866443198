//! How high paint in layers is shown: as its highest piece is, over air or not.

use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::show_paint::{Counted, ShowPaint};
use maulstick_canvas::tile::{Tile, TileId};

use crate::columns::{has_layers, tile_columns, without_thin};

/// Thickness from which on a piece over air is shown, cells.
const THICK: f64 = 0.5;

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
                if let Some(top) = without_thin(&ends, THICK * cell_m).last() {
                    heights[cell] = top - relief[cell];
                }
            }
        }
        heights
    }
}
