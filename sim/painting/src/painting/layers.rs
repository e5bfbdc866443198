//! Drying, and edits of dry layers.

use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::Region;
use maulstick_types::paint::TILE;
use maulstick_types::scene::Layer;

use super::Painting;

/// A part of a surface.
pub(super) struct Part {
    /// Index of its surface.
    pub(super) sheet: usize,
    /// Its cells: the first column and row, and one past the last.
    cells: [[u32; 2]; 2],
}

/// Tiles after some of their paint dried, or became wet.
pub(super) type Changed = Vec<(TileId, Arc<Tile>)>;

/// The error that nothing is wet.
pub(super) fn nothing_wet(region: Option<&Region>) -> EditError {
    let place = region.map_or(String::new(), |region| format!(" in {region}"));
    EditError::new(format!("nothing is wet{place}"), "paint something first")
}

impl Painting {
    /// Dries the lower `share` of all wet paint of a surface into a new layer called `name`, and says
    /// which.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface, or where nothing is wet.
    pub fn dry(&mut self, surface: u32, share: f32, name: &str) -> Result<String, EditError> {
        self.dry_part(surface, share, name, None)
    }

    /// As [`dry`](Self::dry), but only the cells whose middle is in `region`, if there is one.
    ///
    /// # Errors
    /// As [`dry`](Self::dry), and for a region outside the surface.
    pub fn dry_part(
        &mut self,
        surface: u32,
        share: f32,
        name: &str,
        region: Option<&Region>,
    ) -> Result<String, EditError> {
        self.close_windows();
        let part = self.part(surface, region)?;
        let dried = self.drying(&part, share);
        if dried.is_empty() {
            return Err(nothing_wet(region));
        }
        self.let_stay_wet(Some(surface));
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
    ) -> Result<String, EditError> {
        let part = self.part(surface, None)?;
        let dried = self.drying(&part, share);
        if dried.is_empty() {
            return Err(nothing_wet(None));
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
        let fault = |what: String| {
            let [width, height] = cells.map(|cells| f64::from(cells) * cell_m * 1e3);
            let help = format!(
                "the surface is {width:.1}x{height:.1} mm, its origin at the lower left corner"
            );
            EditError::new(what, &help)
        };
        region.check().map_err(fault)?;
        let within = region.cells(cells, cell_m);
        let within = within.ok_or_else(|| fault(format!("the region {region} holds no cell")))?;
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

    /// Makes the dry layer of a name, or of a number in digits, more or less opaque; of several of a
    /// name it is the newest.
    ///
    /// # Errors
    /// [`EditError`] for an unknown layer.
    pub fn set_opacity_of(&mut self, layer: &str, opacity: f32) -> Result<(), EditError> {
        let named = self.scene.layers.iter().rev();
        let number: Option<u32> = layer.parse().ok();
        let found = named.clone().find(|other| other.name == layer);
        let found = found.or_else(|| named.clone().find(|other| Some(other.number) == number));
        match found.map(|layer| layer.number) {
            Some(number) => self.set_opacity(number, opacity),
            None if number.is_some() => Err(self.no_layer(layer)),
            None => Err(self.no_layer(&format!("called '{layer}'"))),
        }
    }

    fn no_layer(&self, which: &str) -> EditError {
        let known = self.scene.layers.iter();
        let known: Vec<String> = known
            .map(|layer| format!("{} ({})", layer.number, layer.name))
            .collect();
        let help = match known.is_empty() {
            true => "nothing has dried yet: `maulstick dry` makes a layer".to_owned(),
            false => format!("there are {}", known.join(", ")),
        };
        EditError::new(format!("there is no dry layer {which}"), &help)
    }

    /// Makes a dry layer more or less opaque: a factor on its optical thickness, never on its height.
    ///
    /// # Errors
    /// [`EditError`] for an unknown layer.
    pub fn set_opacity(&mut self, layer: u32, opacity: f32) -> Result<(), EditError> {
        let layers = &self.scene.layers;
        let Some(place) = layers.iter().position(|other| other.number == layer) else {
            return Err(self.no_layer(&layer.to_string()));
        };
        self.begin_step("opacity", None);
        self.scene.layers[place].opacity = opacity;
        self.layers_changed();
        self.end_own_step();
        Ok(())
    }

    /// Gives a dry layer another name.
    ///
    /// # Errors
    /// [`EditError`] for an unknown layer.
    pub fn name_layer(&mut self, layer: u32, name: &str) -> Result<(), EditError> {
        let layers = &self.scene.layers;
        let Some(place) = layers.iter().position(|other| other.number == layer) else {
            return Err(self.no_layer(&layer.to_string()));
        };
        self.begin_step("name", None);
        name.trim().clone_into(&mut self.scene.layers[place].name);
        self.scene.version += 1;
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
