//! Pictures of a surface.

use std::io::{Error, Write};

use maulstick_optics::colour::{SrgbTable, clamp_chromaticity};
use maulstick_types::paint::TILE;

use crate::display::DisplayTile;
use crate::painting::Painting;

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

/// The picture of a surface, a pixel a cell.
pub fn picture(painting: &mut Painting, surface: u32) -> Picture {
    painting.commit();
    let Some(store) = painting.store(surface) else {
        return Picture {
            width: 0,
            height: 0,
            rgb: Vec::new(),
        };
    };
    let [width, height] = store.cells().map(|cells| cells as usize);
    let mut rgb = vec![0u8; width * height * 3];
    let table = SrgbTable::default();
    let ground = painting.ground(surface);
    let bare = DisplayTile::of(None, painting.studio(), ground);
    for (id, version) in store.iter() {
        let shown = match &version.tile {
            Some(tile) => &DisplayTile::of(Some(tile), painting.studio(), ground),
            None => &bare,
        };
        let (left, bottom) = (id.x as usize * TILE, id.y as usize * TILE);
        for y in 0..TILE.min(height - bottom) {
            let row = height - 1 - (bottom + y);
            for x in 0..TILE.min(width - left) {
                let cell = y * TILE + x;
                let colour = clamp_chromaticity([0, 1, 2].map(|c| shown.rgb[c][cell]));
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
