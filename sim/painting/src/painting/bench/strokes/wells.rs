//! The wells of a palette under a stroke: paint that never runs out, and the cleaner.
//!
//! Under the brush a well's cells have its fresh mixture: paint pushed into them goes to the cleaner, paint taken comes
//! from the tubes. A jar of medium is a well of thinner that stays pure: paint left there by a step goes to the
//! cleaner. A brush that touches the cleaner is clean.

use std::sync::Arc;

use maulstick_appearance::heap::{HeapCells, WELL_M};
use maulstick_brush::HeadPose;
use maulstick_canvas::quantum::{QUANTUM_M, SLOTS};
use maulstick_canvas::window::Window;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_optics::THINNER;
use maulstick_types::Mixture;
use maulstick_types::scene::{Surface, Well, WellKind};

use super::cells::Cells;
use super::stroke::Stroke;
use crate::ledger::Ledger;
use crate::painting::bench::Workbench;

/// Share of medium in a brush's load up to which it soaks in a jar.
const SOAK_LIMIT: f64 = 0.85;
/// Share of the missing medium that is soaked up in a step.
const SOAK_RATE: f64 = 0.1;
/// A strip is down within this of the surface, cells.
const DIP_CELLS: f32 = 1.0;

/// The cells of a window that are in a well and in a rectangle.
fn cells_within(
    window: &Window,
    well: &Well,
    cell_m: f64,
    Cells { from, to }: Cells,
) -> Vec<usize> {
    let origin = window.origin();
    let limit = window.limit();
    let center = well.center_m.map(|m| m / cell_m);
    let radius = well.radius_m / cell_m;
    let span = |i: usize| {
        let low = (center[i] - radius).floor() as i64;
        let high = (center[i] + radius).ceil() as i64;
        let inside = |cell: i64| (cell - origin[i]).clamp(0, limit[i] as i64);
        inside(low.max(from[i]))..inside(high.min(to[i])).max(inside(low.max(from[i])))
    };
    let (across, up) = (span(0), span(1));
    let width = window.width();
    up.flat_map(move |y| across.clone().map(move |x| (x, y)))
        .filter(|(x, y)| {
            let dx = (origin[0] + x) as f64 + 0.5 - center[0];
            let dy = (origin[1] + y) as f64 + 0.5 - center[1];
            dx * dx + dy * dy < radius * radius
        })
        .map(|(x, y)| y as usize * width + x as usize)
        .collect()
}

/// True if a strip is down on the surface within a well.
fn is_in((pose, traits): (&HeadPose, &BrushTraits), well: &Well, cell_m: f64) -> bool {
    let low = traits.half_thickness + traits.sink + DIP_CELLS;
    let [x, y] = well.center_m.map(|m| (m / cell_m) as f32);
    let radius = (well.radius_m / cell_m) as f32;
    let places = pose.x.iter().zip(&pose.y).zip(&pose.z);
    places.into_iter().any(|((at_x, at_y), z)| {
        let (dx, dy) = (at_x - x, at_y - y);
        *z < low && dx * dx + dy * dy < radius * radius
    })
}

