//! Columns of ground, dry and wet paint over the cells of a surface.

use std::collections::BTreeMap;
use std::slice;
use std::sync::Arc;

use maulstick_appearance::bands::Banded;
use maulstick_stokes_paint::columns::{has_layers, tile_columns, without_thin};
use maulstick_types::paint::TILE;

/// Columns of a band, row after row from its lowest: the ends of each in m above the highest bare peaks, as
/// [`ColumnPairing`](super::pairing::ColumnPairing) takes them.
pub(super) struct Columns {
    heights: Arc<Vec<f32>>,
    layered: BTreeMap<usize, Vec<f32>>,
}

impl Columns {
    /// Columns of a band, without pieces and gaps thinner than `thin_m`, m.
    pub(super) fn of(banded: &Banded<'_>, band: usize, thin_m: f64) -> Self {
        let mut layered = BTreeMap::new();
        let width = banded.cells()[0];
        for (id, tile) in banded.tiles(band) {
            let Some(tile) = tile.filter(|tile| has_layers(tile)) else {
                continue;
            };
            let [across, up] = banded.within(id);
            let hidden: Vec<usize> = banded
                .bare()
                .in_wells(id)
                .filter(|well| well.hides)
                .map(|well| well.cell)
                .collect();
            for (cell, ends) in tile_columns(&banded.bare().relief, id, tile, banded.cell_m()) {
                let (x, y) = (cell % TILE, cell / TILE);
                if x < across && y < up && !hidden.contains(&cell) {
                    let cell = y * width + id.x as usize * TILE + x;
                    layered.insert(cell, without_thin(&ends, thin_m));
                }
            }
        }
        Self {
            heights: banded.heights(band),
            layered,
        }
    }

    /// The column over a cell.
    pub(super) fn ends(&self, cell: usize) -> &[f32] {
        self.layered
            .get(&cell)
            .map_or_else(|| slice::from_ref(&self.heights[cell]), Vec::as_slice)
    }
}
