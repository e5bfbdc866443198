//! One step of the paint model.

use std::sync::Arc;

use maulstick_canvas::relief::ride;
use maulstick_model::brush::head::low_bounds;
use maulstick_model::brush::scale::Scale;
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::interface::{Step, Sweep};

use crate::history::OpenStep;
use crate::painting::Painting;
use crate::painting::brushes::handling::handling_of;
use crate::painting::optics::thinner_slot;
use crate::painting::surfaces::preparation::Preparation;

impl Painting {
    /// One step of a brush on a surface, doubled so many times.
    pub(super) fn step(
        &mut self,
        (brush, on): (usize, usize),
        scale: Scale,
        (sweep, doublings): (Sweep<'_>, u32),
    ) {
        self.accounts.steps += 1;
        let own = &self.brushes[brush];
        let traits = BrushTraits::of(&own.thinned, scale.cell_m, scale.zoom).doubled(doublings);
        let surface = &self.surfaces[on];
        let has_wells = !self.scene.surfaces[on].wells.is_empty();
        let deferred = self.backend.defers(surface, has_wells);
        let height = if deferred {
            // The height of the paint is not known here.
            f32::INFINITY
        } else {
            let [wet, tooth] = surface.heights();
            let film = own.load.thickest() as f32 * traits.film_cells_per_quantum;
            wet + film + traits.sink + tooth
        };
        let Some((from, to)) = low_bounds(&own.head, sweep.to, &traits, height) else {
            return;
        };
        if self.history.open_of(Some(&own.name)).is_none() {
            // A command ended the stroke's undo step: the rest of the stroke is one of its own.
            self.begin_stroke_step(brush);
        }
        // Paint is pushed a cell farther than the brush comes.
        self.claim(
            (brush, on),
            from.map(|cell| cell - 1),
            to.map(|cell| cell + 1),
        );
        let ride = ride::reach(scale.cell_m) as i64;
        let (ride_from, ride_to) = (from.map(|cell| cell - ride), to.map(|cell| cell + ride));
        if !self.reach((brush, on), ride_from, ride_to) {
            return;
        }
        if !deferred || self.backend.unsettled != Some(brush) {
            self.settle();
        }
        if has_wells {
            self.tend_wells((brush, on), (from, to), (sweep.to, &traits));
        }
        let own = &mut self.brushes[brush];
        let Some((_, window)) = &mut own.window else {
            return;
        };
        let handling = handling_of(&self.scene, &own.name, self.scene.surfaces[on].id);
        let preparation = Preparation::of(&self.scene.surfaces[on]);
        let surface = &mut self.surfaces[on];
        // Below this the head may touch.
        window.note_top(surface.top);
        let mut step = Step {
            window,
            head: &own.head,
            sweep,
            bounds: (from, to),
            load: Arc::make_mut(&mut own.load),
            traits: preparation.traits(traits, handling.transfer),
            handling,
            stain: preparation.stain,
            lasting: preparation.lasting,
            thinner: thinner_slot(&self.scene),
        };
        let model = self.backend.models.of(surface.model);
        let report = match deferred {
            true => model.step(&mut step),
            false => model.step_now(&mut step),
        };
        surface.top = surface.top.max(window.top());
        // The report of deferred steps covers all that were not settled.
        let unsettled = match deferred {
            true => own.deferral.unsettled_steps(),
            false => 0,
        };
        self.note((brush, on), &report, 1 + unsettled);
        if has_wells {
            let (from, to) = (from.map(|cell| cell - 1), to.map(|cell| cell + 1));
            self.empty_jars((brush, on), (from, to));
        }
        if deferred {
            self.defer(brush);
        }
    }

    /// Notes which tiles a brush's step reaches, and ends the open steps of other brushes that have
    /// reached one of them: no two steps change a tile at the same time.
    pub(super) fn claim(&mut self, (brush, on): (usize, usize), from: [i64; 2], to: [i64; 2]) {
        let surface = self.surfaces[on].id;
        let Some(rect) = self.surfaces[on].store.around(from, to) else {
            return;
        };
        let name = &self.brushes[brush].name;
        let Some(open) = self.history.open_of(Some(name)) else {
            return;
        };
        if open.last_reach == Some((surface, rect)) {
            return;
        }
        open.last_reach = Some((surface, rect));
        open.reached.extend(rect.tiles().map(|id| (surface, id)));
        let own = open.id;
        let shares = |step: &OpenStep| {
            let mut tiles = rect.tiles();
            step.id != own && tiles.any(|id| step.reached.contains(&(surface, id)))
        };
        if self.history.open().any(shares) {
            self.end_step(shares);
        }
    }
}
