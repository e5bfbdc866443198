//! PNG files of any size, row after row.

use std::io::{Error, Write};

use super::Depth;

/// Level of deflate: a picture of strokes takes a twelfth of the default's time and is a sixth larger.
const LEVEL: png::DeflateCompression = png::DeflateCompression::Level(1);
/// Size of a chunk of image data in a file, bytes.
const CHUNK: usize = 1 << 18;

/// Cells of side `cell_m` per metre, rounded.
#[must_use]
pub fn density(cell_m: f64) -> u32 {
    (1.0 / cell_m).round().clamp(0.0, f64::from(u32::MAX)) as u32
}

/// Layout of the pixels of a file.
#[derive(Clone, Copy, Debug)]
pub struct Pixels<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Their channels.
    pub colour: png::ColorType,
    /// Bits of a channel.
    pub depth: Depth,
    /// ICC profile of the pixels.
    pub icc: Option<&'a [u8]>,
    /// Pixels per metre.
    pub pixels_per_m: Option<u32>,
}

impl<'a> Pixels<'a> {
    /// Header of the file.
    #[must_use]
    pub fn info(&self) -> png::Info<'a> {
        let [width, height] = self.size.map(|pixels| pixels as u32);
        let mut info = png::Info::with_size(width, height);
        info.color_type = self.colour;
        info.bit_depth = match self.depth {
            Depth::Eight => png::BitDepth::Eight,
            Depth::Sixteen => png::BitDepth::Sixteen,
        };
        info.icc_profile = self.icc.map(Into::into);
        info.pixel_dims = self.pixels_per_m.map(|density| png::PixelDimensions {
            xppu: density,
            yppu: density,
            unit: png::Unit::Meter,
        });
        info
    }
}

/// Writes a PNG: `fill` writes all its pixels, from the top row. The bytes are independent of the size of its writes.
///
/// # Errors
/// The error of `to` or `fill`.
pub fn write_png<E: From<Error>>(
    to: impl Write,
    info: png::Info<'_>,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let mut encoder = png::Encoder::with_info(to, info).map_err(Error::from)?;
    encoder.set_deflate_compression(LEVEL);
    let mut file = encoder.write_header().map_err(Error::from)?;
    let mut rows = file.stream_writer_with_size(CHUNK).map_err(Error::from)?;
    fill(&mut rows)?;
    rows.finish().map_err(Error::from)?;
    file.finish().map_err(Error::from)?;
    Ok(())
}
