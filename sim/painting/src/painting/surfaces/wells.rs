//! The wells of a palette: paint that never runs out, and the cleaner.
//!
//! Under the brush a well's cells hold its mixture, fresh: paint that was pushed into them goes to the cleaner, paint
//! that was taken comes from the tubes. A jar of medium is a well of thinner in which nothing stays: what a step leaves
//! there goes to the cleaner. A brush that touches the cleaner is clean.

use std::sync::Arc;

use maulstick_appearance::heap::{HeapCells, WELL_M};
use maulstick_brush::HeadPose;
use maulstick_canvas::EditError;
use maulstick_canvas::quantum::{QUANTUM_M, SLOTS};
use maulstick_canvas::window::Window;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_optics::THINNER;
use maulstick_types::Mixture;
use maulstick_types::paint::StepName;
use maulstick_types::scene::{Surface, Well, WellKind};

use crate::error::paint_error;
use crate::ledger::Ledger;
use crate::painting::Painting;
use crate::painting::surfaces::well_moves::WellMoves;

/// Wells may reach beyond the edge of their surface by what rounding makes of it, m.
const EDGE_M: f64 = 1e-6;
/// A brush in a jar of medium soaks it up until it is this share of what it carries.
const SOAK_LIMIT: f64 = 0.85;
/// Share of the missing medium that is soaked up in a step.
const SOAK_RATE: f64 = 0.1;
/// A strip is down within this of the surface, cells.
const DIPS: f32 = 1.0;

/// The cells of a window that are in a well and in a rectangle.
fn cells_within(
    window: &Window,
    well: &Well,
    cell_m: f64,
    (from, to): ([i64; 2], [i64; 2]),
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
    let low = traits.half_thickness + traits.sink + DIPS;
    let [x, y] = well.center_m.map(|m| (m / cell_m) as f32);
    let radius = (well.radius_m / cell_m) as f32;
    let places = pose.x.iter().zip(&pose.y).zip(&pose.z);
    places.into_iter().any(|((at_x, at_y), z)| {
        let (dx, dy) = (at_x - x, at_y - y);
        *z < low && dx * dx + dy * dy < radius * radius
    })
}

impl Painting {
    pub(crate) fn set_wells(&mut self, surface: u32, wells: &[Well]) -> Result<(), EditError> {
        let on = self.surfaces.at(surface)?;
        let mut changed = self.scene.surfaces[on].clone();
        let size = changed.cells.map(|cells| f64::from(cells) * changed.cell_m);
        changed.wells = wells.to_vec();
        for (place, well) in changed.wells.iter_mut().enumerate() {
            let lies = |i: usize| {
                let [low, high] = [-well.radius_m, well.radius_m].map(|r| well.center_m[i] + r);
                low >= -EDGE_M && high <= size[i] + EDGE_M
            };
            if well.radius_m <= 0.0 || !(lies(0) && lies(1)) {
                return Err(EditError::WellBeside {
                    place: place + 1,
                    surface_mm: size.map(|m| m * 1e3),
                });
            }
            if let WellKind::Paint { mixture } = &mut well.kind {
                *mixture = self.optics.library.check(mixture).map_err(paint_error)?;
            }
        }
        let before = &self.scene.surfaces[on].wells;
        if changed.wells == *before {
            return Ok(());
        }
        let ways = WellMoves::between((before, &changed.wells), &changed);
        let relief = Some(Arc::clone(&self.surfaces[on].bare.relief));
        let bare = Arc::new(self.optics.blank(&changed, relief)?);
        self.close_windows();
        let moved = self.surfaces[on].with_moved_paint(&ways, &self.surfaces.pager);
        // A palette that is laid out before anything was painted is nothing to undo.
        let is_step = !moved.is_empty() || self.history.has_changed_surfaces();
        if !moved.is_empty() {
            self.clock.stop(Some(surface));
        }
        if is_step {
            self.begin_step(StepName::Wells, None);
        }
        self.scene.surfaces[on] = changed;
        self.surfaces[on].bare = bare;
        self.scene.version += 1;
        self.optics.renew(&self.scene);
        if !moved.is_empty() {
            self.put_scraped(on, moved);
        }
        if is_step {
            self.end_own_step();
        }
        Ok(())
    }

