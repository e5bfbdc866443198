//! Palettes of 256 colours, and pictures in their colours.
//!
//! Colours that a palette lacks are mixed from four by four pixels of others by Knoll's pattern dithering (US patent
//! 6606166, expired): the result depends on a pixel's colour and place alone, so still parts do not flicker.

use std::collections::BTreeMap;

use color_quant::NeuQuant;

/// Number of colours of a palette.
const COLOURS: usize = 256;
/// Greatest number of pixels from which a palette is computed.
const SAMPLES: usize = 1 << 16;
/// Order in which the cells of a pattern receive its colours, from dark to light (Bayer 1973).
const PATTERN: [[usize; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
/// Share of the error that a colour of a pattern is corrected by.
const CORRECTION: f32 = 0.7;
/// Bits of a channel in the table of nearest colours.
const BITS: u32 = 6;

/// A palette, with a table of nearest colours.
pub(super) struct Palette {
    colours: Vec<[u8; 3]>,
    /// Index of each colour, where the palette has all colours of the picture.
    exact: Option<BTreeMap<[u8; 3], u8>>,
    /// The nearest colour by the first bits of each channel; found on demand.
    nearest: Vec<Option<u8>>,
}

impl Palette {
    /// Palette of the pixels of a picture.
    pub(super) fn of(pixels: &[[u8; 3]]) -> Self {
        let mut exact = BTreeMap::new();
        for pixel in pixels {
            let place = exact.len();
            exact.entry(*pixel).or_insert(place);
            if exact.len() > COLOURS {
                return Self::learnt(pixels);
            }
        }
        let mut colours = vec![[0; 3]; exact.len()];
        for (colour, place) in &exact {
            colours[*place] = *colour;
        }
        let exact = exact
            .into_iter()
            .map(|(colour, place)| (colour, place as u8));
        Self {
            colours,
            exact: Some(exact.collect()),
            nearest: Vec::new(),
        }
    }

    fn learnt(pixels: &[[u8; 3]]) -> Self {
        let rgba: Vec<u8> = pixels
            .iter()
            .flat_map(|[r, g, b]| [*r, *g, *b, 255])
            .collect();
        let every = pixels.len().div_ceil(SAMPLES).clamp(1, 30);
        let learnt = NeuQuant::new(every as i32, COLOURS, &rgba);
        let map = learnt.color_map_rgb();
        Self {
            colours: map.as_chunks::<3>().0.to_vec(),
            exact: None,
            nearest: vec![None; 1 << (3 * BITS)],
        }
    }

    /// Its colours as red, green, blue.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.colours.as_flattened().to_vec()
    }

    /// Palette index for the pixel at a place of the picture.
    pub(super) fn place(&mut self, pixel: [u8; 3], [x, y]: [usize; 2]) -> u8 {
        if let Some(exact) = &self.exact {
            return exact.get(&pixel).copied().unwrap_or(0);
        }
        let colour = pixel.map(f32::from);
        let mut error = [0.0f32; 3];
        let mut mixed = [0u8; 16];
        for place in &mut mixed {
            let wanted = [0, 1, 2].map(|c| colour[c] + CORRECTION * error[c]);
            *place = self.nearest(wanted);
            let found = self.colours[usize::from(*place)];
            (0..3).for_each(|c| error[c] += colour[c] - f32::from(found[c]));
        }
        let light = |place: &u8| {
            let [r, g, b] = self.colours[usize::from(*place)].map(u32::from);
            2126 * r + 7152 * g + 722 * b
        };
        mixed.sort_by_key(light);
        mixed[PATTERN[y % 4][x % 4]]
    }

    fn nearest(&mut self, colour: [f32; 3]) -> u8 {
        let byte = colour.map(|value| value.clamp(0.0, 255.0) as u32);
        let key = byte
            .iter()
            .fold(0, |key, value| key << BITS | value >> (8 - BITS));
        if let Some(place) = self.nearest[key as usize] {
            return place;
        }
        let half = 1 << (7 - BITS);
        let middle = byte.map(|value| (value >> (8 - BITS) << (8 - BITS) | half) as i32);
        let distance = |other: &[u8; 3]| -> i32 {
            let apart = (0..3).map(|c| i32::from(other[c]) - middle[c]);
            apart.map(|apart| apart * apart).sum()
        };
        let places = self.colours.iter().enumerate();
        let nearest = places.min_by_key(|(_, other)| distance(other));
        let place = nearest.map_or(0, |(place, _)| place as u8);
        self.nearest[key as usize] = Some(place);
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_stay_as_they_are_and_many_stay_alike_in_the_mean() {
        let few: Vec<[u8; 3]> = (0..500).map(|i| [(i % 250) as u8, 7, 9]).collect();
        let mut palette = Palette::of(&few);
        let bytes = palette.bytes();
        for (i, pixel) in few.iter().enumerate() {
            let place = usize::from(palette.place(*pixel, [i, 0]));
            assert_eq!(bytes[3 * place..][..3], *pixel);
        }
        // A ramp through many colours: means of blocks are those of the ramp.
        let (width, height) = (256, 64);
        let colour = |x: usize, y: usize| [x as u8, (4 * y) as u8, (255 - x) as u8];
        let many: Vec<[u8; 3]> = (0..width * height)
            .map(|i| colour(i % width, i / width))
            .collect();
        let mut palette = Palette::of(&many);
        let bytes = palette.bytes();
        let (mut mixed, mut nearest_alone) = (0.0f64, 0.0f64);
        for by in (0..height).step_by(8) {
            for bx in (0..width).step_by(8) {
                let (mut sum, mut plain) = ([0.0; 3], [0.0; 3]);
                for (x, y) in (0..64).map(|i| (bx + i % 8, by + i / 8)) {
                    let pixel = colour(x, y);
                    let found = usize::from(palette.place(pixel, [x, y]));
                    let nearest = usize::from(palette.nearest(pixel.map(f32::from)));
                    for c in 0..3 {
                        sum[c] += (f64::from(bytes[3 * found + c]) - f64::from(pixel[c])) / 64.0;
                        plain[c] +=
                            (f64::from(bytes[3 * nearest + c]) - f64::from(pixel[c])) / 64.0;
                    }
                }
                let off = |sum: [f64; 3]| sum.into_iter().map(f64::abs).sum::<f64>() / 3.0;
                mixed += off(sum) / 256.0;
                nearest_alone += off(plain) / 256.0;
            }
        }
        // Corners of the ramp are outside of all mixtures of a palette.
        println!("means of blocks are off by {mixed:.2}, without dithering by {nearest_alone:.2}");
        assert!(mixed < 0.8 * nearest_alone, "{mixed} {nearest_alone}");
    }
}
