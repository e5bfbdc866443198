//! Drying, and edits of dry layers.

mod drying;
mod wetting;

use crate::edits::LayerRef;
use maulstick_canvas::EditError;
use maulstick_types::scene::{Layer, Scene};

use super::Painting;
use super::surfaces::Changed;

impl Painting {
    /// Dries the lower `share` of the wet paint of a surface, within the step that is open, and says which layer it is;
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

    /// Puts tiles of a surface in their places, within the step that is open.
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

    /// Tells the look and all who follow the scene.
    pub(crate) fn layers_changed(&mut self) {
        self.optics.set_layers(&self.scene);
        self.scene.version += 1;
    }
}

/// Number of the next layer.
pub(crate) fn next_layer(scene: &Scene) -> u32 {
    1 + scene.layers.last().map_or(0, |layer| layer.number)
}

/// Place of a dry layer in a scene.
pub(crate) fn place_of(scene: &Scene, which: &LayerRef) -> Result<usize, EditError> {
    let layers = &scene.layers;
    let numbered = |number: u32| layers.iter().position(|layer| layer.number == number);
    let found = match which {
        LayerRef::Number { number } => numbered(*number),
        LayerRef::Named { name } => layers
            .iter()
            .rposition(|layer| layer.name == name.as_str())
            .or_else(|| numbered(name.parse().ok()?)),
    };
    found.ok_or_else(|| EditError::NoLayer {
        which: which.to_string(),
        known: layers
            .iter()
            .map(|layer| (layer.number, layer.name.clone()))
            .collect(),
    })
}
