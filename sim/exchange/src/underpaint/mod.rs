//! A picture as paint: for each of its colours the mixture whose film, of a given thickness over the surface's ground,
//! looks nearest to it under the scene's light, gloss included.
//!
//! Colours of 8 bits a channel are solved once each (`search.rs`). A pictured ground is rounded to 5 bits a channel.

mod candidates;
mod films;
mod recipes;
mod search;

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::ground::Ground;
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::tile::TileId;
use maulstick_optics::Paint;
use maulstick_painting::{EditError, LaidTile, Painting, SurfaceError};
use maulstick_types::paint::TILE;
use maulstick_types::values::FilmThickness;

pub use self::films::MOST_PAINTS;
use self::films::{Films, Shares};
use self::search::{Search, TargetColour, shared};
use crate::fit_to::{Raster, colours};
use crate::import_error::ImportError;
use crate::read_image::Image;

/// Significant part of a ground's channel.
const GROUND_BITS: u8 = 0xf8;

/// Ground and paints of an underpainting: all inputs of the search, so that painting can continue meanwhile.
#[derive(Clone, Debug)]
pub struct Support {
    look: Arc<Appearance>,
    bare: Arc<ShownSurface>,
    cells: [u32; 2],
    paints: Vec<Paint>,
}

impl Support {
    /// A surface of a painting, and `paints` by name.
    ///
    /// # Errors
    /// [`ImportError`] for an unknown surface or paint, none, or more than 16 paints.
    pub fn of(painting: &Painting, surface: u32, paints: &[String]) -> Result<Self, ImportError> {
        let (Some(bare), Some(store)) = (painting.bare(surface), painting.store(surface)) else {
            return Err(EditError::from(SurfaceError::Unknown(surface)).into());
        };
        if !(1..=MOST_PAINTS).contains(&paints.len()) {
            return Err(ImportError::Paints(paints.len()));
        }
        let mut found: Vec<Paint> = Vec::new();
        for name in paints {
            let paint = painting.library().find(name);
            let paint = paint.map_err(EditError::from)?;
            if !found.iter().any(|other| other.name == paint.name) {
                found.push(paint.clone());
            }
        }
        Ok(Self {
            look: Arc::clone(painting.look()),
            bare: Arc::clone(bare),
            cells: store.cells(),
            paints: found,
        })
    }
}

/// Colour error of an underpainting, ΔE₀₀ over the cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColourError {
    /// Number of cells.
    pub cells: u64,
    /// Different colours that were solved.
    pub colours: u64,
    /// Mean, ΔE₀₀.
    pub mean: f64,
    /// 95th percentile, ΔE₀₀.
    pub p95: f64,
    /// Greatest, ΔE₀₀.
    pub max: f64,
}

/// A picture as paint.
#[derive(Clone, Debug)]
pub struct Underpainting {
    paints: Vec<String>,
    colour_error: ColourError,
    raster: Raster,
    ground: Grounds,
    /// Keys of the colours, rising, and the quanta of each paint for each.
    keys: Vec<u64>,
    quanta: Vec<Vec<u32>>,
}

/// Distinguished colours of a ground.
#[derive(Clone, Debug)]
struct Grounds {
    bare: Arc<ShownSurface>,
    cells: [u32; 2],
}

/// The number of a colour of 8 bits a channel.
fn number([r, g, b]: [u8; 3]) -> u64 {
    u64::from(r) << 16 | u64::from(g) << 8 | u64::from(b)
}

/// The colour of a number.
fn colour(number: u64) -> [u8; 3] {
    [(number >> 16) as u8, (number >> 8) as u8, number as u8]
}

impl Grounds {
    fn grid(&self) -> [u32; 2] {
        self.cells.map(|cells| cells.div_ceil(TILE as u32))
    }

    fn tiles(&self) -> impl Iterator<Item = TileId> + use<> {
        let [across, up] = self.grid();
        (0..up).flat_map(move |y| (0..across).map(move |x| TileId { x, y }))
    }

    /// The keys of a tile's cells: the ground's colour above the picture's. None beyond the edge.
    fn keys(&self, raster: &Raster, id: TileId) -> Vec<Option<u64>> {
        let under = match &self.bare.ground {
            Ground::Even(_) => None,
            Ground::Picture(picture) => Some(picture.colours(id)),
        };
        let [across, up] = raster.cells;
        let key = |cell: usize| {
            let x = id.x as usize * TILE + cell % TILE;
            let y = id.y as usize * TILE + cell / TILE;
            if x >= across || y >= up {
                return None;
            }
            let rgb = number(raster.rgb[y * across + x]);
            let ground = under.as_ref().map_or(0, |colours| {
                number(colours[cell].map(|channel| channel & GROUND_BITS))
            });
            Some(ground << 24 | rgb)
        };
        (0..TILE_CELLS).map(key).collect()
    }

