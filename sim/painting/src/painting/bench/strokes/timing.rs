//! Time at which the paint of a stroke's steps moves.

use maulstick_model::interface::StepReport;

use super::stroke::Stroke;
use crate::painting::bench::Workbench;

/// Time at which the model moves the paint of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Timing {
    /// In the step.
    Now,
    /// When it is settled.
    Deferred,
}

impl Stroke<'_> {
    /// Time at which the model moves the paint of the stroke's steps.
    pub(super) fn timing(&mut self) -> Timing {
        let has_wells = self.has_wells();
        let Workbench { backend, desk, .. } = &mut *self.bench;
        if backend.defers(&desk.surfaces[self.surface], has_wells) {
            Timing::Deferred
        } else {
            Timing::Now
        }
    }

    /// Fullness of the brush, as far as its stroke may know.
    pub(super) fn seen_fullness(&mut self) -> f32 {
        let traits = self.traits();
        let Workbench { backend, desk, .. } = &mut *self.bench;
        if !backend.defers(&desk.surfaces[self.surface], false) {
            return self.brush().load.fullness(&traits);
        }
        if let Some(seen) = self.brush().deferral.fullness {
            return seen;
        }
        self.bench.settle();
        let own = self.brush_mut();
        let seen = own.load.fullness(&traits);
        own.deferral.fullness = Some(seen);
        seen
    }

    /// Settles earlier steps, unless this one is deferred with them.
    pub(super) fn settle_before(&mut self, timing: Timing) {
        let is_next = self.bench.backend.unsettled == Some(self.brush);
        if timing == Timing::Now || !is_next {
            self.bench.settle();
        }
    }

    /// Notes what a step did; the report of a deferred one covers all that were not settled.
    pub(super) fn note(&mut self, report: &StepReport, timing: Timing) {
        let unsettled = match timing {
            Timing::Deferred => self.brush().deferral.unsettled(),
            Timing::Now => 0,
        };
        self.bench
            .note(self.brush, self.surface, report, 1 + unsettled);
    }

    /// Counts a deferred step; after many of them all are settled.
    pub(super) fn note_deferred(&mut self, timing: Timing) {
        if timing == Timing::Now {
            return;
        }
        self.bench.backend.unsettled = Some(self.brush);
        if self.brush_mut().deferral.count() {
            self.bench.settle();
        }
    }
}
