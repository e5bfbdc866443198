//! Strokes: states of a brush become steps of the paint model on windows of tiles.

pub(crate) mod backend;
mod models;
mod relaxing;
mod step;
mod windows;

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::Half;
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::path::PathStepper;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::scene::CANVAS;

use super::Painting;
use backend::Deferral;

/// Steps of a landing on a palette, about as high as its heaps.
const DIP: f64 = 4.0;

impl Painting {
    /// Paints what a brush did in its epoch: strokes are numbered from 1 in each.
    ///
    /// # Errors
    /// [`EditError`] for an unknown brush, or a state that does not fit its brush file.
    pub fn state(&mut self, brush: &str, epoch: u32, state: &BrushState) -> Result<(), EditError> {
        let brush = self.brushes.at(brush)?;
        let solved = state.solves.iter();
        let painted = solved.map(|solve| self.solve(brush, epoch, solve));
        let painted: Result<(), EditError> = painted.collect();
        self.book(Some(brush));
        painted
    }

    fn solve(&mut self, brush: usize, epoch: u32, solve: &Solve) -> Result<(), EditError> {
        let own = &self.brushes[brush];
        let fits = solve.stroke == 0 || own.head.fits(solve.angles_rad.len());
        if !fits || solve.fault().is_some() {
            return Err(EditError::Unfit(own.name.clone()));
        }
        self.accounts.note_time(solve.event_ns);
        let Ok(on) = self.surfaces.at(solve.surface) else {
            return Ok(());
        };
        if solve.flags & solve_flags::PREVIEW != 0 {
            return Ok(());
        }
        let scale = Scale {
            cell_m: self.surfaces[on].cell_m,
            zoom: solve.zoom,
        };
        if solve.stroke == 0 {
            self.lift(brush);
            self.backend.facts.stroke_ends();
            return Ok(());
        }
        let restarted = solve.flags & solve_flags::RESTARTED != 0;
        let lands = self.brushes[brush].path.is_none();
        if self.brushes[brush].stroke != Some((epoch, solve.stroke)) {
            // A brush that rested and never left keeps its bristles as they lie.
            let rested = restarted && self.brushes[brush].path.is_some();
            self.lift(brush);
            self.brushes[brush].stroke = Some((epoch, solve.stroke));
            if !rested {
                self.settle();
                self.brushes[brush].disorder();
            }
            self.thin(brush, on, scale);
            self.begin_stroke(brush)?;
        }
        let path = &mut self.brushes[brush].path;
        let running = path.take_if(|(at, path)| *at == on && path.scale() == scale && !restarted);
        if running.is_none() {
            self.end_path(brush);
            self.thin(brush, on, scale);
        }
        let traits = BrushTraits::of(&self.brushes[brush].thinned, scale.cell_m, scale.zoom);
        let waypoint = Waypoint::of(solve, scale, self.seen_fullness(brush, on, &traits));
        let head = Arc::clone(&self.brushes[brush].head);
        let Some((_, mut path)) = running else {
            let path = if lands {
                let dips = !self.scene.surfaces[on].wells.is_empty();
                let landed = (waypoint, if dips { DIP } else { 1.0 });
                PathStepper::landing(&head, landed, scale, |sweep, doublings| {
                    self.step((brush, on), scale, (sweep, doublings));
                })
            } else {
                PathStepper::begin(&head, waypoint, scale)
            };
            self.brushes[brush].path = Some((on, path));
            return Ok(());
        };
        path.advance(&head, (waypoint, solve.doublings()), |sweep, doublings| {
            self.step((brush, on), scale, (sweep, doublings));
        });
        self.brushes[brush].path = Some((on, path));
        Ok(())
    }

    /// Thins a brush that comes down on the canvas to the strips that its cells can tell apart. On a palette it stays
    /// as it is: its load would be merged and split at each dip.
    fn thin(&mut self, brush: usize, on: usize, scale: Scale) {
        if self.surfaces[on].id == CANVAS {
            self.settle();
            self.brushes[brush].thin_for(scale.cell_m * scale.zoom);
        }
    }

    /// Ends a brush's contact: what it left relaxes.
    fn lift(&mut self, brush: usize) {
        if let Some(on) = self.end_path(brush) {
            self.relax(brush, on);
        }
    }

    /// Steps the rest of a brush's path; returns the index of the surface, if it was in contact.
    fn end_path(&mut self, brush: usize) -> Option<usize> {
        let own = &mut self.brushes[brush];
        let (on, mut path) = own.path.take()?;
        let (head, scale) = (Arc::clone(&own.head), path.scale());
        path.end(&head, |sweep, doublings| {
            self.step((brush, on), scale, (sweep, doublings));
        });
        Some(on)
    }

    fn begin_stroke(&mut self, brush: usize) -> Result<(), EditError> {
        self.begin_stroke_step(brush);
        self.backend.facts.stroke_ends();
        let own = &mut self.brushes[brush];
        own.deferral = Deferral::default();
        let (number, seed) = (own.strokes, own.seed);
        own.strokes += 1;
        if own.loads.is_empty() {
            return Ok(());
        }
        let mixture = &own.loads[number % own.loads.len()];
        let slots = self.optics.slots(&mut self.scene, mixture)?;
        self.fill(brush, &[(&slots, Half::Both)], seed);
        Ok(())
    }
}
