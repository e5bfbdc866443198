//! What the planes of a paint model mean to the optics: films, height, colour and gloss.

use std::fmt::Debug;

use maulstick_canvas::tile::Tile;

use crate::display::{DisplayTile, WetFilms, painted_height};

/// How the paint of a model is shown. All are functions of a tile alone.
pub trait ShowPaint: Debug + Send + Sync {
    /// Thickness of its wet paints, which the optics shade over what lies under them.
    fn films(&self, tile: &Tile) -> WetFilms {
        WetFilms::of(Some(tile))
    }

    /// Height of the paint over its ground, m, a cell.
    fn height(&self, tile: &Tile) -> Vec<f32> {
        painted_height(tile)
    }

    /// Changes colour and gloss to what the optics of films do not show.
    fn finish(&self, _tile: &Tile, _shown: &mut DisplayTile) {}
}

/// Paint that is counted by slot and shown as films of it.
#[derive(Clone, Copy, Debug)]
pub struct Counted;

impl ShowPaint for Counted {}
