//! A tooth made from a picture: white is at the height of the highest peaks, black at the given depth below.
//!
//! Its name gives its width and depth: `image:<hash>@120mm,80um` is a picture 120 mm wide, from its lower left corner
//! on the surface's, which repeats beyond its edges, 80 µm deep.

use std::fmt;
use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::assets::{Assets, Heights, IMAGE};
use crate::error::CanvasError;
use crate::planes::TILE_CELLS;
use crate::tile::TileId;

/// Range of a picture's width on a surface, mm.
pub const WIDTH_MM: std::ops::RangeInclusive<f64> = 1.0..=10_000.0;
/// Range of its depth, µm.
pub const DEPTH_UM: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// Parts of the name of such a tooth.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothName {
    /// Hash of the picture.
    pub hash: String,
    /// Width of the picture on the surface, mm.
    pub width_mm: f64,
    /// Depth of black below white, µm.
    pub depth_um: f64,
}

impl fmt::Display for ToothName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            hash,
            width_mm,
            depth_um,
        } = self;
        write!(f, "{IMAGE}{hash}@{width_mm}mm,{depth_um}um")
    }
}

impl ToothName {
    /// Parses a name that begins with [`IMAGE`].
    ///
    /// # Errors
    /// [`CanvasError`] with what is wrong with it.
    pub fn parse(name: &str) -> Result<Self, CanvasError> {
        let wrong = |fault| CanvasError::ToothName {
            name: name.to_owned(),
            fault,
        };
        let rest = name
            .strip_prefix(IMAGE)
            .ok_or_else(|| wrong("it is no image"))?;
        let (hash, size) = rest
            .split_once('@')
            .ok_or_else(|| wrong("it does not say how large the picture is"))?;
        let (width, depth) = size
            .split_once(',')
            .ok_or_else(|| wrong("it does not say how deep the picture is"))?;
        let number = |text: &str, unit: &str| text.strip_suffix(unit)?.parse::<f64>().ok();
        let width_mm = number(width, "mm").filter(|mm| WIDTH_MM.contains(mm));
        let depth_um = number(depth, "um").filter(|um| DEPTH_UM.contains(um));
        Ok(Self {
            hash: hash.to_owned(),
            width_mm: width_mm.ok_or_else(|| wrong("its width is not 1 to 10000 mm"))?,
            depth_um: depth_um.ok_or_else(|| wrong("its depth is not 1 to 1000 um"))?,
        })
    }
}

/// Tooth of one surface.
#[derive(Clone, Debug)]
pub struct PictureTooth {
    pixels: Arc<Heights>,
    /// Pixels per metre.
    pixels_per_m: f64,
    depth_m: f64,
    cell_m: f64,
}

impl PictureTooth {
    /// The tooth called `name` on cells of `cell_m`.
    ///
    /// # Errors
    /// [`CanvasError`] where the name is wrong, or there is no such picture.
    pub fn called(name: &str, cell_m: f64, embedded: &Assets) -> Result<Self, CanvasError> {
        let name = ToothName::parse(name)?;
        let pixels = embedded.heights(&name.hash)?;
        Ok(Self {
            pixels_per_m: pixels.width as f64 / (name.width_mm * 1e-3),
            depth_m: name.depth_um * 1e-6,
            pixels,
            cell_m,
        })
    }

    /// Depth of black below white, m.
    #[must_use]
    pub fn depth_m(&self) -> f64 {
        self.depth_m
    }

    /// Heights of a tile's cells, m, row after row from the bottom.
    #[must_use]
    pub fn tile(&self, id: TileId) -> Box<[f32]> {
        let middle = |tile: u32, cell: usize| {
            (f64::from(tile) * TILE as f64 + cell as f64 + 0.5) * self.cell_m
        };
        let height = |i: usize| {
            let at = [middle(id.x, i % TILE), middle(id.y, i / TILE)];
            self.height_m(at) as f32
        };
        (0..TILE_CELLS).map(height).collect()
    }

