//! The paint models and their backends. Deferred steps reach planes and load once they are settled: before anything
//! else looks at them.

use std::sync::Arc;

use maulstick_model::interface::{PaintModel, StepReport};
use maulstick_types::paint::Decision;

use super::models::Models;
use super::stroke::Stroke;
use crate::painting::Painting;
use crate::painting::brushes::handling::UnderBrush;
use crate::painting::surfaces::SurfaceState;

/// A fact of a model's backend. It is reported where a stroke ends.
#[derive(Debug)]
struct BackendFact<T> {
    found: Option<T>,
    due: bool,
}

impl<T> Default for BackendFact<T> {
    fn default() -> Self {
        Self {
            found: None,
            due: false,
        }
    }
}

impl<T> BackendFact<T> {
    fn find(&mut self, what: Option<T>) {
        if what.is_some() {
            self.found = what;
        }
    }

    fn stroke_ends(&mut self) {
        self.due |= self.found.is_some();
    }

    fn take(&mut self) -> Option<T> {
        if !std::mem::take(&mut self.due) {
            return None;
        }
        self.found.take()
    }
}

/// The reason why a model changed its backend, and a limit that its backend has met.
#[derive(Debug, Default)]
pub(super) struct BackendFacts {
    fall: BackendFact<String>,
    limit: BackendFact<Decision>,
}

impl BackendFacts {
    /// A stroke ends or begins.
    pub(super) fn stroke_ends(&mut self) {
        self.fall.stroke_ends();
        self.limit.stroke_ends();
    }
}

/// Paint models in use, and their unsettled steps.
#[derive(Default)]
pub(crate) struct Backend {
    pub(crate) models: Models,
    /// Index of the brush whose newest steps the model has not settled.
    pub(super) unsettled: Option<usize>,
    pub(super) facts: BackendFacts,
}

impl Backend {
    /// True if steps on a surface are deferred. Those on one with wells never are: wells are refilled on the CPU, step by
    /// step.
    pub(super) fn defers(&mut self, surface: &SurfaceState, has_wells: bool) -> bool {
        self.models.of(surface.model).defers() && !has_wells
    }
}

impl Painting {
    /// Sets the model that computes the steps of surfaces with a model of this name.
    pub fn set_model(&mut self, model: Box<dyn PaintModel>) {
        self.close_windows();
        self.backend.models.replace(model);
    }

    /// Backend of the steps on its canvas: `cpu`, or `gpu` and the adapter's name.
    #[must_use]
    pub fn backend(&self) -> String {
        self.backend.models.backend(self.surfaces[0].model)
    }

    /// The reason why its backend changed, returned once, after the stroke in which it changed.
    pub fn take_backend_change(&mut self) -> Option<String> {
        self.backend.facts.fall.take()
    }

    /// A limit that its backend has met, returned once, after the stroke in which it did.
    pub fn take_limit(&mut self) -> Option<Decision> {
        self.backend.facts.limit.take()
    }

    /// Makes the model write back its results.
    pub(crate) fn settle(&mut self) {
        if let Some(brush) = self.backend.unsettled.take()
            && let own = &mut self.brushes[brush]
            && let Some((on, window)) = &mut own.window
        {
            let on = *on;
            let surface = &mut self.surfaces[on];
            let model = self.backend.models.of(surface.model);
            let report = model.settle(window, Arc::make_mut(&mut own.load));
            let steps = own.deferral.settle();
            surface.top = surface.top.max(window.top());
            self.note(brush, on, &report, steps);
            self.book(Some(brush));
        }
        let Backend { models, facts, .. } = &mut self.backend;
        facts.fall.find(models.take_backend_change());
        facts.limit.find(models.take_limit());
    }

    /// Records the results of a number of a brush's steps on a surface; those of deferred ones are known when they are
    /// settled.
    fn note(&mut self, brush: usize, surface: usize, report: &StepReport, steps: u32) {
        self.accounts.note(report);
        let defers = self.backend.defers(&self.surfaces[surface], false);
        if !defers || report.footprint_cells > 0 {
            let rheology = &self.surfaces[surface].model.rheology;
            let under = UnderBrush::mean(report, steps, self.surfaces.cell_m(), rheology);
            self.brushes[brush].under = under;
        }
    }
}

/// Time at which the model moves the paint of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Timing {
    Now,
    /// When it is settled.
    Deferred,
}

impl Stroke<'_> {
    /// Time at which the model moves the paint of the stroke's steps.
    pub(super) fn timing(&mut self) -> Timing {
        let has_wells = self.has_wells();
        let Painting {
            backend, surfaces, ..
        } = &mut *self.painting;
        if backend.defers(&surfaces[self.surface], has_wells) {
            Timing::Deferred
        } else {
            Timing::Now
        }
    }

    /// Fullness of the brush, as far as its stroke may know.
    pub(super) fn seen_fullness(&mut self) -> f32 {
        let traits = self.traits();
        let Painting {
            backend, surfaces, ..
        } = &mut *self.painting;
        if !backend.defers(&surfaces[self.surface], false) {
            return self.brush().load.fullness(&traits);
        }
        if let Some(seen) = self.brush().deferral.fullness {
            return seen;
        }
        self.painting.settle();
        let own = self.brush_mut();
        let seen = own.load.fullness(&traits);
        own.deferral.fullness = Some(seen);
        seen
    }

    /// Settles earlier steps, unless this one is deferred with them.
    pub(super) fn settle_before(&mut self, timing: Timing) {
        let is_next = self.painting.backend.unsettled == Some(self.brush);
        if timing == Timing::Now || !is_next {
            self.painting.settle();
        }
    }

    /// Records the results of a step; the report of a deferred one covers all that were unsettled.
    pub(super) fn note(&mut self, report: &StepReport, timing: Timing) {
        let unsettled = match timing {
            Timing::Deferred => self.brush().deferral.unsettled(),
            Timing::Now => 0,
        };
        self.painting
            .note(self.brush, self.surface, report, 1 + unsettled);
    }

    /// Counts a deferred step; after many of them all are settled.
    pub(super) fn note_deferred(&mut self, timing: Timing) {
        if timing == Timing::Now {
            return;
        }
        self.painting.backend.unsettled = Some(self.brush);
        if self.brush_mut().deferral.count() {
            self.painting.settle();
        }
    }
}
