//! Drying, and edits of dry layers.

mod drying;
mod wetting;

use maulstick_canvas::EditError;
use maulstick_types::edits::{Dry, Form as _, LayerRef, NameLayer, Opacity};
use maulstick_types::paint::StepName;
use maulstick_types::scene::{Layer, Scene};

use super::Painting;
use super::surfaces::Changed;
use crate::apply::{Applied, Apply};

impl Apply for Dry {
    /// Dries the lower share of the wet paint of a surface, or of a part, into a new layer, at once or over a time.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        self.check_idle()?;
        if let Some(over) = self.over {
            return painting.dry_over(self, over);
        }
        painting.close_windows();
        let (on, part) = painting.surfaces.part(self.surface, self.region.as_ref())?;
        let number = next_layer(&painting.scene);
        let dried = painting.surfaces[on].dried(&part, number, self.share.get());
        if dried.is_empty() {
            return Err(EditError::NothingWet(self.region.clone()));
        }
        painting.clock.stop(Some(self.surface));
        painting.begin_step(StepName::Dry, None);
        painting.put_changed(on, dried);
        let name = self.layer.as_deref().unwrap_or_default();
        let layer = painting.add_layer(number, name);
        painting.end_own_step();
        Ok(Applied::Dried(layer))
    }
}

impl Apply for Opacity {
    /// Makes a dry layer more or less opaque: a factor on its optical thickness, never on its height.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let place = place_of(&painting.scene, &self.layer)?;
        painting.begin_step(StepName::LayerOpacity, None);
        painting.scene.layers[place].opacity = self.opacity.get();
        painting.layers_changed();
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

impl Apply for NameLayer {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let number = self.layer;
        let place = place_of(&painting.scene, &LayerRef::Number { number })?;
        painting.begin_step(StepName::LayerName, None);
        self.name
            .trim()
            .clone_into(&mut painting.scene.layers[place].name);
        painting.scene.version += 1;
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

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
    fn add_layer(&mut self, number: u32, name: &str) -> Layer {
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
fn next_layer(scene: &Scene) -> u32 {
    1 + scene.layers.last().map_or(0, |layer| layer.number)
}

/// Place of a dry layer in a scene.
fn place_of(scene: &Scene, which: &LayerRef) -> Result<usize, EditError> {
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