    /// Tends the wells in the cells `from`..`to` of a surface before a brush steps there.
    pub(crate) fn tend_wells(
        &mut self,
        (brush, on): (usize, usize),
        (from, to): ([i64; 2], [i64; 2]),
        head: (&HeadPose, &BrushTraits),
    ) {
        let cell_m = self.scene.surfaces[on].cell_m;
        let wells = wells_near(&self.scene.surfaces[on], (from, to));
        let ledger = &mut self.accounts.ledger;
        for (place, well) in wells {
            let heap = self.surfaces[on].bare.wells[place].heap().cloned();
            let brush = &mut self.brushes[brush];
            let Some((_, window)) = &mut brush.window else {
                return;
            };
            match &well.kind {
                WellKind::Paint { .. } | WellKind::Medium => {
                    let mixture = match &well.kind {
                        WellKind::Paint { mixture } => mixture.clone(),
                        _ => Mixture::pure(THINNER),
                    };
                    // A paint without a slot: its well stays dry, and a command says why.
                    let Ok(slots) = self.optics.slots(&mut self.scene, &mixture) else {
                        continue;
                    };
                    let cells = cells_within(window, &well, cell_m, (from, to));
                    let thick = thicknesses(window, &cells, heap.as_ref());
                    let mut shares = [0.0; SLOTS];
                    for (slot, share) in &slots {
                        shares[*slot] += share;
                    }
                    if let (WellKind::Medium, [(thinner, _)]) = (&well.kind, &slots[..])
                        && is_in(head, &well, cell_m)
                    {
                        let load = Arc::make_mut(&mut brush.load);
                        let washed = load.soak(*thinner, SOAK_LIMIT, SOAK_RATE);
                        let mut soaked = [0; SLOTS];
                        soaked[*thinner] = washed.iter().sum();
                        ledger.from_tube(&soaked);
                        ledger.to_cleaner(&washed);
                        let (counts, total) = (load.counts(), load.total());
                        if counts[*thinner] < total {
                            // What it meets is what it carries: it loses no more than that.
                            shares = counts.map(|count| count as f64 / total as f64);
                        }
                    }
                    renew(window, &cells, (&shares, &thick), ledger);
                    window.note_top(thick.iter().copied().fold(0.0, f64::max) as f32);
                }
                // Whatever else of the head is low, the jar cleans a brush that is in it.
                WellKind::Cleaner if is_in(head, &well, cell_m) => {
                    let cells = cells_within(window, &well, cell_m, (from, to));
                    if !cells.is_empty() {
                        renew(window, &cells, NOTHING, ledger);
                        let left = Arc::make_mut(&mut brush.load).take_all();
                        ledger.to_cleaner(&left);
                    }
                }
                WellKind::Cleaner => {}
            }
        }
    }

    /// Empties the jars of medium in the cells `from`..`to` after a step of a brush there.
    pub(crate) fn empty_jars(
        &mut self,
        (brush, on): (usize, usize),
        (from, to): ([i64; 2], [i64; 2]),
    ) {
        let surface = &self.scene.surfaces[on];
        let Some((_, window)) = &mut self.brushes[brush].window else {
            return;
        };
        for (_, well) in wells_near(surface, (from, to)) {
            if well.kind == WellKind::Medium {
                let cells = cells_within(window, &well, surface.cell_m, (from, to));
                renew(window, &cells, NOTHING, &mut self.accounts.ledger);
            }
        }
    }
}

/// The wells of a surface that reach into the cells `from`..`to`, by their number.
fn wells_near(surface: &Surface, (from, to): ([i64; 2], [i64; 2])) -> Vec<(usize, Well)> {
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

/// Makes cells hold just what is fresh, of each slot a share of the cell's quanta: the cleaner takes what is too much,
/// the tubes give what is missing.
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