    /// Internal reflectances of a ground's colour by its number.
    fn under(&self, number: u64) -> Vec<f64> {
        let reflectance = match &self.bare.ground {
            Ground::Even(values) => values.clone(),
            Ground::Picture(picture) => {
                // The middle of the range that counts as one.
                let middle = colour(number).map(|channel| channel | (!GROUND_BITS / 2));
                picture.reflectance(middle)
            }
        };
        wide(&reflectance)
    }
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

/// Quanta of each paint of a film of `whole` in all.
fn counted(shares: &Shares, paints: usize, whole: u32) -> Vec<u32> {
    let count = |share: &f64| (share * f64::from(whole)).round() as u32;
    let mut quanta: Vec<u32> = shares.iter().take(paints).map(count).collect();
    let sum: u32 = quanta.iter().sum();
    if let Some(largest) = quanta.iter_mut().max() {
        *largest = (*largest + whole).saturating_sub(sum);
    }
    quanta
}

/// The picture as films of `thickness_m` on a surface; `progress` gets the searches done, and their number.
///
/// # Errors
/// [`ImportError`] for a film too thin or too thick, or a surface too large.
pub fn underpaint(
    support: &Support,
    image: &Image,
    thickness_m: f64,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Underpainting, ImportError> {
    if !FilmThickness::stored_range().contains(&thickness_m) {
        return Err(ImportError::Thickness(thickness_m * 1e6));
    }
    let raster = colours(image, support.cells.map(|cells| cells as usize))?;
    let ground = Grounds {
        bare: Arc::clone(&support.bare),
        cells: support.cells,
    };
    let counts = distinct(&ground, &raster);
    let keys: Vec<u64> = counts.keys().copied().collect();
    let studio = &support.look.studio;
    let whole = (thickness_m / QUANTUM_M).round() as u32;
    let films = Films::new(studio, &support.paints, f64::from(whole) * QUANTUM_M);
    let search = Search::new(&films, studio, wide(ground.bare.ground.mean()));
    let sought: Vec<TargetColour> = keys
        .iter()
        .map(|key| TargetColour {
            rgb: colour(*key),
            ground: *key >> 24,
        })
        .collect();
    let under = |number: u64| ground.under(number);
    let found = search.all(&sought, &under, progress);
    let paints = support.paints.len();
    let quanta: Vec<Vec<u32>> = found
        .iter()
        .map(|shares| counted(shares, paints, whole))
        .collect();
    let laid: Vec<_> = sought.iter().zip(&quanta).collect();
    let reached = shared(&laid, |(sought, quanta)| {
        let mut shares = [0.0; MOST_PAINTS];
        for (share, count) in shares.iter_mut().zip(*quanta) {
            *share = f64::from(*count) / f64::from(whole);
        }
        search.off(sought, &under(sought.ground), &shares)
    });
    let used: Vec<usize> = (0..paints)
        .filter(|paint| quanta.iter().any(|quanta| quanta[*paint] > 0))
        .collect();
    let only = |quanta: &Vec<u32>| used.iter().map(|paint| quanta[*paint]).collect();
    Ok(Underpainting {
        paints: used
            .iter()
            .map(|paint| support.paints[*paint].name.clone())
            .collect(),
        colour_error: colour_error(&counts, &reached),
        raster,
        ground,
        keys,
        quanta: quanta.iter().map(only).collect(),
    })
}

/// Number of cells of each key.
fn distinct(ground: &Grounds, raster: &Raster) -> BTreeMap<u64, u64> {
    let mut counts = BTreeMap::new();
    for id in ground.tiles() {
        let mut keys: Vec<u64> = ground.keys(raster, id).into_iter().flatten().collect();
        keys.sort_unstable();
        for same in keys.chunk_by(|a, b| a == b) {
            *counts.entry(same[0]).or_insert(0) += same.len() as u64;
        }
    }
    counts
}

fn colour_error(counts: &BTreeMap<u64, u64>, reached: &[f64]) -> ColourError {
    let mut off: Vec<(f64, u64)> = reached
        .iter()
        .copied()
        .zip(counts.values().copied())
        .collect();
    off.sort_by(|a, b| a.0.total_cmp(&b.0));
    let cells: u64 = off.iter().map(|(_, cells)| cells).sum();
    let sum: f64 = off.iter().map(|(off, cells)| off * *cells as f64).sum();
    let mut below = 0;
    let within = off.iter().find(|(_, of_them)| {
        below += of_them;
        20 * below >= 19 * cells
    });
    ColourError {
        cells,
        colours: off.len() as u64,
        mean: sum / cells.max(1) as f64,
        p95: within.map_or(0.0, |(off, _)| *off),
        max: off.last().map_or(0.0, |(off, _)| *off),
    }
}

impl Underpainting {
    /// Names of the paints in use.
    #[must_use]
    pub fn paints(&self) -> &[String] {
        &self.paints
    }

    /// Colour error.
    #[must_use]
    pub fn colour_error(&self) -> &ColourError {
        &self.colour_error
    }

    /// Paint of each tile, for [`Painting::underpaint`] with [`paints`](Self::paints).
    pub fn tiles(&self) -> impl Iterator<Item = LaidTile> {
        self.ground.tiles().map(|id| self.tile(id))
    }

    fn tile(&self, id: TileId) -> LaidTile {
        let mut planes = vec![vec![0u32; TILE_CELLS]; self.paints.len()];
        for (cell, key) in self.ground.keys(&self.raster, id).into_iter().enumerate() {
            let place = key.and_then(|key| self.keys.binary_search(&key).ok());
            if let Some(place) = place {
                for (plane, count) in planes.iter_mut().zip(&self.quanta[place]) {
                    plane[cell] = *count;
                }
            }
        }
        let planes = planes.into_iter().enumerate();
        LaidTile {
            id,
            planes: planes
                .filter(|(_, plane)| plane.iter().any(|count| *count > 0))
                .collect(),
        }
    }
}
