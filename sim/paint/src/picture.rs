//! Pictures of a surface.

use std::io::{Error, Write};

use maulstick_optics::Under;
use maulstick_optics::backend::CpuFilms;
use maulstick_optics::colour::{SrgbTable, clamp_chromaticity};
use maulstick_optics::light::{HeightField, lit};
use maulstick_types::paint::TILE;

use crate::bare::Bare;
use crate::display::{DisplayTile, WetFilms};
use crate::lamp::lamp_over;
use crate::look::{Bakery, Look};
use crate::painting::Painting;
use crate::store::TileStore;
use crate::tile::Tile;

/// An sRGB picture, three bytes a pixel from the top row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue.
    pub rgb: Vec<u8>,
}

/// What becomes of unlit colour, gloss and slope.
type Light<'a> = &'a dyn Fn([f32; 3], f32, [f32; 2]) -> [f32; 3];

/// The picture of a surface under the scene's lamp, a pixel a cell.
pub fn picture(painting: &mut Painting, surface: u32) -> Picture {
    let lamp = lamp_over(painting.scene(), surface);
    under(painting, surface, &|unlit, gloss, slope| {
        lit(unlit, gloss, slope, &lamp)
    })
}

/// The picture of a surface as if it were flat: its colours alone.
pub fn unlit_picture(painting: &mut Painting, surface: u32) -> Picture {
    under(painting, surface, &|unlit, _, _| unlit)
}

fn under(painting: &mut Painting, surface: u32, light: Light<'_>) -> Picture {
    painting.commit();
    let surfaces = &painting.scene().surfaces;
    let found = surfaces.iter().find(|other| other.id == surface);
    let (Some(cell_m), Some(store), Some(bare)) = (
        found.map(|s| s.cell_m),
        painting.store(surface),
        painting.bare(surface),
    ) else {
        return Picture {
            width: 0,
            height: 0,
            rgb: Vec::new(),
        };
    };
    draw(store, bare, painting.look(), cell_m, light)
}

/// The heights of a whole surface, m, row after row from the lowest: slopes reach over the borders
/// of tiles.
fn heights(store: &TileStore, bare: &Bare) -> Vec<f32> {
    let [width, height] = store.cells().map(|cells| cells as usize);
    let mut heights = vec![0.0f32; width * height];
    for (id, version) in store.iter() {
        let plane = DisplayTile::height_on(bare, id, version.tile.as_deref());
        let (left, bottom) = (id.x as usize * TILE, id.y as usize * TILE);
        let across = TILE.min(width - left);
        for y in 0..TILE.min(height - bottom) {
            heights[(bottom + y) * width + left..][..across]
                .copy_from_slice(&plane[y * TILE..][..across]);
        }
    }
    heights
}

/// Light first, then gamut and encoding.
fn draw(store: &TileStore, bare: &Bare, look: &Look, cell_m: f64, light: Light<'_>) -> Picture {
    let [width, height] = store.cells().map(|cells| cells as usize);
    let heights = heights(store, bare);
    let field = HeightField {
        heights: &heights,
        cells: [width, height],
        cell_m: cell_m as f32,
    };
    let mut rgb = vec![0u8; width * height * 3];
    let table = SrgbTable::default();
    for (id, version) in store.iter() {
        let tile = version.tile.as_deref();
        let dry = tile.and_then(Tile::dry);
        let baked = dry.map(|stack| {
            let over = (stack, bare.ground.as_slice());
            Bakery::default().planes((look, &mut CpuFilms::new()), 0, id, over)
        });
        let under = baked
            .as_deref()
            .map_or(Under::Even(&bare.ground), Under::Planes);
        let films = WetFilms::of(tile);
        let unlit = films.shade(&look.studio, under);
        let shown = DisplayTile::on(bare, id, tile, (&films, unlit), look.thinner);
        let (left, bottom) = (id.x as usize * TILE, id.y as usize * TILE);
        for y in 0..TILE.min(height - bottom) {
            let row = height - 1 - (bottom + y);
            for x in 0..TILE.min(width - left) {
                let cell = y * TILE + x;
                let unlit = [0, 1, 2].map(|c| shown.rgb[c][cell]);
                let slope = field.slope(left + x, bottom + y);
                let colour = clamp_chromaticity(light(unlit, shown.gloss[cell], slope));
                let pixel = &mut rgb[(row * width + left + x) * 3..][..3];
                pixel.copy_from_slice(&colour.map(|channel| table.byte(channel)));
            }
        }
    }
    Picture { width, height, rgb }
}

