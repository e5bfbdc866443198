//! A page composed of pictures and words.

use ab_glyph::{Font as _, FontRef, PxScale, ScaleFont as _};
use maulstick_appearance::picture::Picture;
use maulstick_rig::UserError;
use maulstick_ui::render::brush::thumbnail::BrushThumbnail;

/// Paper and ink, sRGB.
const PAPER: [u8; 3] = [250, 248, 244];
const INK: [f32; 3] = [40.0, 36.0, 33.0];

/// A page under work.
pub struct Page {
    picture: Picture,
    font: FontRef<'static>,
}

impl Page {
    /// An empty page of this size, pixels.
    ///
    /// # Errors
    /// A [`UserError`] where the font cannot be read.
    pub fn new(width: usize, height: usize) -> Result<Self, UserError> {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT)
            .map_err(|error| UserError::failure(error.to_string()))?;
        let rgb = PAPER.repeat(width * height);
        let picture = Picture::srgb(width, height, rgb);
        Ok(Self { picture, font })
    }

    /// The finished page.
    #[must_use]
    pub fn done(self) -> Picture {
        self.picture
    }

    fn mix(&mut self, [x, y]: [usize; 2], colour: [f32; 3], cover: f32) {
        if x >= self.picture.width || y >= self.picture.height {
            return;
        }
        let at = 3 * (y * self.picture.width + x);
        for (byte, own) in self.picture.rgb[at..at + 3].iter_mut().zip(colour) {
            let under = f32::from(*byte);
            *byte = (under + (own - under) * cover) as u8;
        }
    }

    /// Copies a picture here with its upper left corner.
    pub fn paste(&mut self, picture: &Picture, [x, y]: [usize; 2]) {
        for row in 0..picture.height {
            for column in 0..picture.width {
                let from = 3 * (row * picture.width + column);
                let colour = [0, 1, 2].map(|i| f32::from(picture.rgb[from + i]));
                self.mix([x + column, y + row], colour, 1.0);
            }
        }
    }

    /// Fills a rectangle, from its upper left corner, with a colour.
    pub fn fill(&mut self, [x, y]: [usize; 2], [width, height]: [usize; 2], colour: [u8; 3]) {
        for row in y..y + height {
            for column in x..x + width {
                self.mix([column, row], colour.map(f32::from), 1.0);
            }
        }
    }

    /// Draws a line between two places, pixels, `width` pixels wide, with round ends.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: [u8; 3]) {
        let reach = 0.5 * width + 1.0;
        let span = |axis: usize, end: usize| {
            let low = from[axis].min(to[axis]) - reach;
            let high = from[axis].max(to[axis]) + reach;
            (low.max(0.0) as usize)..(high.max(0.0) as usize + 1).min(end)
        };
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = (along[0] * along[0] + along[1] * along[1]).max(1e-12);
        for y in span(1, self.picture.height) {
            for x in span(0, self.picture.width) {
                let off = [x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]];
                let t = ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0);
                let away = [off[0] - t * along[0], off[1] - t * along[1]];
                let distance = (away[0] * away[0] + away[1] * away[1]).sqrt();
                let cover = (0.5 * width + 0.5 - distance).clamp(0.0, 1.0);
                if cover > 0.0 {
                    self.mix([x, y], colour.map(f32::from), cover);
                }
            }
        }
    }

    /// Draws a brush here with its upper left corner.
    pub fn portray(&mut self, portrait: &BrushThumbnail, [x, y]: [usize; 2]) {
        for (i, pixel) in portrait.rgba.chunks_exact(4).enumerate() {
            let at = [x + i % portrait.width, y + i / portrait.width];
            let colour = [0, 1, 2].map(|i| f32::from(pixel[i]));
            self.mix(at, colour, f32::from(pixel[3]) / 255.0);
        }
    }

    /// Writes a line with its left end and base line here; `size` is the height of a line, pixels.
    pub fn write(&mut self, words: &str, [x, y]: [usize; 2], size: f32) {
        self.letters(words, size, |page, along, down, cover| {
            page.ink([x as f32 + along, y as f32 + down], cover);
        });
    }

    /// Writes a line upward: its left end is the lowest point, its base line is on the right.
    pub fn write_up(&mut self, words: &str, [x, y]: [usize; 2], size: f32) {
        self.letters(words, size, |page, along, down, cover| {
            page.ink([x as f32 + down, y as f32 - along], cover);
        });
    }

    /// Length of a line, pixels.
    #[must_use]
    pub fn length(&self, words: &str, size: f32) -> usize {
        let scaled = self.font.as_scaled(PxScale::from(size));
        let mut last = None;
        let mut length = 0.0;
        for letter in words.chars() {
            let id = scaled.glyph_id(letter);
            length += last.map_or(0.0, |last| scaled.kern(last, id)) + scaled.h_advance(id);
            last = Some(id);
        }
        length.ceil() as usize
    }

    fn ink(&mut self, [x, y]: [f32; 2], cover: f32) {
        if x >= 0.0 && y >= 0.0 {
            self.mix([x as usize, y as usize], INK, cover.min(1.0));
        }
    }

    /// Draws a line's letters pixel by pixel: places along the line and down from its base line, and
    /// how much of the pixel is covered.
    fn letters(&mut self, words: &str, size: f32, draw: impl Fn(&mut Self, f32, f32, f32)) {
        let font = self.font.clone();
        let scaled = font.as_scaled(PxScale::from(size));
        let mut caret = 0.0;
        let mut last = None;
        for letter in words.chars() {
            let id = scaled.glyph_id(letter);
            caret += last.map_or(0.0, |last| scaled.kern(last, id));
            let glyph = id.with_scale_and_position(size, ab_glyph::point(caret, 0.0));
            if let Some(outline) = font.outline_glyph(glyph) {
                let bounds = outline.px_bounds();
                outline.draw(|dx, dy, cover| {
                    let along = bounds.min.x + dx as f32;
                    draw(self, along, bounds.min.y + dy as f32, cover);
                });
            }
            caret += scaled.h_advance(id);
            last = Some(id);
        }
    }
}
