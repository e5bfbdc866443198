//! Tiles in the layout of the shaders.

use bytemuck::{Pod, Zeroable, cast_slice};
use maulstick_optics::backend::TILE_CELLS;
use maulstick_optics::{FilmPlanes, Studio, Under};

/// `Tile` of films.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct TileRecord {
    paints: u32,
    thickness: u32,
    optics: u32,
    under: u32,
    under_sample: u32,
    under_cell: u32,
}

/// Number of wavelengths that a shader computes together.
const QUAD: usize = 4;

/// Inputs of a stage, as concatenated parts of buffers.
pub(crate) struct Batch<'a> {
    records: Vec<TileRecord>,
    optics: Vec<[f32; QUAD]>,
    /// Planes of thickness.
    pub(crate) thickness: Vec<&'a [u8]>,
    /// Reflectance of the ground under the films.
    pub(crate) under: Vec<&'a [u8]>,
}

impl<'a> Batch<'a> {
    /// A batch of all `tiles`, which fit the studio.
    pub(crate) fn new(studio: &Studio, tiles: &[FilmPlanes<'a>]) -> Self {
        let samples = studio.wavelengths();
        let quads = (0..samples).step_by(QUAD);
        let mut optics: Vec<[f32; QUAD]> = Vec::new();
        for quad in quads.clone() {
            optics.extend([0, 1, 2].map(|channel| {
                let weight =
                    |i: usize| studio.primaries().get(quad + i).map_or(0.0, |w| w[channel]);
                std::array::from_fn::<f32, QUAD, _>(weight)
            }));
        }
        let mut batch = Self {
            records: Vec::with_capacity(tiles.len()),
            optics: Vec::new(),
            thickness: Vec::new(),
            under: Vec::new(),
        };
        let (mut planes, mut reflectances) = (0, 0);
        for films in tiles {
            let (under, [under_sample, under_cell]) = match films.under {
                Under::Even(values) => (values, [1, 0]),
                Under::Planes(values) => (values, [TILE_CELLS as u32, 1]),
            };
            batch.records.push(TileRecord {
                paints: films.paints.len() as u32,
                thickness: (planes * TILE_CELLS) as u32,
                optics: optics.len() as u32,
                under: reflectances as u32,
                under_sample,
                under_cell,
            });
            batch.under.push(cast_slice(under));
            reflectances += under.len();
            planes += films.paints.len();
            let thickness = films.paints.iter();
            batch
                .thickness
                .extend(thickness.map(|(_, plane)| cast_slice::<f32, u8>(plane)));
            for quad in quads.clone() {
                for (slot, _) in films.paints {
                    let table = studio.paint(*slot);
                    optics.extend([0, 1].map(|which| {
                        let per_m = |i: usize| {
                            table
                                .get(quad + i)
                                .map_or(0.0, |ks| ks[which] * films.opacity)
                        };
                        std::array::from_fn::<f32, QUAD, _>(per_m)
                    }));
                }
            }
        }
        batch.optics = optics;
        batch
    }

    /// Offsets of each tile's parts.
    pub(crate) fn records(&self) -> &[u8] {
        cast_slice(&self.records)
    }

    /// Primaries, absorption K and scattering S.
    pub(crate) fn optics(&self) -> &[u8] {
        cast_slice(&self.optics)
    }
}

/// Size in bytes of the largest buffer that a tile uses, for a stage with `planes` output planes.
fn largest(studio: &Studio, films: &FilmPlanes<'_>, planes: usize) -> usize {
    let under = match films.under {
        Under::Even(_) => 0,
        Under::Planes(_) => studio.wavelengths(),
    };
    planes.max(films.paints.len()).max(under) * TILE_CELLS * size_of::<f32>()
}

/// Number of leading `tiles` that fit buffers of `bytes`, at least one.
pub(crate) fn fitting(
    studio: &Studio,
    tiles: &[FilmPlanes<'_>],
    planes: usize,
    bytes: usize,
) -> usize {
    let mut sum = 0;
    let fits = |films: &&FilmPlanes<'_>| {
        sum += largest(studio, films, planes);
        sum <= bytes
    };
    tiles.iter().take_while(fits).count().max(1)
}
