//! Pictures of a surface.

use std::fmt;
use std::io::{Error, Write};
use std::num::NonZero;
use std::sync::Arc;

use maulstick_optics::Under;
use maulstick_optics::backend::CpuFilms;
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::{Gamut, GamutMapping};
use maulstick_optics::icc::Profile;
use maulstick_optics::light::shadow::Shadows;
use maulstick_optics::light::{HeightField, SURFACE, Spot, lit};
use maulstick_types::paint::TILE;

use crate::bare::Bare;
use crate::display::{DisplayTile, WetFilms};
use crate::lamp::lamp_over;
use crate::look::{Bakery, Look};
use crate::painting::Painting;
use crate::store::TileStore;
use crate::tile::{Tile, TileId, Version};

/// Threads that draw a picture: the stepper and its worker have the other cores.
const THREADS: usize = 2;

/// How a picture leaves the working space.
#[derive(Clone, Debug)]
pub struct Export {
    /// Where it goes.
    pub profile: Arc<Profile>,
    /// How its colours come into the gamut there.
    pub gamut: GamutMapping,
}

impl Default for Export {
    fn default() -> Self {
        Self {
            profile: Arc::new(Profile::of(RgbSpace::Srgb)),
            gamut: GamutMapping::default(),
        }
    }
}

/// A picture, three bytes a pixel from the top row.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue.
    pub rgb: Vec<u8>,
    /// The ICC profile that says what they mean.
    pub icc: Vec<u8>,
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Picture")
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

/// What becomes of a point.
type Light<'a> = &'a (dyn Fn(&Spot) -> [f32; 3] + Sync);

/// What is drawn, and how.
struct View<'a> {
    light: Light<'a>,
    shadows: Option<Shadows>,
    export: &'a Export,
}

/// The picture of a surface under the scene's lamp, a pixel a cell, in sRGB.
pub fn picture(painting: &mut Painting, surface: u32) -> Picture {
    picture_for(painting, surface, &Export::default())
}

/// The picture of a surface under the scene's lamp, a pixel a cell.
pub fn picture_for(painting: &mut Painting, surface: u32, export: &Export) -> Picture {
    let lamp = lamp_over(painting.scene(), surface);
    let light: Light<'_> = &|spot| lit(spot, &lamp);
    under(painting, surface, |cell_m| View {
        light,
        shadows: Some(Shadows::new(&lamp, cell_m)),
        export,
    })
}

/// A point as if the surface were flat there, under a lamp of strength 1 and of this colour.
fn flat(spot: &Spot, lamp: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| spot.unlit[i] + lamp[i] * SURFACE)
}

/// The picture of a surface as if it were flat: its colours alone.
pub fn unlit_picture(painting: &mut Painting, surface: u32) -> Picture {
    let export = Export::default();
    let lamp = lamp_over(painting.scene(), surface).colour;
    let light: Light<'_> = &|spot| flat(spot, lamp);
    under(painting, surface, |_| View {
        light,
        shadows: None,
        export: &export,
    })
}

fn under<'a>(painting: &mut Painting, surface: u32, view: impl FnOnce(f32) -> View<'a>) -> Picture {
    painting.commit();
    let surfaces = &painting.scene().surfaces;
    let found = surfaces.iter().find(|other| other.id == surface);
    let (Some(cell_m), Some(store), Some(bare)) = (
        found.map(|s| s.cell_m),
        painting.store(surface),
        painting.bare(surface),
    ) else {
        return Picture::srgb(0, 0, Vec::new());
    };
    let view = view(cell_m as f32);
    draw(store, bare, painting.look(), cell_m, &view)
}

/// The heights of a whole surface, m, row after row from the lowest: slopes and shadows reach over
/// the borders of tiles.
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

