//! Rewetting of dry layers.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::Painting;
use super::layers::{Changed, Part};
use crate::apply::{Applied, Apply};
use maulstick_canvas::EditError;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::edits::Wet;

impl Apply for Wet {
    /// Rewets the newest dry layers of a part in place.
    ///
    /// A cell takes no more than it can hold: paint without room, and all under it there, stays dry. A layer that is
    /// empty afterwards is removed from the scene. A layer whose opacity is not 1 is refused, for wet paint has no
    /// opacity.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let part = painting.part(self.surface, self.region.as_ref())?;
        painting.close_windows();
        let numbers = painting.newest_on(&part, self.layers);
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
        for (id, tile, within) in painting.dried_tiles(&part) {
            if let Some(rewet) = tile.rewet(least, &within) {
                full_cells += rewet.full_cells;
                tiles.push((id, Arc::new(rewet.tile)));
            }
        }
        if tiles.is_empty() {
            return Err(EditError::NoRoom(self.region.clone()));
        }
        painting.let_stay_wet(Some(self.surface));
        painting.begin_step("wet", None);
        painting.put_changed(self.surface, tiles);
        painting.drop_empty_layers(&numbers);
        painting.end_own_step();
        Ok(Applied::Rewet { layers, full_cells })
    }
}

impl Painting {
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

    /// Numbers of the newest layers, `count` of them or all, that have paint in a part.
    fn newest_on(&self, part: &Part, count: Option<u32>) -> BTreeSet<u32> {
        let most = count.map_or(usize::MAX, |count| count as usize);
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
