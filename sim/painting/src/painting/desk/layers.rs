//! Dry layers of the scene.

use maulstick_types::scene::Layer;

use super::Desk;

impl Desk {
    /// Number of the next layer.
    pub(crate) fn next_layer(&self) -> u32 {
        1 + self.scene.layers.last().map_or(0, |layer| layer.number)
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

    /// Brings the layers to the look and to all who follow the scene.
    pub(crate) fn layers_changed(&mut self) {
        self.optics.set_layers(&self.scene);
        self.scene.version += 1;
    }
}
