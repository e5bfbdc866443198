//! Drawing of a surface into pixels: light first, then gamut and encoding.

use maulstick_canvas::tile::TileId;
use maulstick_optics::gamut::Gamut;
use maulstick_optics::light::{Facet, Lamp, SURFACE, Spot, Surroundings, lit};
use maulstick_types::paint::TILE;

use super::{Depth, Export};
use crate::bakery::Bakery;
use crate::bands::{BandHeights, Banded};
use crate::display::DisplayTile;

/// Light of a point.
pub(super) type Light = Box<dyn Fn(&Spot) -> [f32; 3] + Sync>;

/// A surface under light, for a destination.
pub struct Drawing<'a> {
    banded: Banded<'a>,
    light: Light,
    surroundings: Option<Surroundings>,
    gamut: Gamut,
    export: &'a Export,
}

/// A point on a flat surface, under a lamp of strength 1 and of this colour.
pub(super) fn flat(spot: &Spot, lamp: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| spot.unlit[i] + lamp[i] * SURFACE)
}

impl<'a> Drawing<'a> {
    /// A surface under a lamp.
    #[must_use]
    pub fn lit(banded: Banded<'a>, lamp: Lamp, export: &'a Export) -> Self {
        let surroundings = Surroundings::new(&lamp, banded.cell_m() as f32);
        let light: Light = Box::new(move |spot| lit(spot, &lamp));
        Self::new(banded, light, Some(surroundings), export)
    }

    /// A surface without relief: its colours alone, under a lamp of strength 1 and of this colour.
    #[must_use]
    pub fn flat(banded: Banded<'a>, lamp: [f32; 3], export: &'a Export) -> Self {
        let light: Light = Box::new(move |spot| flat(spot, lamp));
        Self::new(banded, light, None, export)
    }

    pub(super) fn new(
        banded: Banded<'a>,
        light: Light,
        surroundings: Option<Surroundings>,
        export: &'a Export,
    ) -> Self {
        Self {
            banded,
            light,
            surroundings,
            gamut: Gamut::new(export.gamut, export.profile.from_working()),
            export,
        }
    }

    /// The surface.
    #[must_use]
    pub fn banded(&self) -> &Banded<'a> {
        &self.banded
    }

    /// The bytes of the pixels' ICC profile.
    #[must_use]
    pub fn icc(&self) -> &'a [u8] {
        self.export.profile.icc()
    }

    /// The pixels of a band, red, green, blue, from its top row.
    #[must_use]
    pub fn band(&self, band: usize, depth: Depth) -> Vec<u8> {
        let heights = self.banded.heights_around(band);
        let mut pixels = self.blank(band, depth);
        for (id, tile) in self.banded.tiles(band) {
            let shown = self.banded.shown(id, tile, &mut Bakery::default());
            self.lay((id, &shown), Some(&heights), depth, &mut pixels);
        }
        pixels
    }

    /// The pixels of a tile without relief, within the surface, from its top row.
    #[must_use]
    pub fn tile(&self, (id, shown): (TileId, &DisplayTile), depth: Depth) -> Vec<u8> {
        let [across, rows] = self.banded.within(id);
        let row = across * depth.pixel_bytes();
        let mut pixels = vec![0; rows * row];
        for (y, pixels) in pixels.chunks_exact_mut(row).rev().enumerate() {
            let colour = |x: usize| {
                let cell = y * TILE + x;
                let spot = Spot {
                    unlit: [0, 1, 2].map(|c| shown.rgb[c][cell]),
                    gloss: shown.gloss[cell],
                    facet: Facet::LEVEL,
                };
                self.gamut.map((self.light)(&spot))
            };
            let colours: Vec<[f32; 3]> = (0..across).map(colour).collect();
            self.encode(&colours, depth, pixels);
        }
        pixels
    }

    /// Zeros for the bytes of a band.
    #[must_use]
    pub fn blank(&self, band: usize, depth: Depth) -> Vec<u8> {
        let width = self.banded.cells()[0];
        vec![0; self.banded.rows(band).len() * width * depth.pixel_bytes()]
    }

    /// Draws a tile into the pixels of its band; `heights` are those around the band, without which the surface is
    /// flat.
    pub fn lay(
        &self,
        (id, shown): (TileId, &DisplayTile),
        heights: Option<&BandHeights>,
        depth: Depth,
        band: &mut [u8],
    ) {
        let width = self.banded.cells()[0];
        let [across, rows] = self.banded.within(id);
        let left = id.x as usize * TILE;
        let mut facets = [Facet::LEVEL; TILE];
        let mut colours = [[0.0f32; 3]; TILE];
        for y in 0..rows {
            if let (Some(surroundings), Some(heights)) = (&self.surroundings, heights) {
                let place = [left, heights.first + y];
                surroundings.row(&heights.field(), place, &mut facets[..across]);
            }
            for x in 0..across {
                let cell = y * TILE + x;
                let spot = Spot {
                    unlit: [0, 1, 2].map(|c| shown.rgb[c][cell]),
                    gloss: shown.gloss[cell],
                    facet: facets[x],
                };
                colours[x] = self.gamut.map((self.light)(&spot));
            }
            let pixel = depth.pixel_bytes();
            let pixels = &mut band[((rows - 1 - y) * width + left) * pixel..][..across * pixel];
            self.encode(&colours[..across], depth, pixels);
        }
    }

    fn encode(&self, colours: &[[f32; 3]], depth: Depth, pixels: &mut [u8]) {
        let profile = &self.export.profile;
        match depth {
            Depth::Eight => profile.encode(colours, pixels),
            Depth::Sixteen => {
                let mut values = [0u16; 3 * TILE];
                let values = &mut values[..3 * colours.len()];
                profile.encode16(colours, values);
                for (bytes, value) in pixels.chunks_exact_mut(2).zip(values) {
                    bytes.copy_from_slice(&value.to_be_bytes());
                }
            }
        }
    }
}
