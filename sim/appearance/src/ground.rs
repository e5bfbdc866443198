//! Ground of a surface: one reflectance everywhere, or a printed picture.

use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use maulstick_canvas::assets::{Assets, Colours, IMAGE, SPECTRUM, hash_of};
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::tile::TileId;
use maulstick_optics::colour::{SrgbTable, srgb_decode};
use maulstick_optics::{Reflectance, Smooth, Spectrum, Studio, Under, Upsampler};
use maulstick_types::paint::TILE;

use crate::error::LookError;

/// Grounds by name: internal reflectance, equal at every wavelength. Acrylic gesso is titanium white and chalk in a
/// lean binder.
pub const GROUNDS: [(&str, f64); 3] = [("gesso", 0.95), ("grey", 0.35), ("black", 0.03)];

/// Limit of the cached tile reflectances, bytes; a tile at sixteen wavelengths takes 256 KiB.
const KEPT_BYTES: usize = 64 << 20;
/// Limit on the number of colours with cached reflectance.
const KEPT_COLOURS: usize = 1 << 20;

/// The ground of a surface, at the wavelengths of one studio.
#[derive(Clone, Debug)]
pub enum Ground {
    /// Internal reflectance, a value a wavelength.
    Even(Vec<f32>),
    /// Colours and heights from a picture.
    Picture(Arc<PictureGround>),
}

/// The ground of a tile.
#[derive(Clone, Debug)]
pub enum GroundTile<'a> {
    /// Internal reflectance, a value a wavelength.
    Even(&'a [f32]),
    /// A plane of cells a wavelength, one after the other.
    Planes(Arc<[f32]>),
}

impl GroundTile<'_> {
    /// The ground as input of the films.
    #[must_use]
    pub fn under(&self) -> Under<'_> {
        match self {
            Self::Even(values) => Under::Even(values),
            Self::Planes(planes) => Under::Planes(planes),
        }
    }
}

impl Ground {
    /// The ground called `name` of a surface of `cells`: one of [`GROUNDS`], or `image:` and the hash of a picture,
    /// which covers the surface, or `spectrum:` and the hash of a measured reflectance, which is uniform.
    ///
    /// # Errors
    /// [`LookError`] for an unknown name.
    pub fn called(
        name: &str,
        cells: [u32; 2],
        studio: &Studio,
        embedded: &Assets,
    ) -> Result<Self, LookError> {
        if let Some(hash) = name.strip_prefix(SPECTRUM) {
            let internal = spectrum(embedded, hash)?.internal(&studio.surface());
            return Ok(Self::Even(studio.sample(&internal)));
        }
        let Some(hash) = name.strip_prefix(IMAGE) else {
            return Ok(Self::Even(studio.sample(&ground_reflectance(name)?)));
        };
        let picture = PictureGround::new(embedded.colours(hash)?, cells, studio);
        Ok(Self::Picture(Arc::new(picture)))
    }

    /// Mean internal reflectance, a value a wavelength; for a picture, that of its mean colour.
    #[must_use]
    pub fn mean(&self) -> &[f32] {
        match self {
            Self::Even(values) => values,
            Self::Picture(picture) => &picture.mean,
        }
    }

    /// The ground of a tile.
    #[must_use]
    pub fn tile(&self, id: TileId) -> GroundTile<'_> {
        match self {
            Self::Even(values) => GroundTile::Even(values),
            Self::Picture(picture) => GroundTile::Planes(picture.tile(id)),
        }
    }
}

/// A picture that covers a surface, and its reflectances.
pub struct PictureGround {
    pixels: Arc<Colours>,
    cells: [u32; 2],
    upsampler: Upsampler,
    mean: Vec<f32>,
    tables: Tables,
    colours: Mutex<HashMap<[u8; 3], Smooth>>,
    tiles: Mutex<BTreeMap<TileId, Arc<[f32]>>>,
}

