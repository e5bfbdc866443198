//! Versions: the workbench kept under a name, and made as it was.

use std::sync::Arc;

use maulstick_model::brush::load::BrushLoad;
use maulstick_types::paint::StepName;

use super::Workbench;
use crate::clock::Clock;
use crate::error::EditError;
use crate::history::{TilePlace, same};
use crate::painting::past::versions::Named;

impl Workbench {
    /// Brings the versions to all who follow the scene.
    fn versions_changed(&mut self) {
        self.desk.scene.versions = self.past.versions.entries();
        self.desk.scene.version += 1;
    }

    /// Keeps the painting as it is.
    ///
    /// # Errors
    /// [`EditError`] where there is a version of that name.
    pub(crate) fn keep(&mut self, name: &str) -> Result<(), EditError> {
        self.past.versions.check_new(name)?;
        self.end_step(|_| true);
        let named = Named {
            name: name.to_owned(),
            parent: self.past.versions.line.clone(),
            tiles: Arc::new(self.desk.surfaces.painted()),
            rest: self.non_tile_state(),
        };
        self.past.versions.add(named);
        self.versions_changed();
        Ok(())
    }

    /// Makes the painting as it was in a version: a step that can be undone.
    ///
    /// # Errors
    /// [`EditError`] for an unknown version.
    pub(crate) fn return_to(&mut self, clock: &mut Clock, name: &str) -> Result<(), EditError> {
        let to = self.past.versions.find(name)?.clone();
        clock.stop(None);
        let version = name.to_owned();
        self.begin_step(StepName::Return { version }, None);
        let before = self.non_tile_state();
        let now = self.desk.surfaces.painted();
        let nowhere = now.keys().filter(|place| !to.tiles.contains_key(place));
        let cleared: Vec<TilePlace> = nowhere.copied().collect();
        let kept = to.tiles.iter().map(|(place, held)| (*place, held.clone()));
        for (place, held) in kept.chain(cleared.into_iter().map(|place| (place, None))) {
            if !same(&self.desk.surfaces.tile(place), &held) {
                self.replace(place, held);
            }
        }
        // Its books know nothing of brushes that came later.
        for brush in self.brushes.iter_mut() {
            match to.rest.loads.get(&brush.name) {
                Some(page) => brush.carry(page, &mut self.desk.scene),
                None => {
                    brush.load = Arc::new(BrushLoad::clean(brush.head.strips()));
                    self.desk.scene.give_set(&brush.name, &[]);
                }
            }
        }
        for surface in self.desk.surfaces.iter_mut() {
            let top = to.rest.tops.get(&surface.id).copied().unwrap_or(0.0);
            surface.top = surface.top.max(top);
        }
        self.accounts.ledger.clone_from(&to.rest.ledger);
        self.book(None);
        let layers = (before.layers != to.rest.layers).then_some(&to.rest.layers);
        let materials = (before.materials != to.rest.materials).then_some(&to.rest.materials);
        self.desk.restore(layers, materials);
        self.end_own_step();
        self.past.versions.line = Some(name.to_owned());
        self.versions_changed();
        Ok(())
    }

    /// Begins a version from another one: the painting becomes as it was there.
    ///
    /// # Errors
    /// [`EditError`] where there is no such version, or one of the new name.
    pub(crate) fn branch(
        &mut self,
        clock: &mut Clock,
        from: &str,
        name: &str,
    ) -> Result<(), EditError> {
        self.past.versions.check_new(name)?;
        let begun = Named {
            name: name.to_owned(),
            parent: Some(from.to_owned()),
            ..self.past.versions.find(from)?.clone()
        };
        self.return_to(clock, from)?;
        self.past.versions.add(begun);
        self.versions_changed();
        Ok(())
    }

    /// Forgets a version; those painted from it count as painted from what it was painted from.
    ///
    /// # Errors
    /// [`EditError`] for an unknown version.
    pub(crate) fn forget(&mut self, name: &str) -> Result<(), EditError> {
        self.past.versions.remove(name)?;
        self.versions_changed();
        Ok(())
    }
}
