//! A blank surface and the display of its paint model: films, baked layers and whole tiles on it.

use std::borrow::Cow;
use std::ops::Deref;
use std::sync::Arc;

use maulstick_canvas::dry::DryStack;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::sheet::sheets;
use maulstick_canvas::tile::{Tile, TileId};

use crate::appearance::Appearance;
use crate::blank_surface::BlankSurface;
use crate::colouring::Colouring;
use crate::display::{DisplayTile, WetFilms};
use crate::edge::covers;
use crate::show_paint::{Seen, ShowPaint, counted_films};

/// A surface without its painting, and the display of the paint that comes on it.
#[derive(Clone, Debug)]
pub struct ShownSurface {
    /// The surface.
    pub blank: BlankSurface,
    /// Display of its paint model.
    pub shown: &'static dyn ShowPaint,
}

impl Deref for ShownSurface {
    type Target = BlankSurface;

    fn deref(&self) -> &BlankSurface {
        &self.blank
    }
}

impl ShownSurface {
    /// The wet films of a tile on it for shading by the optics; empty where nothing was painted.
    #[must_use]
    pub fn films(&self, tile: Option<&Tile>) -> WetFilms {
        let tile = tile.filter(|_| self.shown.colouring() == Colouring::Films);
        let films = tile.map(|tile| {
            let wet = tile.wet();
            WetFilms {
                all: self.shown.films(&wet),
                sheets: sheets(&wet),
            }
        });
        films.unwrap_or_default()
    }

    /// The dry layers of a tile on it for baking by the optics.
    #[must_use]
    pub fn baked<'a>(&self, tile: Option<&'a Tile>) -> Option<&'a Arc<DryStack>> {
        let tile = tile.filter(|_| self.shown.colouring() == Colouring::Films);
        tile.and_then(Tile::dry)
    }

    /// Height of a tile on it, m.
    #[must_use]
    pub(crate) fn height(&self, id: TileId, tile: Option<&Tile>) -> Vec<f32> {
        let heights = tile.map(|tile| self.shown.height(self, id, tile));
        let mut heights = heights.unwrap_or_else(|| vec![0.0; TILE_CELLS]);
        for well in self.in_wells(id) {
            if well.hides || heights[well.cell] == 0.0 {
                heights[well.cell] = well.height_m;
            }
        }
        let relief = self.relief.tile(id);
        heights
            .iter_mut()
            .zip(&*relief)
            .for_each(|(height, base)| *height += base);
        heights
    }

    /// Lets the ground show beside paint that covers a cell in part.
    fn uncover(
        &self,
        id: TileId,
        look: &Appearance,
        dry: Option<&Arc<DryStack>>,
        shown: &mut DisplayTile,
    ) {
        // Varnish lies on the ground as well, and is no paint with an edge.
        let mut paint = Cow::Borrowed(&shown.height);
        let layers = dry.filter(|_| !look.varnishes.is_empty());
        for layer in layers.into_iter().flat_map(|stack| stack.layers()) {
            for (slot, plane) in &*layer.planes.get() {
                if look.varnishes.contains(slot) {
                    let cells = paint.to_mut().iter_mut().zip(plane.iter());
                    cells.for_each(|(height, count)| *height -= count * QUANTUM_M as f32);
                }
            }
        }
        let Some(covers) = covers(&paint, self.cells_of(id)) else {
            return;
        };
        let bare = WetFilms::default().shade(&look.studio, self.ground.tile(id).under());
        for (plane, bare) in shown.rgb.iter_mut().zip(&bare) {
            for ((channel, bare), cover) in plane.iter_mut().zip(bare).zip(&covers) {
                *channel = cover * *channel + (1.0 - cover) * bare;
            }
        }
    }

    /// The display of a tile on it; `tile` is `None` where nothing was painted. `rgb` are the colours of its wet `films`
    /// over the ground under them.
    #[must_use]
    pub fn display(
        &self,
        id: TileId,
        tile: Option<&Tile>,
        (films, rgb): (&WetFilms, [Vec<f32>; 3]),
        look: &Appearance,
    ) -> DisplayTile {
        let is_shaded = self.shown.colouring() == Colouring::Films;
        let own = (!is_shaded).then(|| WetFilms::of(tile));
        let mut shown = DisplayTile::of(tile, (own.as_ref().unwrap_or(films), rgb), look);
        if is_shaded {
            self.uncover(id, look, tile.and_then(Tile::dry), &mut shown);
        }
        if let Some(tile) = tile {
            let seen = Seen {
                look,
                bare: self,
                id,
                tile,
            };
            self.shown.finish(&seen, &mut shown);
        }
        let dry = tile.and_then(Tile::dry);
        for well in self.in_wells(id) {
            let cell = well.cell;
            let is_bare = || {
                let dried = dry.is_some_and(|stack| stack.height()[cell] != 0.0);
                shown.wetness[cell] == 0.0 && !dried
            };
            if well.hides || well.height_m > 0.0 && is_bare() {
                for (plane, channel) in shown.rgb.iter_mut().zip(well.rgb) {
                    plane[cell] = channel;
                }
                (shown.gloss[cell], shown.wetness[cell]) = (1.0, 1.0);
            }
        }
        shown.height = self.height(id, tile);
        shown
    }
}

impl WetFilms {
    /// The wet films of a tile by its counts, as one sheet; empty where nothing was painted.
    #[must_use]
    pub fn of(tile: Option<&Tile>) -> Self {
        let films = tile.map(|tile| counted_films(&tile.wet()));
        Self {
            all: films.unwrap_or_default(),
            sheets: None,
        }
    }
}
