//! Films of a set of tiles.

use maulstick_optics::backend::TILE_CELLS;
use maulstick_optics::studio::StudioSettings;
use maulstick_optics::{FilmPlanes, PaintLibrary, Studio, Under};
use maulstick_rig::UserError;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};

/// Tiles of 512×512 cells.
pub(crate) const TILES: usize = 64;
/// Paints of a film.
pub(crate) const PAINTS: usize = 4;
/// Thickest paint of a cell, m.
const MOST_M: f32 = 5e-5;
const SEED: u64 = 512;

/// A studio of the first paints, under its usual light with its usual sixteen samples.
pub(crate) fn studio() -> Result<Studio, UserError> {
    let library =
        PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))?;
    let mut studio = Studio::new(&StudioSettings::default(), library.paints());
    for paint in library.paints().iter().take(PAINTS) {
        studio.add(paint);
    }
    Ok(studio)
}

/// One layer of paint on all tiles, and the ground of each.
pub(crate) struct Layer {
    thickness: Vec<Vec<f32>>,
    /// A plane a wavelength, for each tile.
    pub(crate) under: Vec<Vec<f32>>,
}

impl Layer {
    /// Random paint over random layers.
    pub(crate) fn random(studio: &Studio) -> Self {
        let mut random = Pcg64::seed_from_u64(SEED);
        let mut plane = |cells: usize, most: f32| -> Vec<f32> {
            let unit = |_| (random.next_u32() >> 8) as f32 / 16_777_216.0 * most;
            (0..cells).map(unit).collect()
        };
        let cells = TILE_CELLS;
        Self {
            thickness: (0..TILES * PAINTS).map(|_| plane(cells, MOST_M)).collect(),
            under: (0..TILES)
                .map(|_| plane(studio.wavelengths() * cells, 1.0))
                .collect(),
        }
    }

    /// Paints of each tile.
    pub(crate) fn paints(&self) -> Vec<[(usize, &[f32]); PAINTS]> {
        self.thickness
            .chunks_exact(PAINTS)
            .map(|planes| std::array::from_fn(|slot| (slot, planes[slot].as_slice())))
            .collect()
    }

    /// Bytes that shading reads, and that it writes.
    pub(crate) fn bytes(&self) -> [usize; 2] {
        let read = self
            .thickness
            .iter()
            .chain(&self.under)
            .map(Vec::len)
            .sum::<usize>();
        [read, 3 * TILES * TILE_CELLS].map(|values| values * size_of::<f32>())
    }
}

/// Tiles as backends take them: `paints` over `under`.
pub(crate) fn tiles<'a>(
    paints: &'a [[(usize, &'a [f32]); PAINTS]],
    under: &'a [Vec<f32>],
) -> Vec<FilmPlanes<'a>> {
    paints
        .iter()
        .zip(under)
        .map(|(paints, under)| FilmPlanes {
            paints,
            opacity: 1.0,
            under: Under::Planes(under),
        })
        .collect()
}
