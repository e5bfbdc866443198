//! Rewetting of dry layers.

use std::collections::BTreeSet;
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_types::edits::Wet;
use maulstick_types::paint::StepName;

use crate::apply::{Applied, Apply};
use crate::painting::Painting;
use crate::painting::surfaces::Changed;

impl Apply for Wet {
    /// Rewets the newest dry layers of a part in place.
    ///
    /// A cell takes no more than it can hold: paint without room, and all under it there, stays dry. A layer that is
    /// empty afterwards is removed from the scene. A layer whose opacity is not 1 is refused, for wet paint has no
    /// opacity.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let (on, part) = painting.surfaces.part(self.surface, self.region.as_ref())?;
        painting.close_windows();
        let surface = &painting.surfaces[on];
        let numbers = surface.newest_on(&part, self.layers);
        let Some(least) = numbers.first().copied() else {
            return Err(EditError::NothingDry(self.region.clone()));
        };
        let known = painting.scene.layers.iter();
        let chosen = known.filter(|layer| numbers.contains(&layer.number));
        if let Some(veiled) = chosen.clone().find(|layer| layer.opacity != 1.0) {
            return Err(EditError::Veiled {
                number: veiled.number,
                name: veiled.name.clone(),
            });
        }
        let layers: Vec<String> = chosen.rev().map(|layer| layer.name.clone()).collect();
        let mut full_cells = 0;
        let mut tiles = Changed::new();
        for (id, tile, within) in surface.dried_tiles(&part) {
            if let Some(rewet) = tile.rewet(least, &within) {
                full_cells += rewet.full_cells;
                tiles.push((id, Arc::new(rewet.tile)));
            }
        }
        if tiles.is_empty() {
            return Err(EditError::NoRoom(self.region.clone()));
        }
        painting.clock.stop(Some(self.surface));
        painting.begin_step(StepName::Wet, None);
        painting.put_changed(on, tiles);
        painting.drop_empty_layers(&numbers);
        painting.end_own_step();
        Ok(Applied::Rewet { layers, full_cells })
    }
}

impl Painting {
    /// Removes those of `numbers` from the scene that are empty on every surface.
    fn drop_empty_layers(&mut self, numbers: &BTreeSet<u32>) {
        let mut gone = numbers.clone();
        for (_, version) in self.surfaces.iter().flat_map(|own| own.store.iter()) {
            let stack = version.tile.as_ref().and_then(|tile| tile.dry());
            let layers = stack.into_iter().flat_map(|stack| stack.layers());
            layers.for_each(|layer| {
                gone.remove(&layer.number);
            });
        }
        if !gone.is_empty() {
            self.scene
                .layers
                .retain(|layer| !gone.contains(&layer.number));
            self.layers_changed();
        }
    }
}
