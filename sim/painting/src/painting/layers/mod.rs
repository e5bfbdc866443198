//! Drying, and edits of dry layers.

mod drying;

use maulstick_types::scene::{Layer, Scene};

use super::Painting;
use super::surfaces::Changed;

impl Painting {
    /// Dries the lower `share` of the wet paint of a surface, within the open step, and returns its layer;
    /// `None` where nothing is wet.
    pub(crate) fn dry_in_step(&mut self, on: usize, share: f32, name: &str) -> Option<String> {
        let number = next_layer(&self.scene);
        let surface = &self.surfaces[on];
        let dried = surface.dried(&surface.part(None).ok()?, number, share);
        if dried.is_empty() {
            return None;
        }
        self.clock.stop(Some(surface.id));
        self.put_changed(on, dried);
        Some(self.add_layer(number, name).name)
    }

    /// Replaces tiles of a surface, within the open step.
    pub(crate) fn put_changed(&mut self, on: usize, tiles: Changed) {
        let surface = self.surfaces[on].id;
        for (id, tile) in tiles {
            let tile = (!tile.is_bare()).then_some(tile);
            self.replace((surface, id), tile);
        }
    }

    /// Adds a layer; without a name it is called by its number.
    pub(crate) fn add_layer(&mut self, number: u32, name: &str) -> Layer {
        let name = if name.is_empty() {
            Layer::default_name(number)
        } else {
            name.to_owned()
        };
        let layer = Layer {
            number,
            name,
            opacity: 1.0,
        };
        self.scene.layers.push(layer.clone());
        self.layers_changed();
        layer
    }

    /// Updates the appearance, and publishes the scene.
    pub(crate) fn layers_changed(&mut self) {
        self.optics.set_layers(&self.scene);
        self.scene.version += 1;
    }
}

/// Number of the next layer.
pub(crate) fn next_layer(scene: &Scene) -> u32 {
    1 + scene.layers.last().map_or(0, |layer| layer.number)
}
