//! What the planes of a paint model mean to the optics: films, height, columns, colour and gloss.

use std::collections::BTreeMap;
use std::fmt::Debug;

use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};

use crate::appearance::Appearance;
use crate::blank_surface::BlankSurface;
use crate::colouring::Colouring;
use crate::display::{DisplayTile, height};

/// Thickness of each paint of planes, m, by slot.
pub type Films = Vec<(usize, Vec<f32>)>;
/// Columns of a tile with air under paint, by cell: the top of what lies on the ground, then bottom and top of each piece over
/// air, m above the highest bare peaks.
pub type ColumnEnds = BTreeMap<usize, Vec<f32>>;

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
    /// How its counts become colours. Where that is not by films, [`finish`](Self::finish) makes the colours of all paint,
    /// wet and dry, out of those of the ground. Between models that differ in it conversions fit colours.
    fn colouring(&self) -> Colouring {
        Colouring::Films
    }

    /// Thickness of the paints of wet or dry planes as they are seen from above.
    fn films(&self, planes: &Planes) -> Films {
        counted_films(planes)
    }

    /// Height of the paint over its ground, m, a cell.
    fn height(&self, _bare: &BlankSurface, _id: TileId, tile: &Tile) -> Vec<f32> {
        painted_height(self, tile)
    }

    /// The columns in which there is air under paint, on cells of side `cell_m`.
    fn columns(&self, _relief: &Relief, _id: TileId, _tile: &Tile, _cell_m: f64) -> ColumnEnds {
        ColumnEnds::new()
    }

    /// A tile of which a layer has just dried, with what its colours will have to know of that.
    fn dried(&self, tile: Tile) -> Tile {
        tile
    }

    /// Changes colour and gloss to what the optics of films do not show.
    fn finish(&self, _seen: &Seen<'_>, _shown: &mut DisplayTile) {}
}

/// Thickness of each paint of planes by its counts, m, by slot.
#[must_use]
pub fn counted_films(planes: &Planes) -> Films {
    let film = |plane: &[f32]| plane.iter().map(|count| count * QUANTUM_M as f32).collect();
    planes
        .iter()
        .map(|(slot, plane)| (*slot, film(plane)))
        .collect()
}

/// Height of a tile's films, wet and dry, m.
#[must_use]
pub fn painted_height(shown: &(impl ShowPaint + ?Sized), tile: &Tile) -> Vec<f32> {
    let dry = tile.dry().map(|stack| &**stack);
    height(&shown.films(&tile.wet()), dry)
}

/// Paint that is counted by slot and shown as films of it.
#[derive(Clone, Copy, Debug)]
pub struct Counted;

impl ShowPaint for Counted {}
