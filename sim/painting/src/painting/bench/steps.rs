//! Steps of the history: their beginning, end and bookings.

use std::sync::Arc;

use maulstick_model::interface::Transfer;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;

use super::Workbench;
use crate::history::{Change, NonTileState, OpenStep, Step, StepEffects, materials, placed};
use crate::painting::brushes::handling::handling_of;

impl Workbench {
    /// State besides the tiles.
    pub(crate) fn non_tile_state(&mut self) -> NonTileState {
        NonTileState {
            loads: self.brushes.load_pages(&self.desk.surfaces.pager),
            ledger: self.accounts.ledger.clone(),
            layers: self.desk.scene.layers.clone(),
            materials: materials(&self.desk.scene),
            tops: self.desk.surfaces.tops(),
        }
    }

    /// Begins a step of a brush, or without a brush, which then ends the steps of all.
    pub(crate) fn begin_step(&mut self, what: StepName, brush: Option<usize>) {
        self.book(brush);
        let own = self.brushes.name(brush).map(str::to_owned);
        // An open step without a brush is a drying's, and is split by the new one.
        self.end_step(|step| own.is_none() || step.brush.is_none() || step.brush == own);
        let before = self.non_tile_state();
        self.past.history.begin(what, own.as_deref(), before);
    }

    /// Begins a step that is a stroke of a brush.
    pub(crate) fn begin_stroke_step(&mut self, brush: usize) {
        let own = &self.brushes[brush];
        let (kind, on_palette) = (own.file.kind.clone(), false);
        let what = match handling_of(&self.desk.scene, &own.name, CANVAS).transfer {
            Transfer::Vacuum => StepName::Wipe { kind, on_palette },
            _ => StepName::Stroke { kind, on_palette },
        };
        self.begin_step(what, Some(brush));
    }

    /// Ends the open steps of which `which` says so.
    pub(crate) fn end_step(&mut self, which: impl Fn(&OpenStep) -> bool) {
        self.close_windows();
        let after = self.non_tile_state();
        let ended = self.past.history.take_open(which);
        let ends = !ended.is_empty();
        for open in ended {
            let step = self.finished(&open, &after);
            self.past.history.push(step);
        }
        if ends {
            self.past.keep_to_quota(&self.desk.surfaces);
        }
    }

    /// Ends the open step that belongs to no brush.
    pub(crate) fn end_own_step(&mut self) {
        self.end_step(|step| step.brush.is_none());
    }

    /// Books and ends the open step of a brush.
    pub(crate) fn end_step_of(&mut self, brush: usize) {
        self.book(Some(brush));
        let own = self.brushes[brush].name.clone();
        self.end_step(|step| step.brush.as_ref() == Some(&own));
    }

    /// Assigns the bookings since the last call to the step of a brush, or of none.
    pub(crate) fn book(&mut self, brush: Option<usize>) {
        let booked = self.accounts.take_booked();
        if let Some(open) = self.past.history.open_of(self.brushes.name(brush)) {
            open.booked.add(&booked);
        }
    }

    /// A step as it is if it ends now. A brush's step leaves what other brushes carry alone.
    fn finished(&self, open: &OpenStep, after: &NonTileState) -> Step {
        let tiles = open.tiles.iter().map(|(place, before)| {
            let change = Change {
                before: before.clone(),
                after: self.desk.surfaces.tile(*place),
            };
            (*place, change)
        });
        let mut effects = StepEffects::between(&open.before, after, open.booked.clone());
        if let Some(brush) = &open.brush {
            effects.loads.retain(|name, _| name == brush);
            (effects.layers, effects.materials) = (None, None);
        }
        Step {
            id: open.id,
            what: match open.brush {
                Some(_) => placed(&open.what, open.tiles.keys()),
                None => open.what.clone(),
            },
            brush: open.brush.clone(),
            operations: 1,
            done: true,
            tiles: Arc::new(tiles.collect()),
            effects: Arc::new(effects),
        }
    }

    /// The unfinished steps, as if they ended now.
    pub(crate) fn open_steps(&mut self) -> Vec<Step> {
        let after = self.non_tile_state();
        let open = self.past.history.open();
        open.map(|open| self.finished(open, &after)).collect()
    }
}
