//! Drying, and what becomes of dry layers.

use std::sync::Arc;

use maulstick_types::scene::Layer;

use super::{PaintRefusal, Painting, Sheet};
use crate::tile::{Tile, TileId};

impl Painting {
    /// Dries the lower `share` of all wet paint of a surface into a new layer called `name`, and says
    /// which.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown surface, or where nothing is wet.
    pub fn dry(&mut self, surface: u32, share: f32, name: &str) -> Result<String, PaintRefusal> {
        self.close_windows();
        let dried = self.drying(surface, share)?;
        self.begin_step("dry", None);
        let name = self.dried(surface, dried, name);
        self.end_own_step();
        Ok(name)
    }

    /// As [`dry`](Self::dry), within the step that is open.
    pub(super) fn dry_in_step(
        &mut self,
        surface: u32,
        share: f32,
        name: &str,
    ) -> Result<String, PaintRefusal> {
        let dried = self.drying(surface, share)?;
        Ok(self.dried(surface, dried, name))
    }

    fn next_layer(&self) -> u32 {
        1 + self.scene.layers.last().map_or(0, |layer| layer.number)
    }

    /// The tiles of a surface after the lower `share` of their wet paint has dried into the next layer.
    fn drying(&self, surface: u32, share: f32) -> Result<Vec<(TileId, Arc<Tile>)>, PaintRefusal> {
        let number = self.next_layer();
        let unknown = || {
            let what = format!("there is no surface {surface}");
            PaintRefusal::new(what, "the canvas is 0, the palette 1")
        };
        let place = self
            .sheets
            .iter()
            .position(|sheet| sheet.id == surface)
            .ok_or_else(unknown)?;
        let Sheet { store, bare, .. } = &self.sheets[place];
        let dried = store.iter().filter_map(|(id, version)| {
            // What lies in a well is as fresh as what comes from the tube.
            let wells: Vec<usize> = bare.in_wells(id).map(|(cell, _)| cell).collect();
            let tile = version.tile.as_ref()?.dried(number, share, &wells)?;
            Some((id, Arc::new(tile)))
        });
        let dried: Vec<(TileId, Arc<Tile>)> = dried.collect();
        match dried.is_empty() {
            true => Err(PaintRefusal::new(
                "nothing is wet".to_owned(),
                "paint something first",
            )),
            false => Ok(dried),
        }
    }

    /// Puts dried tiles in their places and says how the layer is called.
    fn dried(&mut self, surface: u32, dried: Vec<(TileId, Arc<Tile>)>, name: &str) -> String {
        let number = self.next_layer();
        for (id, tile) in dried {
            let before = self.put((surface, id), Some(tile));
            self.history.replaced(None, (surface, id), before);
        }
        let name = if name.is_empty() {
            format!("layer {number}")
        } else {
            name.to_owned()
        };
        let layer = Layer {
            number,
            name: name.clone(),
            opacity: 1.0,
        };
        self.scene.layers.push(layer);
        self.scene.version += 1;
        self.note_look();
        name
    }

    /// Makes a dry layer more or less opaque: a factor on its optical thickness, never on its height.
    ///
    /// # Errors
    /// [`PaintRefusal`] for an unknown layer.
    pub fn set_opacity(&mut self, layer: u32, opacity: f32) -> Result<(), PaintRefusal> {
        let layers = &self.scene.layers;
        let Some(place) = layers.iter().position(|other| other.number == layer) else {
            let known: Vec<String> = layers
                .iter()
                .map(|layer| format!("{} ({})", layer.number, layer.name))
                .collect();
            let help = match known.is_empty() {
                true => "nothing has dried yet: `maulstick dry` makes a layer".to_owned(),
                false => format!("there are {}", known.join(", ")),
            };
            return Err(PaintRefusal::new(
                format!("there is no dry layer {layer}"),
                &help,
            ));
        };
        self.begin_step("opacity", None);
        self.scene.layers[place].opacity = opacity;
        self.layers_changed();
        self.end_own_step();
        Ok(())
    }

    /// Tells the look and all who follow the scene.
    pub(super) fn layers_changed(&mut self) {
        let mut look = (*self.look).clone();
        look.set_layers(&self.scene.layers);
        self.look = Arc::new(look);
        self.scene.version += 1;
        self.note_look();
    }
}
