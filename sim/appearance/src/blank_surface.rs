//! A surface where no brush has been: its ground, its relief, and the paint in its wells.
//!
//! A well's paint is booked when a brush first comes to it; until then it is only shown.

use std::sync::Arc;

use maulstick_canvas::relief::Relief;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_optics::{FilmPlanes, Studio, Under};
use maulstick_types::paint::TILE;

use crate::display::WetFilms;
use crate::ground::Ground;
use crate::show_paint::ShowPaint;

/// Thickness of the paint in a well, m.
pub const WELL_M: f64 = 2e-3;

/// A well as it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WellLook {
    /// Its middle, cells.
    pub center: [f64; 2],
    /// Its radius, cells.
    pub radius: f64,
    /// Its unlit colour, linear sRGB.
    pub rgb: [f32; 3],
    /// Height of its paint, m.
    pub height_m: f32,
}

/// The cleaner, as it looks: a jar of spirits, linear sRGB.
pub const CLEANER_RGB: [f32; 3] = [0.30, 0.37, 0.40];

/// A surface without what was painted on it.
#[derive(Clone, Debug)]
pub struct BlankSurface {
    /// Ground that it is primed with.
    pub ground: Ground,
    /// Heights of the ground under the paint.
    pub relief: Arc<Relief>,
    /// Its wells.
    pub wells: Vec<WellLook>,
    /// How the paint of its model is shown.
    pub shown: &'static dyn ShowPaint,
}

impl BlankSurface {
    /// The wet films of a tile on it; empty where nothing was painted.
    #[must_use]
    pub fn films(&self, tile: Option<&Tile>) -> WetFilms {
        tile.map(|tile| self.shown.films(tile)).unwrap_or_default()
    }

    /// The cells of a tile that lie in a well, by their place in the tile, with the well.
    pub fn in_wells(&self, id: TileId) -> impl Iterator<Item = (usize, &WellLook)> {
        let wells = self.wells.iter();
        wells.flat_map(move |well| {
            cells_in_circle(well.center, well.radius, id).map(move |cell| (cell, well))
        })
    }
}

/// The colour of paint as thick as in a well: its slots and shares in `studio`.
#[must_use]
pub fn well_colour(studio: &Studio, shares: &[(usize, f64)], ground: &[f32]) -> [f32; 3] {
    let films: Vec<(usize, [f32; 1])> = shares
        .iter()
        .map(|(slot, share)| (*slot, [(share * WELL_M) as f32]))
        .collect();
    let paints: Vec<(usize, &[f32])> = films.iter().map(|(slot, d)| (*slot, &d[..])).collect();
    let mut rgb = [[0.0f32]; 3];
    let [red, green, blue] = &mut rgb;
    let planes = FilmPlanes {
        paints: &paints,
        opacity: 1.0,
        under: Under::Even(ground),
    };
    studio.shade(&planes, [red, green, blue]);
    rgb.map(|channel| channel[0])
}

/// Cells of a tile whose middle is within a circle, whose center and radius are in cells.
pub fn cells_in_circle(center: [f64; 2], radius: f64, id: TileId) -> impl Iterator<Item = usize> {
    let corner = [f64::from(id.x), f64::from(id.y)].map(|tile| tile * TILE as f64);
    let span = move |i: usize| {
        let inside = |cell: f64| (cell - corner[i]).clamp(0.0, TILE as f64) as usize;
        inside((center[i] - radius).floor())..inside((center[i] + radius).ceil())
    };
    span(1)
        .flat_map(move |y| span(0).map(move |x| (x, y)))
        .filter(move |(x, y)| {
            let dx = corner[0] + *x as f64 + 0.5 - center[0];
            let dy = corner[1] + *y as f64 + 0.5 - center[1];
            dx * dx + dy * dy < radius * radius
        })
        .map(|(x, y)| y * TILE + x)
}
