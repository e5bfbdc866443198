//! Rewetting of dry layers.

use std::collections::BTreeSet;
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::Region;

use super::Painting;
use super::layers::{Changed, Part};

impl Painting {
    /// Rewets the newest `layers` dry layers of a part in place; 0 means all. Returns which, in words.
    ///
    /// A cell takes no more than it can hold: paint without room, and all under it there, stays dry. A layer that is
    /// empty afterwards is removed from the scene.
    ///
    /// # Errors
    /// [`EditError`] for an unknown surface or a part outside it, where nothing has dried or has room, and for a layer
    /// whose opacity is not 1, for wet paint has no opacity. Then nothing has changed.
    pub fn wet(
        &mut self,
        surface: u32,
        layers: u32,
        region: Option<&Region>,
    ) -> Result<String, EditError> {
        let part = self.part(surface, region)?;
        self.close_windows();
        let numbers = self.newest_on(&part, layers);
        let place = region.map_or(String::new(), |region| format!(" in {region}"));
        let Some(least) = numbers.first().copied() else {
            return Err(EditError::new(
                format!("nothing has dried{place}"),
                "`maulstick dry` dries wet paint",
            ));
        };
        let known = self.scene.layers.iter();
        let chosen = known.filter(|layer| numbers.contains(&layer.number));
        if let Some(veiled) = chosen.clone().find(|layer| layer.opacity != 1.0) {
            let (number, name) = (veiled.number, &veiled.name);
            return Err(EditError::new(
                format!("wet paint cannot keep the opacity of layer {number} ({name})"),
                &format!("`maulstick opacity {number} 1` makes it as it was laid"),
            ));
        }
        let names: Vec<String> = chosen.rev().map(|layer| layer.name.clone()).collect();
        let mut full_cells = 0;
        let mut tiles = Changed::new();
        for (id, tile, within) in self.dried_tiles(&part) {
            if let Some(rewet) = tile.rewet(least, &within) {
                full_cells += rewet.full_cells;
                tiles.push((id, Arc::new(rewet.tile)));
            }
        }
        if tiles.is_empty() {
            return Err(EditError::new(
                format!("no cell{place} has room for more wet paint"),
                "take some of the wet paint off first, or dry it",
            ));
        }
        self.let_stay_wet(Some(surface));
        self.begin_step("wet", None);
        self.put_changed(surface, tiles);
        self.drop_empty_layers(&numbers);
        self.end_own_step();
        let names = names.join(", ");
        Ok(match full_cells {
            0 => names,
            cells => format!("{names}; {cells} cells could not hold all of it"),
        })
    }

    /// The tiles of a part on which something has dried, with the cells that are of the part.
    fn dried_tiles<'a>(
        &'a self,
        part: &'a Part,
    ) -> impl Iterator<Item = (TileId, &'a Arc<Tile>, Vec<bool>)> {
        let tiles = self.sheets[part.sheet].store.iter();
        tiles.filter_map(|(id, version)| {
            let tile = version.tile.as_ref().filter(|tile| tile.dry().is_some())?;
            let mut within = vec![true; TILE_CELLS];
            for cell in self.staying(part, id)? {
                within[cell] = false;
            }
            Some((id, tile, within))
        })
    }

    /// Numbers of the newest layers, `count` of them or for 0 all, that have paint in a part.
    fn newest_on(&self, part: &Part, count: u32) -> BTreeSet<u32> {
        let most = if count == 0 {
            usize::MAX
        } else {
            count as usize
        };
        let mut found = BTreeSet::new();
        for (_, tile, within) in self.dried_tiles(part) {
            let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
            for layer in layers {
                if found.len() == most && found.first().is_some_and(|least| layer.number < *least) {
                    break;
                }
                let planes = layer.planes.get();
                let any = |(_, plane): &(usize, Arc<[f32]>)| {
                    let mut cells = plane.iter().zip(&within);
                    cells.any(|(count, within)| *within && *count > 0.0)
                };
                if !found.contains(&layer.number) && planes.iter().any(any) {
                    found.insert(layer.number);
                    if found.len() > most {
                        found.pop_first();
                    }
                }
            }
        }
        found
    }

    /// Removes those of `numbers` from the scene that are empty on every surface.
    fn drop_empty_layers(&mut self, numbers: &BTreeSet<u32>) {
        let mut gone = numbers.clone();
        for (_, version) in self.sheets.iter().flat_map(|sheet| sheet.store.iter()) {
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