/// Tables from sRGB bytes to linear light and back.
struct Tables {
    linear: Vec<f32>,
    bytes: SrgbTable,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn linear(rgb: [u8; 3]) -> [f64; 3] {
    rgb.map(|byte| srgb_decode(f64::from(byte) / 255.0))
}

impl PictureGround {
    fn new(pixels: Arc<Colours>, cells: [u32; 2], studio: &Studio) -> Self {
        let upsampler = Upsampler::new(studio);
        let table: [f64; 256] = std::array::from_fn(|i| linear([i as u8; 3])[0]);
        let mut counts = [[0u64; 256]; 3];
        for rgb in &pixels.values {
            (0..3).for_each(|i| counts[i][rgb[i] as usize] += 1);
        }
        let mean = counts.map(|counts| {
            let sum: f64 = counts.iter().zip(table).map(|(n, v)| *n as f64 * v).sum();
            sum / pixels.values.len().max(1) as f64
        });
        let mean = upsampler.even(upsampler.fit(mean));
        Self {
            pixels,
            cells,
            upsampler,
            mean,
            tables: Tables {
                linear: table.iter().map(|value| *value as f32).collect(),
                bytes: SrgbTable::default(),
            },
            colours: Mutex::default(),
            tiles: Mutex::default(),
        }
    }

    /// Colours of a tile's cells, encoded sRGB, row by row from the bottom. Beyond the surface the edge's colours
    /// continue.
    #[must_use]
    pub fn colours(&self, id: TileId) -> Vec<[u8; 3]> {
        let cell = |i: usize| {
            [
                id.x as usize * TILE + i % TILE,
                id.y as usize * TILE + i / TILE,
            ]
        };
        let [across, up] = self.cells.map(|cells| cells as usize);
        let own = (self.pixels.width, self.pixels.height) == (across, up);
        let at = |i: usize| {
            let [x, y] = cell(i);
            if own {
                self.pixels.values[y.min(up - 1) * across + x.min(across - 1)]
            } else {
                self.between([x, y])
            }
        };
        (0..TILE_CELLS).map(at).collect()
    }

    /// The colour in the middle of a cell, linear between the pixels around it.
    fn between(&self, cell: [usize; 2]) -> [u8; 3] {
        let pixels = [self.pixels.width, self.pixels.height];
        let place = |i: usize| {
            let share = (cell[i] as f64 + 0.5) / f64::from(self.cells[i]);
            let last = (pixels[i] - 1) as f64;
            let at = (share * pixels[i] as f64 - 0.5).clamp(0.0, last);
            let low = at as usize;
            (low, (low + 1).min(pixels[i] - 1), (at - low as f64) as f32)
        };
        let ((left, right, u), (low, high, v)) = (place(0), place(1));
        let at = |x: usize, y: usize, c: usize| {
            let byte = self.pixels.values[y * pixels[0] + x][c];
            self.tables.linear[byte as usize]
        };
        std::array::from_fn(|c| {
            let row = |y: usize| (1.0 - u) * at(left, y, c) + u * at(right, y, c);
            self.tables.bytes.byte((1.0 - v) * row(low) + v * row(high))
        })
    }

    /// Internal reflectance of a surface of this colour, encoded sRGB: a value a wavelength.
    #[must_use]
    pub fn reflectance(&self, rgb: [u8; 3]) -> Vec<f32> {
        self.upsampler.even(self.upsampler.fit(linear(rgb)))
    }

    fn tile(&self, id: TileId) -> Arc<[f32]> {
        if let Some(planes) = locked(&self.tiles).get(&id) {
            return Arc::clone(planes);
        }
        let colours = self.colours(id);
        let smooth = self.smooth(&colours);
        let mut planes = vec![0.0; self.upsampler.wavelengths() * TILE_CELLS];
        for (sample, plane) in planes.chunks_exact_mut(TILE_CELLS).enumerate() {
            self.upsampler.internal(sample, &smooth, plane);
        }
        let planes: Arc<[f32]> = planes.into();
        let mut tiles = locked(&self.tiles);
        if (tiles.len() + 1) * size_of_val(&*planes) > KEPT_BYTES {
            tiles.pop_first();
        }
        tiles.insert(id, Arc::clone(&planes));
        planes
    }

