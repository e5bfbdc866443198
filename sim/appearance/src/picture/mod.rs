//! Pictures of a surface.

mod drawing;
mod file;

pub use drawing::Drawing;
pub use file::{Pixels, density, write_png};

use std::fmt;
use std::io::{Error, Write};
use std::sync::Arc;

use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::GamutMapping;
use maulstick_optics::icc::Profile;

use crate::bands::in_order;

/// Conversion of a picture from the working space.
#[derive(Clone, Debug)]
pub struct Export {
    /// Target profile.
    pub profile: Arc<Profile>,
    /// Gamut mapping into that profile.
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

/// Bits of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 8 bits a channel.
    #[default]
    Eight,
    /// 16 bits, as two bytes, the higher one first.
    Sixteen,
}

impl Depth {
    /// Bytes of a pixel of three channels.
    #[must_use]
    pub(crate) fn pixel_bytes(self) -> usize {
        match self {
            Self::Eight => 3,
            Self::Sixteen => 6,
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
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
    /// ICC profile of the pixels.
    pub icc: Vec<u8>,
    /// Pixels per metre of the subject, where known.
    pub pixels_per_m: Option<u32>,
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Picture")
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

impl Picture {
    /// All bands of a drawing, a pixel a cell.
    #[must_use]
    pub fn of(drawing: &Drawing<'_>) -> Self {
        let [width, height] = drawing.banded().cells();
        let mut rgb = Vec::with_capacity(width * height * 3);
        let Ok(()) = in_order(
            drawing.banded().bands(),
            |band| drawing.band(band, Depth::Eight),
            |_, pixels| -> Result<(), std::convert::Infallible> {
                rgb.extend_from_slice(&pixels);
                Ok(())
            },
        );
        Self {
            width,
            height,
            rgb,
            icc: drawing.icc().to_vec(),
            pixels_per_m: Some(density(drawing.banded().cell_m())),
        }
    }

    /// A picture of sRGB bytes.
    #[must_use]
    pub fn srgb(width: usize, height: usize, rgb: Vec<u8>) -> Self {
        let icc = Profile::of(RgbSpace::Srgb).icc().to_vec();
        Self {
            width,
            height,
            rgb,
            icc,
            pixels_per_m: None,
        }
    }

    /// Writes a PNG: 8 bits a channel, with its profile and the size of a pixel.
    ///
    /// # Errors
    /// The error of `to`.
    pub fn encode_png(&self, to: impl Write) -> Result<(), Error> {
        let pixels = Pixels {
            size: [self.width, self.height],
            colour: png::ColorType::Rgb,
            depth: Depth::Eight,
            icc: Some(&self.icc),
            pixels_per_m: self.pixels_per_m,
        };
        write_png(to, pixels.info(), |to| to.write_all(&self.rgb))
    }
}

#[cfg(test)]
mod tests;
