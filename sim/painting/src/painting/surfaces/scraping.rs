//! Scraping: wet paint leaves a surface for the cleaner.

use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};

use super::part::Changed;
use crate::painting::Painting;

impl super::SurfaceState {
    /// Its tiles without their wet paint, except in the cells that `stay` returns for a tile (one without stays whole).
    pub(crate) fn scraped(&self, stay: impl Fn(TileId) -> Option<Vec<usize>>) -> Changed {
        let scraped = self.wet_tiles().filter_map(|(id, tile)| {
            let tile = tile.scraped(&stay(id)?)?;
            Some((id, tile.into()))
        });
        scraped.collect()
    }
}

impl Painting {
    /// Replaces tiles by ones with less wet paint, within a step; the cleaner gets the difference.
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