impl Picture {
    /// Writes a PNG: 8 bits a channel, marked as sRGB.
    ///
    /// # Errors
    /// What `to` says.
    pub fn encode_png(&self, to: impl Write) -> Result<(), Error> {
        let mut encoder = png::Encoder::new(to, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.write_header()?.write_image_data(&self.rgb)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use maulstick_optics::{PaintLibrary, Studio};

    use super::*;
    use crate::quantum::QUANTUM_M;
    use crate::relief::Relief;
    use crate::tile::Version;

    const CELLS: [u32; 2] = [150, 70];
    const CELL_M: f64 = 2.5e-4;

    /// Film whose thickness in quanta is a function of the place.
    fn store(quanta: impl Fn(usize, usize) -> f32) -> TileStore {
        let mut store = TileStore::new(CELLS);
        let ids: Vec<_> = store.iter().map(|(id, _)| id).collect();
        for id in ids {
            let place = |i: usize| {
                quanta(
                    id.x as usize * TILE + i % TILE,
                    id.y as usize * TILE + i / TILE,
                )
            };
            let plane: Arc<[f32]> = (0..TILE * TILE).map(place).collect();
            let tile = Some(Arc::new(Tile::new([(0, plane)].into_iter(), None)));
            store.replace(id, Version { number: 2, tile });
        }
        store
    }

    fn studio() -> Studio {
        let mut studio = Studio::daylight();
        let library = PaintLibrary::measured().expect("whole");
        studio.add(library.find("Ultramarine Blue").expect("known"));
        studio
    }

    fn drawn(store: &TileStore, light: Light<'_>) -> Picture {
        let studio = studio();
        let ground = vec![0.95; studio.wavelengths()];
        let bare = Bare {
            ground,
            relief: Arc::new(Relief::flat(CELL_M)),
            wells: Vec::new(),
        };
        draw(store, &bare, &Look::new(studio), CELL_M, light)
    }

    #[test]
    fn slopes_go_on_over_the_borders_of_tiles() {
        const BEND: f32 = 40.0;
        let bowl = store(|x, y| BEND * (x * x + y * y) as f32);
        // Slope as a colour: in a paraboloid it grows by the same amount with every cell.
        let scale = (CELL_M / QUANTUM_M) as f32 / (2.0 * BEND * 150.0);
        let shown = drawn(&bowl, &|_, _, slope| {
            [slope[0] * scale, slope[1] * scale, 0.0]
        });
        let table = SrgbTable::default();
        let expected = |x: usize, y: usize| {
            let inside = |at: usize, size: u32| at > 0 && at + 1 < size as usize;
            (inside(x, CELLS[0]) && inside(y, CELLS[1]))
                .then(|| [x, y].map(|at| table.byte(at as f32 / 150.0)))
        };
        let off = |shown: &Picture| {
            let mut worst = 0;
            for (i, pixel) in shown.rgb.chunks_exact(3).enumerate() {
                let (x, y) = (i % shown.width, shown.height - 1 - i / shown.width);
                for (got, want) in expected(x, y).iter().flatten().zip(pixel) {
                    worst = worst.max(got.abs_diff(*want));
                }
            }
            worst
        };
        assert!(off(&shown) <= 1, "{}", off(&shown));
        let torn = store(|x, y| BEND * (x * x + y * y) as f32 + f32::from(x as u16 / 64) * 2000.0);
        let shown = drawn(&torn, &|_, _, slope| {
            [slope[0] * scale, slope[1] * scale, 0.0]
        });
        assert!(off(&shown) > 1, "a seam would pass");
    }

    #[test]
    fn a_flat_film_is_lit_to_its_unlit_colour_and_a_ridge_is_not() {
        let lamp = maulstick_optics::light::Lamp::new([-0.5, 0.5, 0.5f64.sqrt()], 1.0);
        let both = |store: &TileStore| {
            let lit = drawn(store, &|unlit, gloss, slope| {
                lit(unlit, gloss, slope, &lamp)
            });
            (lit, drawn(store, &|unlit, _, _| unlit))
        };
        let (flat, unlit) = both(&store(|_, _| 50_000.0));
        assert!(flat == unlit);
        let (ridge, unlit) = both(&store(|x, _| {
            50_000.0 + if x == 64 { 40_000.0 } else { 0.0 }
        }));
        let sum = |picture: &Picture, x: usize| -> u32 {
            let pixel = &picture.rgb[(30 * picture.width + x) * 3..][..3];
            pixel.iter().map(|channel| u32::from(*channel)).sum()
        };
        assert!(
            sum(&ridge, 63) > sum(&unlit, 63),
            "the flank toward the lamp"
        );
        assert!(sum(&ridge, 65) < sum(&unlit, 65), "the flank away from it");
    }
}
