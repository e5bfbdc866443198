//! What the planes of a paint model mean to the optics: films, height, colour and gloss.

use std::fmt::Debug;

use maulstick_canvas::tile::{Tile, TileId};

use crate::appearance::Appearance;
use crate::blank_surface::BlankSurface;
use crate::display::{DisplayTile, WetFilms, painted_height};

/// A painted tile that is shown.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The optics.
    pub look: &'a Appearance,
    /// Its surface without paint.
    pub bare: &'a BlankSurface,
    /// Its place.
    pub id: TileId,
    /// Its paint.
    pub tile: &'a Tile,
}

/// How the paint of a model is shown. All are functions of a tile and of what it lies on.
pub trait ShowPaint: Debug + Send + Sync {
    /// Thickness of its wet paints, which the optics shade over what lies under them.
    fn films(&self, tile: &Tile) -> WetFilms {
        WetFilms::of(Some(tile))
    }

    /// True if [`finish`](Self::finish) makes the colours of all paint, wet and dry, out of those of the ground, and
    /// needs to know what stayed [wet over](maulstick_canvas::wet_over) each dry layer.
    fn has_own_colours(&self) -> bool {
        false
    }

    /// Height of the paint over its ground, m, a cell.
    fn height(&self, _bare: &BlankSurface, _id: TileId, tile: &Tile) -> Vec<f32> {
        painted_height(tile)
    }

    /// Changes colour and gloss to what the optics of films do not show.
    fn finish(&self, _seen: &Seen<'_>, _shown: &mut DisplayTile) {}
}

/// Paint that is counted by slot and shown as films of it.
#[derive(Clone, Copy, Debug)]
pub struct Counted;

impl ShowPaint for Counted {}
