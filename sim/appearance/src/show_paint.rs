//! Display of a paint model's planes: films, height, columns, colour and gloss.

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
/// Columns of a tile with air under paint, by cell: the top of the paint on the ground, then bottom and top of each
/// piece over air, m above the highest bare peaks.
pub type ColumnEnds = BTreeMap<usize, Vec<f32>>;

/// A painted tile for display.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The optics.
    pub look: &'a Appearance,
    /// Unpainted surface of the tile.
    pub bare: &'a BlankSurface,
    /// Its place.
    pub id: TileId,
    /// Paint of the tile.
    pub tile: &'a Tile,
}

/// Display of a paint model. All methods are functions of a tile and its ground.
pub trait ShowPaint: Debug + Send + Sync {
    /// Conversion of its counts to colours. Other than by films, [`finish`](Self::finish) computes the colours of all
    /// paint, wet and dry, from those of the ground. Between models of different colourings conversions fit colours.
    fn colouring(&self) -> Colouring {
        Colouring::Films
    }

    /// True for a model whose wet paint may lie in two sheets (`maulstick_canvas::sheet`).
    fn has_sheets(&self) -> bool {
        false
    }

    /// Thickness of the paints of wet or dry planes, seen from above.
    fn films(&self, planes: &Planes) -> Films {
        counted_films(planes)
    }

    /// Height of the paint over its ground, m, a cell.
    fn height(&self, _bare: &BlankSurface, _id: TileId, tile: &Tile) -> Vec<f32> {
        painted_height(self, tile)
    }

    /// Columns with air under paint, on cells of side `cell_m`.
    fn columns(&self, _relief: &Relief, _id: TileId, _tile: &Tile, _cell_m: f64) -> ColumnEnds {
        ColumnEnds::new()
    }

    /// The tile with a layer that has just dried, and any note that its colours will need.
    fn dried(&self, tile: Tile) -> Tile {
        tile
    }

    /// Adds to colour and gloss the effects that the optics of films lack.
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

/// Paint displayed as films of its counts by slot, in one sheet or two.
#[derive(Clone, Copy, Debug)]
pub struct Counted;

impl ShowPaint for Counted {
    fn has_sheets(&self) -> bool {
        true
    }
}
