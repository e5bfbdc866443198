//! Paint at a place of a surface: what is wet there, or else the newest dry layer.

use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::paint::TILE;

use super::SurfaceState;

/// Radius around the place in which paint counts, m.
const RADIUS_M: f64 = 5e-4;

impl SurfaceState {
    /// Counts of the wet paint around a place, or of the newest dry layer there; the place is in m from the lower left
    /// corner.
    pub(crate) fn counts_at(&self, at_m: [f64; 2]) -> Counts {
        let tiles = self.cells_around(at_m);
        let sum = |of: &dyn Fn(&Tile, usize) -> Option<Counts>| {
            let mut counts = [0; SLOTS];
            for (id, cell) in &tiles {
                let tile = self.store.version(*id).tile.as_deref();
                if let Some(found) = tile.and_then(|tile| of(tile, *cell)) {
                    add(&mut counts, &found);
                }
            }
            counts
        };
        let wet = sum(&|tile, cell| Some(in_cell(&tile.wet(), cell)));
        match wet.iter().any(|count| *count > 0) {
            true => wet,
            false => sum(&|tile, cell| {
                let mut layers = tile
                    .dry()?
                    .layers()
                    .map(|layer| in_cell(&layer.planes.get(), cell));
                layers.find(|counts| counts.iter().any(|count| *count > 0))
            }),
        }
    }

    /// Cells around a place, each with its tile.
    fn cells_around(&self, at_m: [f64; 2]) -> Vec<(TileId, usize)> {
        let [x, y] = at_m.map(|m| m / self.cell_m);
        let reach = (RADIUS_M / self.cell_m).max(0.5);
        let range = |at: f64, cells: u32| {
            let first = (at - reach).round().max(0.0) as u32;
            first..((at + reach).round().max(0.0) as u32).min(cells)
        };
        let [across, up] = self.store.cells();
        let side = TILE as u32;
        let of = |x: u32, y: u32| {
            let id = TileId {
                x: x / side,
                y: y / side,
            };
            (id, (y % side * side + x % side) as usize)
        };
        let rows = range(y, up);
        rows.flat_map(|y| range(x, across).map(move |x| (x, y)))
            .map(|(x, y)| of(x, y))
            .collect()
    }
}

/// Counts of a cell of a tile.
fn in_cell(planes: &Planes, cell: usize) -> Counts {
    let mut counts = [0; SLOTS];
    for (slot, plane) in planes.iter() {
        counts[*slot] = plane[cell] as u64;
    }
    counts
}
