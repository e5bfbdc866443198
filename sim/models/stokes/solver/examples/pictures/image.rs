//! An RGB image with smooth lines, discs and small numbers.

use std::error::Error;
use std::path::Path;

pub(crate) type Colour = [f32; 3];

pub(crate) const BLACK: Colour = [20.0; 3];
pub(crate) const GREY: Colour = [140.0; 3];
pub(crate) const PALE: Colour = [222.0; 3];
pub(crate) const RED: Colour = [205.0, 45.0, 35.0];
pub(crate) const BLUE: Colour = [35.0, 80.0, 190.0];

/// Characters of three by five pixels, rows from the top, the leftmost pixel as the highest bit.
const GLYPHS: [(char, [u8; 5]); 12] = [
    ('0', [7, 5, 5, 5, 7]),
    ('1', [2, 6, 2, 2, 7]),
    ('2', [7, 1, 7, 4, 7]),
    ('3', [7, 1, 7, 1, 7]),
    ('4', [5, 5, 7, 1, 1]),
    ('5', [7, 4, 7, 1, 7]),
    ('6', [7, 4, 7, 5, 7]),
    ('7', [7, 1, 2, 2, 2]),
    ('8', [7, 5, 7, 5, 7]),
    ('9', [7, 5, 7, 1, 7]),
    ('.', [0, 0, 0, 0, 2]),
    ('-', [0, 0, 7, 0, 0]),
];
/// Pixels of one of a character's.
const GLYPH_ZOOM: isize = 2;

pub(crate) struct Image {
    pub width: usize,
    pub height: usize,
    pixels: Vec<Colour>,
}

impl Image {
    /// A white image.
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[255.0; 3]; width * height],
        }
    }

    /// Covers a share of a pixel.
    pub(crate) fn blend(&mut self, x: isize, y: isize, colour: Colour, share: f64) {
        let inside =
            (0..self.width as isize).contains(&x) && (0..self.height as isize).contains(&y);
        if !inside {
            return;
        }
        let share = share.clamp(0.0, 1.0) as f32;
        let pixel = &mut self.pixels[x as usize + y as usize * self.width];
        for (pixel, colour) in pixel.iter_mut().zip(colour) {
            *pixel += share * (colour - *pixel);
        }
    }

    /// Fills a rectangle: left, top, width, height.
    pub(crate) fn fill(&mut self, [left, top, width, height]: [f64; 4], colour: Colour) {
        for y in top as isize..(top + height) as isize {
            for x in left as isize..(left + width) as isize {
                self.blend(x, y, colour, 1.0);
            }
        }
    }

    /// A line of a width with round ends.
    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Colour) {
        let way = [to[0] - from[0], to[1] - from[1]];
        let squared = (way[0] * way[0] + way[1] * way[1]).max(1e-12);
        let bounds = [0, 1].map(|axis| {
            let low = from[axis].min(to[axis]) - width - 1.0;
            let high = from[axis].max(to[axis]) + width + 1.0;
            low as isize..=high as isize
        });
        let [xs, ys] = bounds;
        for y in ys {
            for x in xs.clone() {
                let place = [x as f64 + 0.5 - from[0], y as f64 + 0.5 - from[1]];
                let along = (place[0] * way[0] + place[1] * way[1]) / squared;
                let along = along.clamp(0.0, 1.0);
                let off = [place[0] - along * way[0], place[1] - along * way[1]];
                let distance = (off[0] * off[0] + off[1] * off[1]).sqrt();
                self.blend(x, y, colour, 0.5 * width + 0.5 - distance);
            }
        }
    }

    /// An arrow with a head at its end.
    pub(crate) fn arrow(&mut self, from: [f64; 2], to: [f64; 2], colour: Colour) {
        self.line(from, to, 2.0, colour);
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt().max(1e-9);
        let [x, y] = way.map(|way| 7.0 * way / length);
        for side in [-0.5, 0.5] {
            let barb = [to[0] - x - side * y, to[1] - y + side * x];
            self.line(to, barb, 2.0, colour);
        }
    }

    /// A number with its middle at a place.
    pub(crate) fn number(&mut self, value: f64, decimals: usize, middle: [f64; 2]) {
        let text = format!(
            "{:.decimals$}",
            if value.abs() < 1e-9 { 0.0 } else { value }
        );
        let left = middle[0] as isize - 2 * GLYPH_ZOOM * text.len() as isize;
        let top = middle[1] as isize - 5 * GLYPH_ZOOM / 2;
        for (number, character) in text.chars().enumerate() {
            let Some((_, rows)) = GLYPHS.iter().find(|(known, _)| *known == character) else {
                continue;
            };
            let left = left + 4 * GLYPH_ZOOM * number as isize;
            for y in 0..5 * GLYPH_ZOOM {
                for x in 0..3 * GLYPH_ZOOM {
                    let bit = 4 >> (x / GLYPH_ZOOM);
                    if rows[(y / GLYPH_ZOOM) as usize] & bit > 0 {
                        self.blend(left + x, top + y, BLACK, 1.0);
                    }
                }
            }
        }
    }

    /// Copies another image to a place, its left upper corner.
    pub(crate) fn paste(&mut self, other: &Self, left: usize, top: usize) {
        for y in 0..other.height {
            for x in 0..other.width {
                let colour = other.pixels[x + y * other.width];
                self.blend((left + x) as isize, (top + y) as isize, colour, 1.0);
            }
        }
    }

    pub(crate) fn save(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let file = std::fs::File::create(path)?;
        let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        let bytes: Vec<u8> = (self.pixels.iter().flatten())
            .map(|value| value.round() as u8)
            .collect();
        encoder.write_header()?.write_image_data(&bytes)?;
        Ok(())
    }
}

/// Viridis from 0 to 1, by six of its colours.
pub(crate) fn viridis(value: f64) -> Colour {
    const COLOURS: [Colour; 6] = [
        [68.0, 1.0, 84.0],
        [65.0, 68.0, 135.0],
        [42.0, 120.0, 142.0],
        [34.0, 168.0, 132.0],
        [122.0, 209.0, 81.0],
        [253.0, 231.0, 37.0],
    ];
    let at = 5.0 * value.clamp(0.0, 1.0);
    let below = (at as usize).min(4);
    let share = (at - below as f64) as f32;
    [0, 1, 2].map(|i| COLOURS[below][i] + share * (COLOURS[below + 1][i] - COLOURS[below][i]))
}
