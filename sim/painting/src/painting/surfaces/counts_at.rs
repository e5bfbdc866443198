//! Paint at a place of a surface: the wet paint, or else the newest dry layer.

use std::collections::BTreeMap;

use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::TileId;
use maulstick_types::paint::TILE;

use super::SurfaceState;

/// Radius of counted paint around the place, m; at least the cell under it counts.
const RADIUS_M: f64 = 5e-4;

impl SurfaceState {
    /// Counts of the wet paint around a place, or of the newest dry layer there; the place is in m from the lower left
    /// corner.
    pub(crate) fn counts_at(&self, at_m: [f64; 2]) -> Counts {
        let mut wet = [0; SLOTS];
        let mut layers: BTreeMap<u32, Counts> = BTreeMap::new();
        for (id, cell) in self.cells_around(at_m) {
            let Some(tile) = self.store.version(id).tile.as_deref() else {
                continue;
            };
            add(&mut wet, &in_cell(&tile.wet(), cell));
            for layer in tile.dry().iter().flat_map(|stack| stack.layers()) {
                let counts = layers.entry(layer.number).or_insert([0; SLOTS]);
                add(counts, &in_cell(&layer.planes.get(), cell));
            }
        }
        let from_the_top = std::iter::once(wet).chain(layers.into_values().rev());
        let mut films = from_the_top.filter(|counts| counts.iter().any(|count| *count > 0));
        films.next().unwrap_or([0; SLOTS])
    }

    /// Cells around a place, each with its tile.
    fn cells_around(&self, at_m: [f64; 2]) -> Vec<(TileId, usize)> {
        let at = at_m.map(|m| m / self.cell_m);
        let reach = RADIUS_M / self.cell_m;
        let range = |at: f64, cells: u32| {
            let first = (at - reach).floor().max(0.0) as u32;
            first..((at + reach).ceil().max(0.0) as u32).min(cells)
        };
        let is_near = |[x, y]: [u32; 2]| {
            let from_middle = [x, y].map(f64::from).map(|cell| cell + 0.5);
            let [x, y] = [0, 1].map(|i| at[i] - from_middle[i]);
            x * x + y * y <= reach * reach || x.abs() <= 0.5 && y.abs() <= 0.5
        };
        let [across, up] = self.store.cells();
        let side = TILE as u32;
        let of = |[x, y]: [u32; 2]| {
            let id = TileId {
                x: x / side,
                y: y / side,
            };
            (id, (y % side * side + x % side) as usize)
        };
        let rows = range(at[1], up);
        rows.flat_map(|y| range(at[0], across).map(move |x| [x, y]))
            .filter(|cell| is_near(*cell))
            .map(of)
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