    /// The reflectance of each colour, fitted without a lock, because several threads draw.
    fn smooth(&self, colours: &[[u8; 3]]) -> Vec<Smooth> {
        let mut distinct = colours.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        let known: Vec<Option<Smooth>> = {
            let kept = locked(&self.colours);
            distinct.iter().map(|rgb| kept.get(rgb).copied()).collect()
        };
        let fitted: Vec<Smooth> = distinct
            .iter()
            .zip(&known)
            .map(|(rgb, known)| known.unwrap_or_else(|| self.upsampler.fit(linear(*rgb))))
            .collect();
        let mut kept = locked(&self.colours);
        if kept.len() + distinct.len() > KEPT_COLOURS {
            kept.clear();
        }
        kept.extend(distinct.iter().copied().zip(fitted.iter().copied()));
        drop(kept);
        let place = |rgb: &[u8; 3]| distinct.binary_search(rgb).unwrap_or(0);
        colours.iter().map(|rgb| fitted[place(rgb)]).collect()
    }
}

impl fmt::Debug for PictureGround {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PictureGround")
            .field("width", &self.pixels.width)
            .field("height", &self.pixels.height)
            .finish_non_exhaustive()
    }
}

/// Checks that a ground called `name` exists.
///
/// # Errors
/// [`LookError`] with what there is.
pub fn check_ground(name: &str, embedded: &Assets) -> Result<(), LookError> {
    if let Some(hash) = name.strip_prefix(SPECTRUM) {
        return spectrum(embedded, hash).map(drop);
    }
    if let Some(hash) = name.strip_prefix(IMAGE) {
        embedded.colours(hash)?;
        return Ok(());
    }
    ground_reflectance(name).map(drop)
}

/// The internal reflectance of a uniform ground.
///
/// # Errors
/// [`LookError`] with the names that there are.
pub(crate) fn ground_reflectance(name: &str) -> Result<Spectrum, LookError> {
    GROUNDS
        .iter()
        .find(|(ground, _)| *ground == name)
        .map(|(_, reflectance)| Spectrum::flat(*reflectance))
        .ok_or_else(|| LookError::NoGround {
            name: name.to_owned(),
            known: GROUNDS.map(|(ground, _)| ground).to_vec(),
        })
}

/// Reads a table of nm,reflectance.
fn parsed(bytes: &[u8]) -> Result<Reflectance, LookError> {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    Ok(Reflectance::parse(text.trim_start_matches('\u{feff}'))?)
}

/// Adds a spectrum and returns its hash.
///
/// # Errors
/// [`LookError`] with the line where the text is no table of reflectances.
pub fn add_spectrum(embedded: &mut Assets, text: &str) -> Result<String, LookError> {
    parsed(text.as_bytes())?;
    let bytes: Arc<[u8]> = text.as_bytes().into();
    let hash = hash_of(&bytes);
    embedded.know(hash.clone(), bytes);
    Ok(hash)
}

/// The reflectances of a spectrum.
///
/// # Errors
/// [`LookError`] if no file has this hash, or it is a picture's.
pub fn spectrum(embedded: &Assets, hash: &str) -> Result<Reflectance, LookError> {
    parsed(embedded.bytes(hash)?)
}

#[cfg(test)]
mod tests {
    use maulstick_optics::backend::CpuFilms;
    use maulstick_optics::colour::{delta_e_2000, inverse, lab};
    use maulstick_optics::{FilmBackend as _, FilmPlanes, PaintLibrary, StudioSettings};

    use super::*;

