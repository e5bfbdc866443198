//! Rewetting of dry layers.

use std::collections::BTreeSet;

use crate::painting::Painting;

impl Painting {
    /// Removes those of `numbers` from the scene that are empty on every surface.
    pub(crate) fn drop_empty_layers(&mut self, numbers: &BTreeSet<u32>) {
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
