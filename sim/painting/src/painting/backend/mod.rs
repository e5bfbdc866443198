//! The paint models and their backends. Deferred steps reach planes and load once they are settled: before anything
//! else looks at them.

pub(crate) mod deferral;
mod models;

use maulstick_types::paint::Decision;

use models::Models;

use super::surfaces::SurfaceState;

/// A fact of a model's backend. It is reported where a stroke ends.
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

/// The paint models at work, and what they have not written back.
#[derive(Default)]
pub(crate) struct Backend {
    pub(crate) models: Models,
    /// Index of the brush whose newest steps the model has not settled.
    pub(super) unsettled: Option<usize>,
    /// Why a model changed its backend.
    fall: BackendFact<String>,
    /// A limit that a model's backend has met.
    limit: BackendFact<Decision>,
}

impl Backend {
    /// True if steps on a surface are deferred. Those on one with wells never are: wells are refilled on the CPU, step by
    /// step.
    pub(super) fn defers(&mut self, surface: &SurfaceState, has_wells: bool) -> bool {
        self.models.of(surface.model).defers() && !has_wells
    }

    /// Asks the models for what their backends have met.
    pub(super) fn find_facts(&mut self) {
        self.fall.find(self.models.take_backend_change());
        self.limit.find(self.models.take_limit());
    }

    /// A stroke ends or begins.
    pub(super) fn stroke_ends(&mut self) {
        self.fall.stroke_ends();
        self.limit.stroke_ends();
    }

    /// Why a model changed its backend, returned once, after the stroke in which it did.
    pub(super) fn take_backend_change(&mut self) -> Option<String> {
        self.fall.take()
    }

    /// A limit that a model's backend has met, returned once, after the stroke in which it did.
    pub(super) fn take_limit(&mut self) -> Option<Decision> {
        self.limit.take()
    }
}
