//! Strokes: states of a brush become steps of the paint model on windows of tiles.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::ride;
use maulstick_canvas::store::TileRect;
use maulstick_canvas::window::Window;
use maulstick_model::brush::head::{Waypoint, low_bounds};
use maulstick_model::brush::load::Half;
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Step, Sweep};
use maulstick_model::path::PathStepper;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::scene::CANVAS;

use super::Painting;
use super::backend::Deferral;
use super::brush_modes::{Prepared, handling_of};
use crate::history::OpenStep;

/// A window reaches this many cells beyond the head, so that it is not opened anew at each step.
const WINDOW_MARGIN: i64 = 32;

impl Painting {
    /// Paints what a brush did in its epoch: strokes are numbered from 1 in each.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, epoch: u32, state: &BrushState) -> Result<(), EditError> {
        let solved = state.solves.iter();
        let painted = solved.map(|solve| self.solve(brush, epoch, solve));
        let painted: Result<(), EditError> = painted.collect();
        self.book(Some(brush));
        painted
    }

    pub(super) fn solve(&mut self, name: &str, epoch: u32, solve: &Solve) -> Result<(), EditError> {
        let track = self.brush(name)?;
        let fits = solve.stroke == 0 || track.head.fits(solve.angles_rad.len());
        if !fits || solve.fault().is_some() {
            return Err(EditError::Unfit(name.to_owned()));
        }
        let (first, last) = self.span_ns.unwrap_or((solve.event_ns, solve.event_ns));
        self.span_ns = Some((first, last.max(solve.event_ns)));
        let Some(sheet) = self
            .sheets
            .iter()
            .position(|sheet| sheet.id == solve.surface)
        else {
            return Ok(());
        };
        if solve.flags & solve_flags::PREVIEW != 0 {
            return Ok(());
        }
        let scale = Scale {
            cell_m: self.sheets[sheet].cell_m,
            zoom: solve.zoom,
        };
        let track = self.brush(name)?;
        if solve.stroke == 0 {
            self.lift(name)?;
            self.fall.stroke_ends();
            return Ok(());
        }
        let restarted = solve.flags & solve_flags::RESTARTED != 0;
        if track.stroke != Some((epoch, solve.stroke)) {
            // A brush that rested and never left keeps its bristles as they lie.
            let rested = restarted && track.path.is_some();
            self.lift(name)?;
            self.brush(name)?.stroke = Some((epoch, solve.stroke));
            if !rested {
                self.disorder(name)?;
            }
            self.thin(name, sheet, scale)?;
            self.begin_stroke(name)?;
        }
        let track = self.brush(name)?;
        let running = track
            .path
            .take_if(|(on, path)| *on == sheet && path.scale() == scale && !restarted);
        if running.is_none() {
            self.end_path(name)?;
            self.thin(name, sheet, scale)?;
        }
        let track = self.brush(name)?;
        let traits = BrushTraits::of(&track.thinned, scale.cell_m, scale.zoom);
        let waypoint = Waypoint::of(solve, scale, self.seen_fullness(name, sheet, &traits)?);
        let track = self.brush(name)?;
        let head = Arc::clone(&track.head);
        let Some((_, mut path)) = running else {
            track.path = Some((sheet, PathStepper::begin(&head, waypoint, scale)));
            return Ok(());
        };
        path.advance(&head, (waypoint, solve.doublings()), |sweep, doublings| {
            self.step(name, sheet, scale, (sweep, doublings));
        });
        self.brush(name)?.path = Some((sheet, path));
        Ok(())
    }

    /// Thins a brush that comes down on the canvas to the strips that its cells can tell apart. On a palette it stays
    /// as it is: its load would be merged and split at each dip.
    fn thin(&mut self, name: &str, sheet: usize, scale: Scale) -> Result<(), EditError> {
        if self.sheets[sheet].id == CANVAS {
            self.settle();
            self.brush(name)?.thin_for(scale.cell_m * scale.zoom);
        }
        Ok(())
    }

    /// Ends a brush's contact: what it left relaxes.
    fn lift(&mut self, name: &str) -> Result<(), EditError> {
        if let Some(sheet) = self.end_path(name)? {
            self.relax(name, sheet);
        }
        Ok(())
    }

    /// Steps the rest of a brush's path; returns the index of the surface, if it was in contact.
    fn end_path(&mut self, name: &str) -> Result<Option<usize>, EditError> {
        let track = self.brush(name)?;
        let Some((sheet, mut path)) = track.path.take() else {
            return Ok(None);
        };
        let (head, scale) = (Arc::clone(&track.head), path.scale());
        path.end(&head, |sweep, doublings| {
            self.step(name, sheet, scale, (sweep, doublings));
        });
        Ok(Some(sheet))
    }

    /// Disorders the bristles of a brush by the number of strokes since its take began, so that a take is the same
    /// however often it is played.
    fn disorder(&mut self, name: &str) -> Result<(), EditError> {
        self.settle();
        let track = self.brush(name)?;
        track.seed = track.next_seed();
        track.head = track.disordered();
        Arc::make_mut(&mut track.load).disorder(track.seed);
        Ok(())
    }

    pub(super) fn begin_stroke(&mut self, name: &str) -> Result<(), EditError> {
        self.begin_step("stroke", Some(name));
        self.fall.stroke_ends();
        let track = self.brush(name)?;
        track.deferral = Deferral::default();
        let (number, seed) = (track.strokes, track.seed);
        track.strokes += 1;
        if track.loads.is_empty() {
            return Ok(());
        }
        let mixture = track.loads[number % track.loads.len()].clone();
        let slots = self.slots(&mixture)?;
        self.fill(name, &[(&slots, Half::Both)], seed)
    }

    /// One step of the paint model, doubled so many times.
    pub(super) fn step(
        &mut self,
        name: &str,
        sheet: usize,
        scale: Scale,
        (sweep, doublings): (Sweep<'_>, u32),
    ) {
        self.steps += 1;
        let Some(track) = self.brushes.get(name) else {
            return;
        };
        let traits = BrushTraits::of(&track.thinned, scale.cell_m, scale.zoom).doubled(doublings);
        let model = self.sheets[sheet].model;
        let deferred = self.models.of(model).defers() && !self.has_wells(sheet);
        let height = if deferred {
            // The height of the paint is not known here.
            f32::INFINITY
        } else {
            let wet = self.sheets[sheet].top * (QUANTUM_M / scale.cell_m) as f32;
            let film = track.load.thickest() as f32 * traits.film_cells_per_quantum;
            let tooth = (self.sheets[sheet].bare.relief.depth_m() / scale.cell_m) as f32;
            wet + film + traits.sink + tooth
        };
        let Some((from, to)) = low_bounds(&track.head, sweep.to, &traits, height) else {
            return;
        };
        if self.history.open_of(Some(name)).is_none() {
            // A command ended the stroke's undo step: the rest of the stroke is one of its own.
            self.begin_step("stroke", Some(name));
        }
        // Paint is pushed a cell farther than the brush comes.
        let (outer_from, outer_to) = (from.map(|cell| cell - 1), to.map(|cell| cell + 1));
        self.claim(name, sheet, outer_from, outer_to);
        let ride = ride::reach(scale.cell_m) as i64;
        let (ride_from, ride_to) = (from.map(|cell| cell - ride), to.map(|cell| cell + ride));
        if !self.reach(name, sheet, ride_from, ride_to) {
            return;
        }
        if !deferred || self.unsettled.as_deref() != Some(name) {
            self.settle();
        }
        self.tend_wells(name, sheet, (from, to), (sweep.to, &traits));
        let mut handlings = self.scene.handlings.iter();
        let handling = handling_of(handlings.find(|handling| handling.brush == name));
        let id = self.sheets[sheet].id;
        let surface = self.scene.surfaces.iter().find(|surface| surface.id == id);
        let prepared = Prepared::of(surface);
        let thinner = self.thinner();
        let Some(track) = self.brushes.get_mut(name) else {
            return;
        };
        let Some((_, window)) = &mut track.window else {
            return;
        };
        // Below this the head may touch.
        window.note_top(self.sheets[sheet].top);
        let mut step = Step {
            window,
            head: &track.head,
            sweep,
            bounds: (from, to),
            load: Arc::make_mut(&mut track.load),
            traits: prepared.traits(traits, handling.transfer),
            handling,
            stain: prepared.stain,
            lasting: prepared.lasting,
            thinner,
        };
        let report = if deferred {
            self.models.of(model).step(&mut step)
        } else {
            self.models.of(model).step_now(&mut step)
        };
        self.sheets[sheet].top = self.sheets[sheet].top.max(window.top());
        // The report of deferred steps covers all that were not settled.
        let unsettled = if deferred {
            track.deferral.unsettled_steps()
        } else {
            0
        };
        self.note((name, sheet), &report, 1 + unsettled);
        if deferred {
            self.defer(name);
        }
    }

    /// Makes sure that the brush's window holds the cells `from`..`to`; false if they are all outside the surface.
    pub(super) fn reach(&mut self, name: &str, sheet: usize, from: [i64; 2], to: [i64; 2]) -> bool {
        let Some(needed) = self.sheets[sheet].store.around(from, to) else {
            return false;
        };
        let Some(track) = self.brushes.get(name) else {
            return false;
        };
        if let Some((on, window)) = &track.window
            && *on == sheet
            && window.rect().holds(&needed)
        {
            return true;
        }
        let wide = |edge: [i64; 2], by: i64| edge.map(|cell| cell + by);
        let rect = self.sheets[sheet]
            .store
            .around(wide(from, -WINDOW_MARGIN), wide(to, WINDOW_MARGIN))
            .unwrap_or(needed);
        self.close_window(name);
        let window = self.open_window(sheet, rect).or_else(|| {
            // Another brush holds some of these tiles: its paint is written back first.
            self.close_windows();
            self.open_window(sheet, rect)
        });
        let opened = window.is_some();
        if let Some(track) = self.brushes.get_mut(name) {
            track.window = window.map(|window| (sheet, window));
        }
        opened
    }

    /// Notes which tiles a brush's step reaches, and ends the open steps of other brushes that have
    /// reached one of them: no two steps change a tile at the same time.
    fn claim(&mut self, name: &str, sheet: usize, from: [i64; 2], to: [i64; 2]) {
        let surface = self.sheets[sheet].id;
        let Some(rect) = self.sheets[sheet].store.around(from, to) else {
            return;
        };
        let Some(open) = self.history.open_of(Some(name)) else {
            return;
        };
        if open.last_reach == Some((surface, rect)) {
            return;
        }
        open.last_reach = Some((surface, rect));
        open.reached.extend(rect.tiles().map(|id| (surface, id)));
        let shares = |step: &OpenStep| {
            let mut tiles = rect.tiles();
            let others = step.brush.as_deref() != Some(name);
            others && tiles.any(|id| step.reached.contains(&(surface, id)))
        };
        if self.history.open().any(shares) {
            self.end_step(shares);
        }
    }

    fn open_window(&mut self, sheet: usize, rect: TileRect) -> Option<Window> {
        let sheet = &mut self.sheets[sheet];
        Window::open(&mut sheet.store, rect, &sheet.bare.relief)
    }

    /// Writes what the windows hold back to the tiles.
    pub fn commit(&mut self) {
        self.settle();
        for (name, track) in &mut self.brushes {
            if let Some((sheet, window)) = &mut track.window {
                let sheet = &mut self.sheets[*sheet];
                let (id, history) = (sheet.id, &mut self.history);
                window.commit(&mut sheet.store, &mut self.versions, |tile, version| {
                    history.replaced(Some(name), (id, tile), version.tile);
                });
            }
        }
    }

    pub(super) fn close_window(&mut self, name: &str) {
        self.commit();
        if let Some(track) = self.brushes.get_mut(name)
            && let Some((sheet, window)) = track.window.take()
        {
            window.close(&mut self.sheets[sheet].store);
        }
    }

    pub(super) fn close_windows(&mut self) {
        self.commit();
        for track in self.brushes.values_mut() {
            if let Some((sheet, window)) = track.window.take() {
                window.close(&mut self.sheets[sheet].store);
            }
        }
    }
}
