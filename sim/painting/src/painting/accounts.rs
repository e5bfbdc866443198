//! Accounts: the ledger, and how much work was done.

use std::sync::Arc;

use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::{Counts, SLOTS, add, quantum_m3};
use maulstick_canvas::tile::Tile;
use maulstick_model::interface::{CountOwn, StepReport};
use maulstick_types::scene::{CANVAS, PALETTE};

use super::backend::Backend;
use super::brushes::Brushes;
use super::desk::Desk;
use super::surfaces::SurfaceState;
use crate::ledger::{Booked, Ledger, LedgerReport, Stocks, Tallies, balance};
use crate::snapshot::WorkSnapshot;

/// Booked and counted paint.
#[derive(Clone, Default)]
pub(crate) struct Accounts {
    pub(crate) ledger: Ledger,
    /// The ledger as far as its changes are booked for a step.
    accounted: Ledger,
    pub(crate) work: WorkSnapshot,
}

impl Accounts {
    /// The accounts of a document.
    pub(crate) fn restored(ledger: Ledger, work: WorkSnapshot) -> Self {
        Self {
            accounted: ledger.clone(),
            ledger,
            work,
        }
    }

    /// Stores the time of a state.
    pub(crate) fn note_time(&mut self, event_ns: u64) {
        let (first, last) = self.work.span_ns.unwrap_or((event_ns, event_ns));
        self.work.span_ns = Some((first, last.max(event_ns)));
    }

    /// Adds the report of the paint model's steps.
    pub(crate) fn note(&mut self, report: &StepReport) {
        self.work.footprint_cells += report.footprint_cells;
        self.ledger.from_mode(&report.from_nowhere);
        self.ledger.to_cleaner(&report.lifted);
    }

    /// Paint booked since the last call.
    pub(crate) fn take_booked(&mut self) -> Booked {
        let booked = self.ledger.since(&self.accounted);
        self.accounted = self.ledger.clone();
        booked
    }

    /// Repeats the bookings of a step with `times` 1, or reverses them with −1.
    pub(crate) fn book(&mut self, booked: &Booked, times: i64) {
        self.ledger.book(booked, times);
        self.accounted = self.ledger.clone();
    }

    /// Balances the books with what is found on brushes and surfaces.
    pub(crate) fn report(
        &self,
        brushes: &Brushes,
        desk: &Desk,
        backend: &mut Backend,
    ) -> LedgerReport {
        let mut stocks = Stocks::default();
        for brush in brushes.iter() {
            add(&mut stocks.brush, &brush.load.counts());
        }
        let mut covered_cells = 0;
        for surface in desk.surfaces.iter() {
            if let Some(count) = backend.models.of(surface.model).count_own() {
                let (wet, dry) = counts_own(surface, count);
                add(&mut stocks.dry, &dry);
                match surface.id {
                    PALETTE => add(&mut stocks.palette, &wet),
                    _ => add(&mut stocks.canvas, &wet),
                }
            }
            add(&mut stocks.dry, &surface.store.dry_counts());
            match surface.id {
                CANVAS => {
                    add(&mut stocks.canvas, &surface.store.counts());
                    covered_cells += covered(surface);
                }
                PALETTE => add(&mut stocks.palette, &surface.store.counts()),
                _ => {}
            }
        }
        let paints = desk.scene.paints.iter();
        let names: Vec<String> = paints.map(|slot| slot.name.clone()).collect();
        let (first, last) = self.work.span_ns.unwrap_or_default();
        let tallies = Tallies {
            steps: self.work.steps,
            footprint_cells: self.work.footprint_cells,
            covered_cells,
            seconds: (last - first) as f64 * 1e-9,
        };
        let quantum_m3 = quantum_m3(desk.surfaces.cell_m());
        balance(&self.ledger, &stocks, &names, quantum_m3, tallies)
    }
}

/// Paint in the planes that a model keeps of its own, wet and dry.
fn counts_own(surface: &SurfaceState, count: CountOwn) -> (Counts, Counts) {
    let (mut wet, mut dry) = ([0; SLOTS], [0; SLOTS]);
    for tile in surface.tiles() {
        add(&mut wet, &count(tile.wet().own()));
        for layer in tile.dry().into_iter().flat_map(|stack| stack.layers()) {
            add(&mut dry, &count(layer.planes.get().own()));
        }
    }
    (wet, dry)
}

/// Cells with paint, wet or dry.
fn covered(surface: &SurfaceState) -> u64 {
    let painted = |tile: &Arc<Tile>| {
        let (wet, dry) = (tile.wet(), tile.dry().map(|stack| stack.height()));
        let covered = |cell: &usize| {
            dry.as_ref().is_some_and(|height| height[*cell] > 0.0)
                || wet.iter().any(|(_, plane)| plane[*cell] > 0.0)
        };
        (0..TILE_CELLS).filter(covered).count() as u64
    };
    surface.tiles().map(painted).sum()
}