/// The pixels of a row of tiles, and the tiles.
type Band<'a> = (&'a mut [u8], Vec<(TileId, &'a Version)>);

/// Light first, then gamut and encoding.
fn draw(store: &TileStore, bare: &Bare, look: &Look, cell_m: f64, view: &View<'_>) -> Picture {
    let [width, height] = store.cells().map(|cells| cells as usize);
    let heights = heights(store, bare);
    let profile = &view.export.profile;
    let canvas = Canvas {
        field: HeightField {
            heights: &heights,
            cells: [width, height],
            cell_m: cell_m as f32,
        },
        gamut: Gamut::new(view.export.gamut, profile.from_working()),
        view,
    };
    let mut rgb = vec![0u8; width * height * 3];
    let mut bands: Vec<Band<'_>> = rgb
        // The lowest row of tiles is at the end of the picture.
        .rchunks_mut((TILE * width * 3).max(1))
        .map(|band| (band, Vec::new()))
        .collect();
    for (id, version) in store.iter() {
        bands[id.y as usize].1.push((id, version));
    }
    let share = bands.len().div_ceil(THREADS).max(1);
    std::thread::scope(|scope| {
        for bands in bands.chunks_mut(share) {
            let canvas = &canvas;
            scope.spawn(move || {
                for (band, tiles) in bands {
                    for (id, version) in tiles {
                        let shown = shown(bare, *id, version.tile.as_deref(), look);
                        canvas.lay(*id, &shown, band);
                    }
                }
            });
        }
    });
    Picture {
        width,
        height,
        rgb,
        icc: profile.icc().to_vec(),
    }
}

/// A tile before light, by this thread alone.
fn shown(bare: &Bare, id: TileId, tile: Option<&Tile>, look: &Look) -> DisplayTile {
    let baked = tile.and_then(Tile::dry).map(|stack| {
        let mut alone = CpuFilms::with_threads(NonZero::<usize>::MIN);
        let over = (stack, bare.ground.as_slice());
        Bakery::default().planes((look, &mut alone), 0, id, over)
    });
    let under = baked
        .as_deref()
        .map_or(Under::Even(&bare.ground), Under::Planes);
    let films = WetFilms::of(tile);
    let unlit = films.shade(&look.studio, under);
    DisplayTile::on(bare, id, tile, (&films, unlit), look.thinner)
}

/// A surface under light.
struct Canvas<'a> {
    field: HeightField<'a>,
    gamut: Gamut,
    view: &'a View<'a>,
}

impl Canvas<'_> {
    /// Draws a tile into the pixels of its row of tiles.
    fn lay(&self, id: TileId, shown: &DisplayTile, band: &mut [u8]) {
        let [width, height] = self.field.cells;
        let (left, bottom) = (id.x as usize * TILE, id.y as usize * TILE);
        let across = TILE.min(width - left);
        let rows = TILE.min(height - bottom);
        let mut seen = [1.0f32; TILE];
        let mut colours = [[0.0f32; 3]; TILE];
        for y in 0..rows {
            if let Some(shadows) = &self.view.shadows {
                shadows.row(&self.field, [left, bottom + y], &mut seen[..across]);
            }
            for x in 0..across {
                let cell = y * TILE + x;
                let spot = Spot {
                    unlit: [0, 1, 2].map(|c| shown.rgb[c][cell]),
                    gloss: shown.gloss[cell],
                    slope: self.field.slope(left + x, bottom + y),
                    seen: seen[x],
                };
                colours[x] = self.gamut.map((self.view.light)(&spot));
            }
            let pixels = &mut band[((rows - 1 - y) * width + left) * 3..][..across * 3];
            let profile = &self.view.export.profile;
            profile.encode(&colours[..across], pixels);
        }
    }
}

impl Picture {
    /// A picture of sRGB bytes.
    #[must_use]
    pub fn srgb(width: usize, height: usize, rgb: Vec<u8>) -> Self {
        let icc = Profile::of(RgbSpace::Srgb).icc().to_vec();
        Self {
            width,
            height,
            rgb,
            icc,
        }
    }

