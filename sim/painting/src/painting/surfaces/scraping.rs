//! Scraping: wet paint leaves a surface for the cleaner.

use maulstick_canvas::EditError;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_types::edits::Scrape;
use maulstick_types::paint::StepName;

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
        if scraped.is_empty() {
            return Err(EditError::NothingWet(self.region.clone()));
        }
        painting.clock.stop(Some(self.surface));
        painting.begin_step(StepName::Scrape, None);
        painting.put_scraped(on, scraped);
        painting.end_own_step();
        Ok(Applied::Done)
    }
}

impl super::SurfaceState {
    /// Its tiles without their wet paint, but for that of the cells that `stay` of a tile has (a tile without stays
    /// whole).
    pub(crate) fn scraped(&self, stay: impl Fn(TileId) -> Option<Vec<usize>>) -> Changed {
        let scraped = self.wet_tiles().filter_map(|(id, tile)| {
            let tile = tile.scraped(&stay(id)?)?;
            Some((id, tile.into()))
        });
        scraped.collect()
    }
}

impl Painting {
    /// Puts tiles in place that together have less wet paint than before, within a step; the cleaner takes the rest.
    pub(crate) fn put_scraped(&mut self, on: usize, tiles: Changed) {
        let surface = &self.surfaces[on];
        let own = self.backend.models.of(surface.model).count_own();
        let count = |sum: &mut Counts, tile: &Tile| {
            add(sum, &tile.counts());
            if let Some(own) = own {
                add(sum, &own(tile.wet().own()));
            }
        };
        let (mut before, mut after) = ([0; SLOTS], [0; SLOTS]);
        for (id, tile) in &tiles {
            if let Some(tile) = &surface.store.version(*id).tile {
                count(&mut before, tile);
            }
            count(&mut after, tile);
        }
        let off = std::array::from_fn(|slot| before[slot].saturating_sub(after[slot]));
        self.put_changed(on, tiles);
        self.accounts.ledger.to_cleaner(&off);
        self.book(None);
    }
}
