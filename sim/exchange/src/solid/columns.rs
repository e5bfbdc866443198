//! Columns of ground, dry and wet paint over the cells of a surface.

use std::collections::BTreeMap;
use std::slice;
use std::sync::Arc;

use maulstick_appearance::bands::Banded;
use maulstick_types::paint::TILE;

/// Columns of a band, row by row from its lowest: the ends of each in m above the highest bare peaks, for
/// [`ColumnPairing`](super::pairing::ColumnPairing).
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
            let bare = banded.bare();
            let columns =
                tile.map(|tile| bare.shown.columns(&bare.relief, id, tile, banded.cell_m()));
            let Some(columns) = columns.filter(|columns| !columns.is_empty()) else {
                continue;
            };
            let [across, up] = banded.within(id);
            let hidden: Vec<usize> = bare
                .in_wells(id)
                .filter(|well| well.hides)
                .map(|well| well.cell)
                .collect();
            for (cell, ends) in columns {
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

/// The ends of a column without pieces and gaps thinner than `thin_m`, m; paint over a thin gap is moved down to the
/// piece below.
fn without_thin(ends: &[f32], thin_m: f64) -> Vec<f32> {
    let is_thin = |low: f32, high: f32| f64::from(high) - f64::from(low) < thin_m;
    let mut kept = vec![ends[0]];
    for piece in ends[1..].chunks_exact(2) {
        let place = kept.len() - 1;
        if is_thin(kept[place], piece[0]) {
            kept[place] = kept[place].max(piece[1]);
        } else if !is_thin(piece[0], piece[1]) {
            kept.extend_from_slice(piece);
        }
    }
    kept
}