    /// Writes a PNG: 8 bits a channel, with its profile.
    ///
    /// # Errors
    /// What `to` says.
    pub fn encode_png(&self, to: impl Write) -> Result<(), Error> {
        let mut info = png::Info::with_size(self.width as u32, self.height as u32);
        info.color_type = png::ColorType::Rgb;
        info.bit_depth = png::BitDepth::Eight;
        info.icc_profile = Some(self.icc.as_slice().into());
        let encoder = png::Encoder::with_info(to, info)?;
        encoder.write_header()?.write_image_data(&self.rgb)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use maulstick_optics::colour::SrgbTable;
    use maulstick_optics::light::{Lamp, LampSetup};
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

    fn bare(studio: &Studio) -> Bare {
        Bare {
            ground: vec![0.95; studio.wavelengths()],
            relief: Arc::new(Relief::flat(CELL_M)),
            wells: Vec::new(),
        }
    }

    fn drawn(store: &TileStore, light: Light<'_>, shadows: Option<Shadows>) -> Picture {
        let studio = studio();
        let bare = bare(&studio);
        let view = View {
            light,
            shadows,
            export: &Export {
                gamut: GamutMapping::Clamp,
                ..Default::default()
            },
        };
        draw(store, &bare, &Look::new(studio), CELL_M, &view)
    }

    fn upper_left() -> Lamp {
        Lamp::new(&LampSetup {
            toward: [-0.5, 0.5, 0.5f64.sqrt()],
            ..Default::default()
        })
    }

    #[test]
    fn slopes_go_on_over_the_borders_of_tiles() {
        const BEND: f32 = 40.0;
        let bowl = store(|x, y| BEND * (x * x + y * y) as f32);
        // Slope as a colour: in a paraboloid it grows by the same amount with every cell.
        let scale = (CELL_M / QUANTUM_M) as f32 / (2.0 * BEND * 150.0);
        let light: Light<'_> = &|spot| [spot.slope[0] * scale, spot.slope[1] * scale, 0.0];
        let shown = drawn(&bowl, light, None);
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
        let shown = drawn(&torn, light, None);
        assert!(off(&shown) > 1, "a seam would pass");
    }

    #[test]
    fn a_flat_film_is_lit_to_its_unlit_colour_and_a_ridge_is_not() {
        let lamp = upper_left();
        let both = |store: &TileStore| {
            let shadows = Some(Shadows::new(&lamp, CELL_M as f32));
            let lit = drawn(store, &|spot| lit(spot, &lamp), shadows);
            (lit, drawn(store, &|spot| flat(spot, [1.0; 3]), None))
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

    #[test]
    fn shadows_fall_over_the_borders_of_tiles() {
        // A wall of one millimetre across the corner where four tiles meet.
        let wall = store(|x, y| {
            let across = (60..64).contains(&(x + 64 - y.min(64)));
            50_000.0 + if across { 660_000.0 } else { 0.0 }
        });
        let lamp = upper_left();
        let whole = HeightField {
            heights: &heights(&wall, &bare(&studio())),
            cells: CELLS.map(|cells| cells as usize),
            cell_m: CELL_M as f32,
        };
        let shadows = Shadows::new(&lamp, CELL_M as f32);
        let shown = drawn(&wall, &|spot| [spot.seen; 3], Some(shadows));
        let table = SrgbTable::default();
        let mut dark = 0;
        for (i, pixel) in shown.rgb.chunks_exact(3).enumerate() {
            let (x, y) = (i % shown.width, shown.height - 1 - i / shown.width);
            let mut seen = [0.0];
            shadows.row(&whole, [x, y], &mut seen);
            assert_eq!(pixel[0], table.byte(seen[0]), "{x} {y}");
            dark += u32::from(pixel[0] < 128);
        }
        assert!(dark > 50, "{dark}");
    }

    #[test]
    fn a_png_says_what_its_bytes_mean() {
        let wide = Export {
            profile: Arc::new(Profile::of(RgbSpace::DisplayP3)),
            gamut: GamutMapping::Soft,
        };
        let mut painting = Painting::new(
            &crate::PaintingSetup {
                cells: [8, 8],
                ..Default::default()
            },
            PaintLibrary::measured().expect("whole"),
        )
        .expect("a painting");
        let profiles = [Export::default(), wide].map(|export| {
            let picture = picture_for(&mut painting, maulstick_types::scene::CANVAS, &export);
            let mut file = Vec::new();
            picture.encode_png(&mut file).expect("written");
            let decoder = png::Decoder::new(std::io::Cursor::new(file));
            let reader = decoder.read_info().expect("a PNG");
            let icc = reader.info().icc_profile.as_ref().map(|icc| icc.to_vec());
            assert_eq!(icc.as_deref(), Some(export.profile.icc()));
            icc
        });
        assert!(profiles[0] != profiles[1]);
    }
}