    /// Height at a place of the surface, m: from −depth to 0, linear between the pixels around it.
    #[must_use]
    pub fn height_m(&self, at: [f64; 2]) -> f64 {
        let place = |m: f64, pixels: usize| {
            let at = m * self.pixels_per_m - 0.5;
            let low = at.floor();
            let wrapped = |at: f64| at.rem_euclid(pixels as f64) as usize % pixels;
            (wrapped(low), wrapped(low + 1.0), at - low)
        };
        let (width, values) = (self.pixels.width, &self.pixels.values);
        let (left, right, u) = place(at[0], width);
        let (low, high, v) = place(at[1], self.pixels.height);
        let pixel = |x: usize, y: usize| f64::from(values[y * width + x]) / 65_535.0;
        let row = |y: usize| (1.0 - u) * pixel(left, y) + u * pixel(right, y);
        let share = (1.0 - v) * row(low) + v * row(high);
        self.depth_m * (share - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::tests::png_of;

    /// Rows from the top of a picture of heights.
    fn tooth(size: [u32; 2], values: &[u16], place: &str, cell_m: f64) -> PictureTooth {
        let raw: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        let kind = (png::ColorType::Grayscale, png::BitDepth::Sixteen);
        let mut embedded = Assets::default();
        let hash = embedded.add(png_of(size, kind.0, kind.1, &raw));
        let name = format!("image:{}@{place}", hash.expect("taken"));
        PictureTooth::called(&name, cell_m, &embedded).expect("a tooth")
    }

    #[test]
    fn heights_are_those_of_the_picture_and_repeat() {
        // Four pixels of a millimetre; the lower left is black, the upper right white.
        let tooth = tooth([2, 2], &[0x8000, 0xffff, 0, 0x4000], "2mm,80um", 5e-4);
        let um = |x: f64, y: f64| tooth.height_m([x * 1e-3, y * 1e-3]) * 1e6;
        for (x, y, expected) in [
            (0.5, 0.5, -80.0),
            (1.5, 1.5, 0.0),
            (1.5, 0.5, -80.0 * (1.0 - 16_384.0 / 65_535.0)),
            (1.0, 0.5, -80.0 * (1.0 - 8192.0 / 65_535.0)),
            (4.5, 8.5, -80.0),
            (2.0, 0.5, -80.0 * (1.0 - 8192.0 / 65_535.0)),
        ] {
            let got = um(x, y);
            println!("{x} {y}: {got:.4}, expected {expected:.4}");
            assert!((got - expected).abs() < 1e-6);
            assert!(
                (um(x, y + 0.01) - expected).abs() > 1e-3,
                "a fault would pass"
            );
        }
        let tile = tooth.tile(TileId { x: 0, y: 0 });
        assert!((f64::from(tile[0]) - tooth.height_m([2.5e-4, 2.5e-4])).abs() < 1e-9);
        assert_eq!(tile[0], tile[4 * TILE + 4], "it repeats");
        assert!(tile[0] != tile[2 * TILE]);
    }

    #[test]
    fn a_single_pixel_is_level() {
        let tooth = tooth([1, 1], &[0x7fff], "30mm,100um", 2.5e-4);
        let tile = tooth.tile(TileId { x: 7, y: 9 });
        assert!(tile.iter().all(|height| *height == tile[0]));
        assert!((tile[0] + 50e-6).abs() < 1e-8, "{}", tile[0]);
    }

    #[test]
    fn names_go_both_ways_and_wrong_ones_say_what_is_wrong() {
        let name = "image:ab@120mm,80.5um";
        let parsed = ToothName::parse(name).expect("a name");
        assert_eq!((parsed.width_mm, parsed.depth_um), (120.0, 80.5));
        assert_eq!(parsed.to_string(), name);
        for (name, word) in [
            ("linen", "no image"),
            ("image:ab", "how large"),
            ("image:ab@120mm", "how deep"),
            ("image:ab@120,80um", "width"),
            ("image:ab@0.5mm,80um", "width"),
            ("image:ab@NaNmm,80um", "width"),
            ("image:ab@120mm,80", "depth"),
            ("image:ab@120mm,1e9um", "depth"),
        ] {
            let error = ToothName::parse(name).expect_err("wrong");
            assert!(error.to_string().contains(word), "{error}");
            assert!(error.advice().to_string().contains("@120mm,80um"));
        }
        let none = PictureTooth::called(
            &format!("image:{}@9mm,9um", "0".repeat(64)),
            1e-3,
            &Assets::default(),
        );
        assert!(matches!(none, Err(CanvasError::NoPicture(_))));
    }
}
