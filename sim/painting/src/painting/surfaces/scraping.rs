//! Scraping: wet paint leaves a surface for the cleaner.

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::TileId;
use maulstick_types::edits::Scrape;

use super::part::Changed;
use crate::apply::{Applied, Apply};
use crate::painting::Painting;

impl Apply for Scrape {
    /// Wet paint of a part goes to the cleaner, but for that in wells.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.close_windows();
        let (on, part) = painting.surfaces.part(self.surface, self.region.as_ref())?;
        let surface = &painting.surfaces[on];
        let scraped = surface.scraped(|id| surface.staying(&part, id));
        if scraped.0.is_empty() {
            return Err(EditError::NothingWet(self.region.clone()));
        }
        painting.clock.stop(Some(self.surface));
        painting.begin_step("scrape", None);
        painting.put_scraped(on, scraped);
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

impl super::SurfaceState {
    /// Its tiles without their wet paint, but for that of the cells that `stay` of a tile has (a tile without stays
    /// whole), and what was scraped off.
    pub(crate) fn scraped(&self, stay: impl Fn(TileId) -> Option<Vec<usize>>) -> (Changed, Counts) {
        let mut off = [0; SLOTS];
        let tiles = self.wet_tiles();
        let scraped = tiles.filter_map(|(id, tile)| {
            let (tile, counts) = tile.scraped(&stay(id)?)?;
            add(&mut off, &counts);
            Some((id, tile.into()))
        });
        (scraped.collect(), off)
    }
}

impl Painting {
    /// Puts tiles in place from which paint was scraped, within a step.
    pub(crate) fn put_scraped(&mut self, on: usize, (tiles, mut off): (Changed, Counts)) {
        let surface = &self.surfaces[on];
        if let Some(count) = self.backend.models.of(surface.model).count_own() {
            for (id, after) in &tiles {
                let before = surface.store.version(*id).tile.clone();
                let gone = before.map_or([0; SLOTS], |tile| count(tile.wet().own()));
                let stays = count(after.wet().own());
                let gone = gone.iter().zip(&stays).map(|(gone, stays)| gone - stays);
                off.iter_mut()
                    .zip(gone)
                    .for_each(|(off, gone)| *off += gone);
            }
        }
        self.put_changed(on, tiles);
        self.accounts.ledger.to_cleaner(&off);
        self.book(None);
    }
}
