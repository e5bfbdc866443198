//! A brush in contact with a surface.

use std::sync::Arc;

use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::Half;
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::path::PathStepper;
use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::scene::CANVAS;

use crate::error::EditError;
use crate::painting::backend::deferral::Deferral;
use crate::painting::bench::Workbench;
use crate::painting::brushes::PaintingBrush;
use crate::painting::surfaces::SurfaceState;

/// Steps of a landing on a palette, about as high as its heaps.
const DIP_STEPS: f64 = 4.0;

/// A brush on a surface, at one scale.
pub(super) struct Stroke<'a> {
    pub(super) bench: &'a mut Workbench,
    /// Index of the brush.
    pub(super) brush: usize,
    /// Index of the surface.
    pub(super) surface: usize,
    pub(super) scale: Scale,
}

impl Stroke<'_> {
    /// The brush.
    pub(super) fn brush(&self) -> &PaintingBrush {
        &self.bench.brushes[self.brush]
    }

    /// The brush.
    pub(super) fn brush_mut(&mut self) -> &mut PaintingBrush {
        &mut self.bench.brushes[self.brush]
    }

    /// The surface.
    pub(super) fn surface(&self) -> &SurfaceState {
        &self.bench.desk.surfaces[self.surface]
    }

    /// True on a palette with wells.
    pub(super) fn has_wells(&self) -> bool {
        !self.bench.desk.scene.surfaces[self.surface]
            .wells
            .is_empty()
    }

    /// Traits of the brush on the surface's cells.
    pub(super) fn traits(&self) -> BrushTraits {
        BrushTraits::of(&self.brush().thinned, self.scale.cell_m, self.scale.zoom)
    }

    /// Follows the brush to a solve of its epoch.
    ///
    /// # Errors
    /// [`EditError`] if the stroke begins with a load that has one paint more than there are slots.
    pub(super) fn follow(mut self, epoch: u32, solve: &Solve) -> Result<(), EditError> {
        let is_restarted = solve.flags & solve_flags::RESTARTED != 0;
        let lands = self.brush().path.is_none();
        if self.brush().stroke != Some((epoch, solve.stroke)) {
            // A brush that rested and never left keeps the disorder of its bristles.
            let rested = is_restarted && !lands;
            self.begin((epoch, solve.stroke), rested)?;
        }
        let (surface, scale) = (self.surface, self.scale);
        let running = self
            .brush_mut()
            .path
            .take_if(|(on, path)| *on == surface && path.scale() == scale && !is_restarted);
        if running.is_none() {
            self.bench.end_path(self.brush);
            self.thin();
        }
        let waypoint = Waypoint::of(solve, scale, self.seen_fullness());
        let head = Arc::clone(&self.brush().head);
        let path = if let Some((_, mut path)) = running {
            let to = (waypoint, solve.doublings());
            path.advance(&head, to, |sweep, doublings| self.step(sweep, doublings));
            path
        } else if lands {
            let steps = if self.has_wells() { DIP_STEPS } else { 1.0 };
            PathStepper::landing(&head, (waypoint, steps), scale, |sweep, doublings| {
                self.step(sweep, doublings);
            })
        } else {
            PathStepper::begin(&head, waypoint, scale)
        };
        let own = self.brush_mut();
        let path = if own.regroup() {
            path.regrouped(&own.head)
        } else {
            path
        };
        own.path = Some((surface, path));
        Ok(())
    }

    /// Begins the stroke with this epoch and number: the bristles get another disorder, unless the brush rested.
    fn begin(&mut self, stroke: (u32, u64), rested: bool) -> Result<(), EditError> {
        self.bench.lift(self.brush);
        self.brush_mut().stroke = Some(stroke);
        if !rested {
            self.bench.settle();
            self.bench.accounts.work.strokes += 1;
            let number = self.bench.accounts.work.strokes;
            self.brush_mut().disorder(number);
        }
        self.thin();
        self.bench.begin_stroke_step(self.brush);
        self.bench.backend.stroke_ends();
        self.load_next()
    }

    /// Loads the brush of a take with the next of its loads.
    fn load_next(&mut self) -> Result<(), EditError> {
        let own = self.brush_mut();
        own.deferral = Deferral::default();
        let (number, seed) = (own.strokes, own.seed);
        own.strokes += 1;
        if own.loads.is_empty() {
            return Ok(());
        }
        let mixture = own.loads[number % own.loads.len()].clone();
        let Workbench {
            desk,
            brushes,
            accounts,
            ..
        } = &mut *self.bench;
        let slots = desk.slots(&mixture)?;
        let (parts, ledger) = ([(&slots[..], Half::Both)], &mut accounts.ledger);
        brushes[self.brush].fill(&parts, desk, seed, ledger);
        Ok(())
    }

    /// Thins a brush that comes down on the canvas to the strips that its cells can resolve. On a palette it is
    /// unchanged: its load would be merged and split at each dip.
    fn thin(&mut self) {
        if self.surface().id == CANVAS {
            self.bench.settle();
            let cell_m = self.scale.cell_m * self.scale.zoom;
            self.brush_mut().thin_for(cell_m);
        }
    }

    /// Steps the rest of the brush's path.
    pub(super) fn finish(&mut self, mut path: PathStepper) {
        let head = Arc::clone(&self.brush().head);
        path.end(&head, |sweep, doublings| self.step(sweep, doublings));
    }
}
