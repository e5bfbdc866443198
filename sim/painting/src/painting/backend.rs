//! The paint model and its backend. Deferred steps reach planes and load once they are settled: before anything else
//! looks at them.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{PaintModel, StepReport};

use super::Painting;
use super::brush_modes::UnderBrush;

/// Largest number of deferred steps. The fullness of the brush is read just when they are settled: the time at which a
/// caller looks at the painting must not matter.
const SETTLE_EVERY: u32 = 256;

/// Progress of the deferred steps of a brush.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Deferral {
    /// Deferred steps since its stroke began.
    steps: u32,
    /// Those of them that are not settled.
    unsettled: u32,
    /// Fullness of the brush when it was last read.
    fullness: Option<f32>,
}

impl Deferral {
    /// Deferred steps that are not settled.
    pub(super) fn unsettled_steps(&self) -> u32 {
        self.unsettled
    }
}

/// The reason why the model changed its backend. It is reported where a stroke ends.
#[derive(Debug, Default)]
pub(super) struct BackendFallback {
    found: Option<String>,
    due: bool,
}

impl BackendFallback {
    /// A stroke ends or begins.
    pub(super) fn stroke_ends(&mut self) {
        self.due |= self.found.is_some();
    }
}

impl Painting {
    /// Has the steps of surfaces with a model of this name computed by this one from now on.
    pub fn set_model(&mut self, model: Box<dyn PaintModel>) {
        self.close_windows();
        self.models.replace(model);
    }

    /// Name of a surface's paint model.
    #[must_use]
    pub fn model(&self, surface: u32) -> Option<&'static str> {
        self.sheet(surface).map(|sheet| sheet.model.name)
    }

    /// Backend of the steps on its canvas: `cpu`, or `gpu` and the adapter's name.
    #[must_use]
    pub fn backend(&self) -> String {
        self.models.backend(self.sheets[0].model)
    }

    /// The reason why its backend changed, returned once, after the stroke in which it changed.
    pub fn take_fall(&mut self) -> Option<String> {
        if !self.fall.due {
            return None;
        }
        self.fall.due = false;
        self.fall.found.take()
    }

    /// Fullness of a brush, as far as its stroke on a surface may know.
    pub(super) fn seen_fullness(
        &mut self,
        name: &str,
        sheet: usize,
        traits: &BrushTraits,
    ) -> Result<f32, EditError> {
        let defers = self.models.of(self.sheets[sheet].model).defers();
        let track = self.brush(name)?;
        if !defers {
            return Ok(track.load.fullness(traits));
        }
        if let Some(seen) = track.deferral.fullness {
            return Ok(seen);
        }
        self.settle();
        let track = self.brush(name)?;
        let seen = track.load.fullness(traits);
        track.deferral.fullness = Some(seen);
        Ok(seen)
    }

    /// Notes a deferred step.
    pub(super) fn defer(&mut self, name: &str) {
        self.unsettled = Some(name.to_owned());
        let Some(track) = self.brushes.get_mut(name) else {
            return;
        };
        track.deferral.steps += 1;
        track.deferral.unsettled += 1;
        if track.deferral.steps.is_multiple_of(SETTLE_EVERY) {
            track.deferral.fullness = None;
            self.settle();
        }
    }

    /// Has the model write back what it holds.
    pub(super) fn settle(&mut self) {
        if let Some(name) = self.unsettled.take()
            && let Some(track) = self.brushes.get_mut(&name)
            && let Some((sheet, window)) = &mut track.window
        {
            let place = *sheet;
            let sheet = &mut self.sheets[place];
            let model = self.models.of(sheet.model);
            let report = model.settle(window, Arc::make_mut(&mut track.load));
            let steps = std::mem::take(&mut track.deferral.unsettled);
            sheet.top = sheet.top.max(window.top());
            self.note((&name, place), &report, steps);
            self.book(Some(&name));
        }
        if let Some(what) = self.models.take_fall() {
            self.fall.found = Some(what);
        }
    }

    /// Notes what so many steps of a brush did on a surface; of deferred ones that is known when they are settled.
    pub(super) fn note(&mut self, (name, sheet): (&str, usize), report: &StepReport, steps: u32) {
        self.footprint_cells += report.footprint_cells;
        self.ledger.from_mode(&report.from_nowhere);
        self.ledger.to_cleaner(&report.lifted);
        let defers = self.models.of(self.sheets[sheet].model).defers();
        let is_known = !defers || report.footprint_cells > 0;
        if let Some(track) = self.brushes.get_mut(name).filter(|_| is_known) {
            let mean = |sum: u64| sum / u64::from(steps.max(1));
            let of_one = StepReport {
                footprint_cells: mean(report.footprint_cells),
                wet: mean(report.wet),
                thinner: mean(report.thinner),
                ..*report
            };
            track.under = UnderBrush::of(&of_one, self.sheets[0].cell_m);
        }
    }

    /// True if a surface has wells: those are tended on the CPU, step by step.
    pub(super) fn has_wells(&self, sheet: usize) -> bool {
        let id = self.sheets[sheet].id;
        let mut surfaces = self.scene.surfaces.iter();
        surfaces.any(|surface| surface.id == id && !surface.wells.is_empty())
    }
}
