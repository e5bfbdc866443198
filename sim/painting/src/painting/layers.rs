//! Drying, and edits of dry layers.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::Region;
use maulstick_types::edits::{Dry, Form as _, LayerRef, NameLayer, Opacity};
use maulstick_types::paint::TILE;
use maulstick_types::scene::Layer;

use super::Painting;
use crate::apply::{Applied, Apply};

/// A part of a surface.
pub(super) struct Part {
    /// Index of its surface.
    pub(super) sheet: usize,
    /// Its cells: the first column and row, and one past the last.
    cells: [[u32; 2]; 2],
}

/// Tiles after some of their paint dried, or became wet.
pub(super) type Changed = Vec<(TileId, Arc<Tile>)>;

impl Apply for Dry {
    /// Dries the lower share of the wet paint of a surface, or of a part, into a new layer, at once or over a time.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        self.check_idle()?;
        if let Some(over) = self.over {
            return painting.dry_over(self, over);
        }
        painting.close_windows();
        let part = painting.part(self.surface, self.region.as_ref())?;
        let dried = painting.drying(&part, self.share.get());
        if dried.is_empty() {
            return Err(EditError::NothingWet(self.region.clone()));
        }
        painting.let_stay_wet(Some(self.surface));
        painting.begin_step("dry", None);
        let name = self.layer.as_deref().unwrap_or_default();
        let name = painting.dried(self.surface, dried, name);
        painting.end_own_step();
        Ok(Applied::Dried(name))
    }
}

impl Apply for Opacity {
    /// Makes a dry layer more or less opaque: a factor on its optical thickness, never on its height.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let place = painting.place_of(&self.layer)?;
        painting.begin_step("opacity", None);
        painting.scene.layers[place].opacity = self.opacity.get();
        painting.layers_changed();
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

impl Apply for NameLayer {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let number = self.layer;
        let place = painting.place_of(&LayerRef::Number { number })?;
        painting.begin_step("name", None);
        self.name
            .trim()
            .clone_into(&mut painting.scene.layers[place].name);
        painting.scene.version += 1;
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

impl Painting {
    /// Dries the lower `share` of the wet paint of a surface, within the step that is open, and says which layer it is.
    pub(super) fn dry_in_step(
        &mut self,
        surface: u32,
        share: f32,
        name: &str,
    ) -> Result<String, EditError> {
        let part = self.part(surface, None)?;
        let dried = self.drying(&part, share);
        if dried.is_empty() {
            return Err(EditError::NothingWet(None));
        }
        self.let_stay_wet(Some(surface));
        Ok(self.dried(surface, dried, name))
    }

    pub(super) fn next_layer(&self) -> u32 {
        1 + self.scene.layers.last().map_or(0, |layer| layer.number)
    }

    /// A part of a surface, or all of it.
    pub(super) fn part(&self, surface: u32, region: Option<&Region>) -> Result<Part, EditError> {
        self.surface(surface)?;
        let found = self.sheets.iter().position(|sheet| sheet.id == surface);
        let sheet = found.unwrap_or_default();
        let (cells, cell_m) = (self.sheets[sheet].store.cells(), self.sheets[sheet].cell_m);
        let Some(region) = region else {
            let cells = [[0, 0], cells];
            return Ok(Part { sheet, cells });
        };
        region.check()?;
        let within = region.cells(cells, cell_m);
        let within = within.ok_or_else(|| EditError::NoCell {
            region: region.clone(),
            surface_mm: cells.map(|cells| f64::from(cells) * cell_m * 1e3),
        })?;
        Ok(Part {
            sheet,
            cells: within,
        })
    }

    /// The cells of a tile outside a part or in a well, whose paint is always fresh from the tube; `None` if the whole
    /// tile is outside.
    pub(super) fn staying(&self, part: &Part, id: TileId) -> Option<Vec<usize>> {
        let side = TILE as u32;
        let [from, to] = part.cells;
        let corner = [id.x * side, id.y * side];
        if (0..2).any(|i| corner[i] + side <= from[i] || to[i] <= corner[i]) {
            return None;
        }
        let sheet = &self.sheets[part.sheet];
        let mut stays: Vec<usize> = sheet.bare.in_wells(id).map(|(cell, _)| cell).collect();
        let cells = sheet.store.cells();
        // Nothing lies beyond the surface's edge.
        let holds = |i: usize| from[i] <= corner[i] && (corner[i] + side).min(cells[i]) <= to[i];
        if !(holds(0) && holds(1)) {
            let within = |i: usize, at: u32| (from[i]..to[i]).contains(&(corner[i] + at));
            let beside = |cell: &usize| {
                let at = [(cell % TILE) as u32, (cell / TILE) as u32];
                !(within(0, at[0]) && within(1, at[1]))
            };
            stays.extend((0..TILE_CELLS).filter(beside));
        }
        Some(stays)
    }

    /// True if any paint of a part is wet.
    pub(super) fn is_wet(&self, part: &Part) -> bool {
        let mut tiles = self.sheets[part.sheet].store.iter();
        tiles.any(|(id, version)| {
            let wet = version
                .tile
                .as_ref()
                .filter(|tile| tile.wet_page().is_some());
            let (Some(tile), Some(stays)) = (wet, self.staying(part, id)) else {
                return false;
            };
            let mut holds = vec![true; TILE_CELLS];
            stays.iter().for_each(|cell| holds[*cell] = false);
            let wet = tile.wet();
            let any = |(_, plane): &(usize, Arc<[f32]>)| {
                let mut cells = plane.iter().zip(&holds);
                cells.any(|(count, holds)| *holds && *count > 0.0)
            };
            wet.iter().any(any)
        })
    }

    /// The tiles of a part after the lower `share` of their wet paint has dried into the next layer.
    fn drying(&self, part: &Part, share: f32) -> Changed {
        let number = self.next_layer();
        let dried = self.sheets[part.sheet].store.iter();
        let dried = dried.filter_map(|(id, version)| {
            let tile = version.tile.as_ref()?;
            let tile = tile.dried(number, share, &self.staying(part, id)?)?;
            Some((id, Arc::new(tile)))
        });
        dried.collect()
    }

    /// Puts dried tiles in their places and says how the layer is called.
    fn dried(&mut self, surface: u32, dried: Changed, name: &str) -> String {
        let number = self.next_layer();
        self.put_changed(surface, dried);
        self.add_layer(number, name)
    }

    /// Puts tiles in their places, within the step that is open.
    pub(super) fn put_changed(&mut self, surface: u32, tiles: Changed) {
        for (id, tile) in tiles {
            let before = self.put((surface, id), Some(tile));
            self.history.replaced(None, (surface, id), before);
        }
    }

    /// Tells of a new layer, and says how it is called.
    pub(super) fn add_layer(&mut self, number: u32, name: &str) -> String {
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

    /// Place of a dry layer in the scene.
    fn place_of(&self, which: &LayerRef) -> Result<usize, EditError> {
        let layers = &self.scene.layers;
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

    /// Tells the look and all who follow the scene.
    pub(super) fn layers_changed(&mut self) {
        let mut look = (*self.look).clone();
        look.set_layers(&self.scene.layers);
        self.look = Arc::new(look);
        self.scene.version += 1;
        self.note_look();
    }
}
