//! Tiles that come in the place of others, within the open step of no brush, and what that books.

use std::sync::Arc;

use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};

use maulstick_types::paint::StepName;

use super::Workbench;
use crate::clock::Clock;
use crate::history::{SurfaceMaterial, TilePlace, TileRef, materials};
use crate::ledger::Ledger;
use crate::painting::surfaces::Changed;
use crate::painting::surfaces::film::Films;

impl Workbench {
    /// Puts a tile in the place of another.
    pub(crate) fn replace(&mut self, place: TilePlace, tile: TileRef) {
        let before = self.desk.surfaces.put(place, tile);
        self.past.history.replaced(None, place, before);
    }

    /// Puts tiles of a surface in their places.
    pub(crate) fn put_changed(&mut self, on: usize, tiles: Changed) {
        let surface = self.desk.surfaces[on].id;
        for (id, tile) in tiles {
            let tile = (!tile.is_bare()).then_some(tile);
            self.replace((surface, id), tile);
        }
    }

    /// Puts tiles in place that together have less wet paint than before; the cleaner takes the rest.
    pub(crate) fn put_scraped(&mut self, on: usize, tiles: Changed) {
        let own = self.backend.models.of(self.desk.surfaces[on].model);
        let own = own.count_own();
        let [before, after] = self.counts(on, &tiles, |sum, tile| {
            add(sum, &tile.counts());
            if let Some(own) = own {
                add(sum, &own(tile.wet().own()));
            }
        });
        let off = std::array::from_fn(|slot| before[slot].saturating_sub(after[slot]));
        self.put_changed(on, tiles);
        self.accounts.ledger.to_cleaner(&off);
        self.book(None);
    }

    /// Puts tiles in place that together have less paint than before, wet or dry; the cleaner takes the rest.
    pub(crate) fn put_taken_off(&mut self, on: usize, tiles: Changed) {
        let [before, after] = self.counts(on, &tiles, wet_and_dry);
        let off = std::array::from_fn(|slot| before[slot].saturating_sub(after[slot]));
        self.put_changed(on, tiles);
        self.accounts.ledger.to_cleaner(&off);
        self.book(None);
    }

    /// Puts tiles in place whose cells have as much paint as before: what changed from one paint to another is booked as
    /// given and taken by a mode.
    pub(crate) fn put_converted(&mut self, on: usize, tiles: Changed) {
        let [before, after] = self.counts(on, &tiles, wet_and_dry);
        self.put_changed(on, tiles);
        let exchanged: [i64; SLOTS] =
            std::array::from_fn(|slot| after[slot] as i64 - before[slot] as i64);
        self.accounts.ledger.from_mode(&exchanged);
        self.book(None);
    }

    /// Counts of the tiles that others are to replace, and of these.
    fn counts(
        &self,
        on: usize,
        tiles: &Changed,
        count: impl Fn(&mut Counts, &Tile),
    ) -> [Counts; 2] {
        let [mut before, mut after] = [[0; SLOTS]; 2];
        for (id, tile) in tiles {
            if let Some(tile) = &self.desk.surfaces[on].store.version(*id).tile {
                count(&mut before, tile);
            }
            count(&mut after, tile);
        }
        [before, after]
    }

    /// Lays wet paint on a tile, as [`with_film`](crate::painting::surfaces::SurfaceState::with_film) does; from where
    /// `book` says.
    pub(crate) fn lay_on(
        &mut self,
        (on, id): (usize, TileId),
        quanta: impl Fn(usize, usize) -> f32,
        films: Option<&mut Films>,
        book: fn(&mut Ledger, &Counts),
    ) {
        let surfaces = &mut self.desk.surfaces;
        let Some(film) = surfaces[on].with_film(id, quanta, films, &surfaces.pager) else {
            return;
        };
        let surface = &mut surfaces[on];
        surface.top = surface.top.max(film.top);
        let place = (surface.id, id);
        self.replace(place, Some(Arc::new(film.tile)));
        book(&mut self.accounts.ledger, &film.given);
        self.book(None);
    }

    /// Dries the lower `share` of the wet paint of a surface and returns the name of its layer; `None` where nothing is
    /// wet.
    pub(crate) fn dry(
        &mut self,
        clock: &mut Clock,
        on: usize,
        share: f32,
        name: &str,
    ) -> Option<String> {
        let number = self.desk.next_layer();
        let surface = &self.desk.surfaces[on];
        let dried = surface.dried(&surface.part(None).ok()?, number, share);
        if dried.is_empty() {
            return None;
        }
        clock.stop(Some(surface.id));
        self.put_changed(on, dried);
        Some(self.desk.add_layer(number, name).name)
    }

    /// Changes the materials of a surface: a step of its own.
    pub(crate) fn change_material(
        &mut self,
        what: StepName,
        on: usize,
        change: impl FnOnce(&mut SurfaceMaterial),
    ) {
        self.begin_step(what, None);
        let mut materials = materials(&self.desk.scene);
        change(&mut materials[on]);
        self.desk.set_materials(&materials);
        self.end_own_step();
    }
}

/// Adds all paint of a tile.
fn wet_and_dry(sum: &mut Counts, tile: &Tile) {
    add(sum, &tile.counts());
    if let Some(stack) = tile.dry() {
        add(sum, &stack.counts());
    }
}