impl Stroke<'_> {
    /// Refills the wells under the brush before it steps there.
    pub(super) fn refill_wells(&mut self, cells: Cells, pose: &HeadPose, traits: &BrushTraits) {
        let described = &self.bench.desk.scene.surfaces[self.surface];
        let cell_m = described.cell_m;
        for (place, well) in wells_near(described, cells) {
            let dips = || is_in((pose, traits), &well, cell_m);
            let mixture = match &well.kind {
                WellKind::Paint { mixture } => mixture.clone(),
                WellKind::Medium => Mixture::pure(THINNER),
                WellKind::Cleaner => {
                    // The jar cleans a brush in it, whatever else of the head is low.
                    if dips() {
                        self.clean_in(&well, cells);
                    }
                    continue;
                }
            };
            let Workbench { desk, .. } = &mut *self.bench;
            // A paint without a slot: its well stays dry, and a command says why.
            let Ok(slots) = desk.slots(&mixture) else {
                continue;
            };
            let mut shares = [0.0; SLOTS];
            for (slot, share) in &slots {
                shares[*slot] += share;
            }
            if let (WellKind::Medium, [(thinner, _)]) = (&well.kind, &slots[..])
                && dips()
                && let Some(carried) = self.soak(*thinner)
            {
                // It meets its own mixture, so that it loses nothing more.
                shares = carried;
            }
            self.fill_well((place, &well), cells, &shares);
        }
    }

    /// Soaks the brush in a jar of medium; shares of its load then, unless that is medium alone.
    fn soak(&mut self, thinner: usize) -> Option<[f64; SLOTS]> {
        let Workbench {
            brushes, accounts, ..
        } = &mut *self.bench;
        let load = Arc::make_mut(&mut brushes[self.brush].load);
        let washed = load.soak(thinner, SOAK_LIMIT, SOAK_RATE);
        let mut soaked = [0; SLOTS];
        soaked[thinner] = washed.iter().sum();
        accounts.ledger.from_tube(&soaked);
        accounts.ledger.to_cleaner(&washed);
        let (counts, total) = (load.counts(), load.total());
        (counts[thinner] < total).then(|| counts.map(|count| count as f64 / total as f64))
    }

    /// Fills a well's cells to its height, with each slot's share.
    fn fill_well(&mut self, (place, well): (usize, &Well), cells: Cells, shares: &[f64; SLOTS]) {
        let Workbench {
            desk,
            brushes,
            accounts,
            ..
        } = &mut *self.bench;
        let Some((_, window)) = &mut brushes[self.brush].window else {
            return;
        };
        let cells = cells_within(
            window,
            well,
            desk.scene.surfaces[self.surface].cell_m,
            cells,
        );
        let heap = desk.surfaces[self.surface].bare.wells[place].heap();
        let thick = thicknesses(window, &cells, heap);
        renew(window, &cells, (shares, &thick), &mut accounts.ledger);
        window.note_top(thick.iter().copied().fold(0.0, f64::max) as f32);
    }

    /// Cleans the brush in a jar of cleaner.
    fn clean_in(&mut self, well: &Well, cells: Cells) {
        let Workbench {
            desk,
            brushes,
            accounts,
            ..
        } = &mut *self.bench;
        let brush = &mut brushes[self.brush];
        let Some((_, window)) = &mut brush.window else {
            return;
        };
        let cells = cells_within(
            window,
            well,
            desk.scene.surfaces[self.surface].cell_m,
            cells,
        );
        if !cells.is_empty() {
            renew(window, &cells, NOTHING, &mut accounts.ledger);
            let left = Arc::make_mut(&mut brush.load).take_all();
            accounts.ledger.to_cleaner(&left);
        }
    }

    /// Empties the jars of medium under the brush after its step.
    pub(super) fn empty_jars(&mut self, cells: Cells) {
        let Workbench {
            desk,
            brushes,
            accounts,
            ..
        } = &mut *self.bench;
        let described = &desk.scene.surfaces[self.surface];
        let Some((_, window)) = &mut brushes[self.brush].window else {
            return;
        };
        for (_, well) in wells_near(described, cells) {
            if well.kind == WellKind::Medium {
                let cells = cells_within(window, &well, described.cell_m, cells);
                renew(window, &cells, NOTHING, &mut accounts.ledger);
            }
        }
    }
}

/// The wells of a surface that reach into these cells, by their number.
fn wells_near(surface: &Surface, Cells { from, to }: Cells) -> Vec<(usize, Well)> {
    let near = |(_, well): &(usize, &Well)| {
        (0..2).all(|i| {
            let low = (well.center_m[i] - well.radius_m) / surface.cell_m;
            let high = (well.center_m[i] + well.radius_m) / surface.cell_m;
            low < to[i] as f64 && high > from[i] as f64
        })
    };
    let wells = surface.wells.iter().enumerate().filter(near);
    wells.map(|(place, well)| (place, well.clone())).collect()
}

/// Quanta of paint in cells of a well: its heap, or a jar filled evenly.
fn thicknesses(window: &Window, cells: &[usize], heap: Option<&HeapCells>) -> Vec<f64> {
    let (origin, width) = (window.origin(), window.width());
    let quanta = |cell: &usize| {
        let within = [cell % width, cell / width].map(|at| at as i64);
        let thickness_m = heap.map_or(WELL_M, |heap| {
            let cell = [0, 1].map(|i| origin[i] + within[i]);
            heap.thickness_m(cell).into()
        });
        thickness_m / QUANTUM_M
    };
    cells.iter().map(quanta).collect()
}

/// No paint, for [`renew`].
const NOTHING: (&[f64; SLOTS], &[f64]) = (&[0.0; SLOTS], &[]);

/// Renews cells with fresh paint, of each slot a share of the cell's quanta: the cleaner takes the excess, the tubes
/// supply the deficit.
fn renew(
    window: &mut Window,
    cells: &[usize],
    (shares, quanta): (&[f64; SLOTS], &[f64]),
    ledger: &mut Ledger,
) {
    let (mut given, mut taken) = ([0; SLOTS], [0; SLOTS]);
    for (slot, share) in shares.iter().enumerate() {
        if *share == 0.0 && !window.has(slot) {
            continue;
        }
        let plane = window.plane_mut(slot);
        for (at, cell) in cells.iter().enumerate() {
            let held = plane[*cell] as u64;
            let wanted = quanta.get(at).map_or(0, |quanta| (share * quanta) as u64);
            given[slot] += wanted.saturating_sub(held);
            taken[slot] += held.saturating_sub(wanted);
            plane[*cell] = wanted as f32;
        }
    }
    ledger.from_tube(&given);
    ledger.to_cleaner(&taken);
    window.touch_cells(cells);
}