    /// A PNG of 8-bit colours, these rows from the top.
    fn png_of([width, height]: [u32; 2], raw: &[u8]) -> Arc<[u8]> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(raw).expect("pixels");
        writer.finish().expect("whole");
        bytes.into()
    }

    fn studio() -> Studio {
        let library = PaintLibrary::measured().expect("whole");
        Studio::new(&StudioSettings::default(), library.paints())
    }

    /// A ground from a picture of this size whose pixels are a function of column and row from the top.
    fn ground(size: [u32; 2], cells: [u32; 2], of: impl Fn(u32, u32) -> [u8; 3]) -> Ground {
        let raw: Vec<u8> = (0..size[1])
            .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
            .flat_map(|(x, y)| of(x, y))
            .collect();
        let png = png_of(size, &raw);
        let mut embedded = Assets::default();
        let hash = embedded.add(png).expect("taken");
        let name = format!("{IMAGE}{hash}");
        Ground::called(&name, cells, &studio(), &embedded).expect("a ground")
    }

    /// ΔE₀₀ between a bare cell's flat display, gloss included, and sRGB bytes.
    fn off(ground: &Ground, id: TileId, cell: usize, rgb: [u8; 3]) -> f64 {
        let studio = studio();
        let tile = ground.tile(id);
        let films = FilmPlanes {
            paints: &[],
            opacity: 1.0,
            under: tile.under(),
        };
        let shaded = CpuFilms::new().shade(&studio, &[films]).expect("shaded");
        let k1 = studio.surface().k1;
        let shown = [0, 1, 2].map(|c| f64::from(shaded[0][c][cell]) + k1);
        let from_rgb = inverse(studio.to_rgb());
        let lab = |rgb| {
            lab(
                maulstick_optics::colour::apply(&from_rgb, rgb),
                studio.white(),
            )
        };
        delta_e_2000(lab(shown), lab(linear(rgb)))
    }

    #[test]
    fn a_cell_has_its_pixels_colour() {
        let of = |x: u32, y: u32| [60 + (x * 2) as u8, 200 - (y * 2) as u8, 90 + (x + y) as u8];
        let ground = ground([80, 70], [80, 70], of);
        let mut worst = 0.0f64;
        for (id, cell, at) in [
            (TileId { x: 0, y: 0 }, 0, [0, 69]),
            (TileId { x: 0, y: 0 }, TILE * 3 + 40, [40, 66]),
            (TileId { x: 1, y: 1 }, TILE * 5 + 15, [79, 0]),
        ] {
            worst = worst.max(off(&ground, id, cell, of(at[0], at[1])));
            let faulty = off(&ground, id, cell, of(at[0], at[1]).map(|byte| byte + 4));
            assert!(faulty > 0.5, "a fault would pass: {faulty}");
        }
        println!("worst {worst:.4}");
        assert!(worst < 0.5);
    }

    #[test]
    fn a_smaller_picture_is_stretched_and_its_mean_is_that_of_its_light() {
        let of = |x: u32, _| if x == 0 { [255; 3] } else { [60; 3] };
        let ground = ground([2, 1], [64, 64], of);
        let Ground::Picture(picture) = &ground else {
            panic!("a picture")
        };
        let colours = picture.colours(TileId { x: 0, y: 0 });
        let row = &colours[..TILE];
        assert_eq!((row[0], row[16], row[63]), ([255; 3], [253; 3], [60; 3]));
        assert!(row.windows(2).all(|two| two[0] >= two[1]));
        let half = 0.5 * (1.0 + linear([60; 3])[0]);
        let expected = studio().surface().internal(half) as f32;
        let worst = ground.mean().iter().map(|r| (r - expected).abs());
        assert!(worst.fold(0.0, f32::max) < 2e-3, "{:?}", ground.mean());
        assert_eq!(picture.tile(TileId { x: 0, y: 0 }).len() % TILE_CELLS, 0);
    }
}
