//! The painting's ledger.

use std::sync::Arc;

use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::{Counts, SLOTS, add, quantum_m3};
use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::Tile;
use maulstick_model::interface::CountOwn;
use maulstick_types::scene::{CANVAS, PALETTE};

use super::Painting;
use crate::ledger::{LedgerReport, Stocks, Tallies, balance};

impl Painting {
    /// Bytes that its tiles, and those of its history, take in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.pager.counts().resident
    }

    /// Balances the books.
    pub fn report(&mut self) -> LedgerReport {
        self.commit();
        let mut stocks = Stocks::default();
        for track in self.brushes.values() {
            add(&mut stocks.brush, &track.load.counts());
        }
        let mut covered_cells = 0;
        for sheet in &self.sheets {
            if let Some(count) = self.models.of(sheet.model).count_own() {
                let (wet, dry) = counts_own(&sheet.store, count);
                add(&mut stocks.dry, &dry);
                match sheet.id {
                    PALETTE => add(&mut stocks.palette, &wet),
                    _ => add(&mut stocks.canvas, &wet),
                }
            }
            add(&mut stocks.dry, &sheet.store.dry_counts());
            match sheet.id {
                CANVAS => {
                    add(&mut stocks.canvas, &sheet.store.counts());
                    covered_cells += covered(&sheet.store);
                }
                PALETTE => add(&mut stocks.palette, &sheet.store.counts()),
                _ => {}
            }
        }
        let names: Vec<String> = self
            .scene
            .paints
            .iter()
            .map(|slot| slot.name.clone())
            .collect();
        let (first, last) = self.span_ns.unwrap_or_default();
        let tallies = Tallies {
            steps: self.steps,
            footprint_cells: self.footprint_cells,
            covered_cells,
            seconds: (last - first) as f64 * 1e-9,
        };
        balance(
            &self.ledger,
            &stocks,
            &names,
            quantum_m3(self.sheets[0].cell_m),
            tallies,
        )
    }
}

/// Paint in the planes that a model keeps of its own, wet and dry.
fn counts_own(store: &TileStore, count: CountOwn) -> (Counts, Counts) {
    let (mut wet, mut dry) = ([0; SLOTS], [0; SLOTS]);
    let tiles = store
        .iter()
        .filter_map(|(_, version)| version.tile.as_ref());
    for tile in tiles {
        add(&mut wet, &count(tile.wet().own()));
        for layer in tile.dry().into_iter().flat_map(|stack| stack.layers()) {
            add(&mut dry, &count(layer.planes.get().own()));
        }
    }
    (wet, dry)
}

/// Cells with paint, wet or dry.
fn covered(store: &TileStore) -> u64 {
    let tiles = store
        .iter()
        .filter_map(|(_, version)| version.tile.as_ref());
    let painted = |tile: &Arc<Tile>| {
        let (wet, dry) = (tile.wet(), tile.dry().map(|stack| stack.height()));
        let covered = |cell: &usize| {
            dry.as_ref().is_some_and(|height| height[*cell] > 0.0)
                || wet.iter().any(|(_, plane)| plane[*cell] > 0.0)
        };
        (0..TILE_CELLS).filter(covered).count() as u64
    };
    tiles.map(painted).sum()
}
