//! Display of paint in layers: its colour from above, its height that of its highest piece, over air or not.

use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_appearance::show_paint::{
    ColumnEnds, Films, ShowPaint, counted_films, painted_height,
};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};

use crate::columns::{has_layers, tile_columns};
use crate::layer_planes::seen_from_above;

/// Thickness from which a piece over air is displayed at its height, cells: a lip as thin as the cells are wide would
/// appear as specks.
const LIP_THICKNESS_CELLS: f32 = 2.0;

/// Counted paint whose ridges may overhang.
#[derive(Clone, Copy, Debug)]
pub struct Overhangs;

impl ShowPaint for Overhangs {
    fn films(&self, planes: &Planes) -> Films {
        seen_from_above(planes).unwrap_or_else(|| counted_films(planes))
    }

    fn height(&self, bare: &BlankSurface, id: TileId, tile: &Tile) -> Vec<f32> {
        let mut heights = painted_height(self, tile);
        let cell_m = 1.0 / f64::from(bare.relief.cells_per_m());
        let columns = self.columns(&bare.relief, id, tile, cell_m);
        if !columns.is_empty() {
            let relief = bare.relief.tile(id);
            for (cell, ends) in columns {
                if let [.., bottom, top] = ends[..]
                    && top - bottom >= LIP_THICKNESS_CELLS * cell_m as f32
                {
                    heights[cell] = top - relief[cell];
                }
            }
        }
        heights
    }

    fn columns(&self, relief: &Relief, id: TileId, tile: &Tile, cell_m: f64) -> ColumnEnds {
        if has_layers(tile) {
            tile_columns(relief, id, tile, cell_m)
        } else {
            ColumnEnds::new()
        }
    }
}
