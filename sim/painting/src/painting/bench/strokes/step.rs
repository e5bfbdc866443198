//! One step of the paint model.

use std::sync::Arc;

use maulstick_canvas::relief::ride;
use maulstick_model::brush::head::low_bounds;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Step, StepReport, Sweep};

use super::cells::Cells;
use super::stroke::Stroke;
use super::timing::Timing;
use crate::painting::bench::Workbench;
use crate::painting::brushes::handling::handling_of;
use crate::painting::desk::preparation::Preparation;
use crate::painting::optics::thinner_slot;

impl Stroke<'_> {
    /// One step of the brush along its path, with a number of doublings.
    pub(super) fn step(&mut self, sweep: Sweep<'_>, doublings: u32) {
        self.bench.accounts.work.steps += 1;
        let traits = self.traits().doubled(doublings);
        let cell_m = self.scale.cell_m * self.scale.zoom;
        self.brush_mut().way_m[0] += f64::from(traits.step_cells) * cell_m;
        let timing = self.timing();
        let height = self.paint_height(&traits, timing);
        let bounds = low_bounds(&self.brush().head, sweep.to, &traits, height);
        let Some((from, to)) = bounds else {
            return;
        };
        let cells = Cells { from, to };
        self.resume_undo_step();
        // Paint is pushed a cell farther than the brush comes.
        self.claim(cells.grown(1));
        let ride = ride::reach(self.scale.cell_m) as i64;
        if !self.open_window(cells.grown(ride)) {
            return;
        }
        self.settle_before(timing);
        self.refill_wells(cells, sweep.to, &traits);
        let Some(report) = self.move_paint(sweep, traits, cells, timing) else {
            return;
        };
        self.note(&report, timing);
        self.empty_jars(cells.grown(1));
        self.note_deferred(timing);
    }

    /// Height of the highest paint, on the surface and the brush, cells; unknown for deferred steps.
    fn paint_height(&self, traits: &BrushTraits, timing: Timing) -> f32 {
        if timing == Timing::Deferred {
            return f32::INFINITY;
        }
        let [wet, tooth] = self.surface().heights();
        let film = self.brush().load.thickest() as f32 * traits.film_cells_per_quantum;
        wet + film + traits.sink + tooth
    }

    /// Makes the model move the paint under the head.
    fn move_paint(
        &mut self,
        sweep: Sweep<'_>,
        traits: BrushTraits,
        cells: Cells,
        timing: Timing,
    ) -> Option<StepReport> {
        let Workbench {
            desk,
            brushes,
            backend,
            ..
        } = &mut *self.bench;
        let (brush, surface) = (&mut brushes[self.brush], &mut desk.surfaces[self.surface]);
        let (_, window) = brush.window.as_mut()?;
        let handling = handling_of(&desk.scene, &brush.name, surface.id);
        let preparation = Preparation::of(&desk.scene.surfaces[self.surface]);
        // Below this the head may touch.
        window.note_top(surface.top);
        let mut step = Step {
            window,
            head: &brush.head,
            sweep,
            bounds: (cells.from, cells.to),
            load: Arc::make_mut(&mut brush.load),
            traits: preparation
                .traits(traits, handling.transfer)
                .pressed(sweep.to.press),
            handling,
            stain: preparation.stain,
            lasting: preparation.lasting,
            thinner: thinner_slot(&desk.scene),
        };
        let model = backend.models.of(surface.model);
        let report = match timing {
            Timing::Deferred => model.step(&mut step),
            Timing::Now => model.step_now(&mut step),
        };
        surface.top = surface.top.max(window.top());
        Some(report)
    }
}
