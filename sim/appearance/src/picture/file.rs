//! PNG files of any size, row after row.

use std::io::{Error, Write};

use super::Depth;

/// Bytes of image data in one chunk of a file.
const CHUNK: usize = 1 << 18;

/// Cells of side `cell_m` that a metre holds, to the nearest.
#[must_use]
pub fn density(cell_m: f64) -> u32 {
    (1.0 / cell_m).round().clamp(0.0, f64::from(u32::MAX)) as u32
}

/// Layout of the pixels of a file.
#[derive(Clone, Copy, Debug)]
pub struct Pixels<'a> {
    /// Across and down.
    pub size: [usize; 2],
    /// Their channels.
    pub colour: png::ColorType,
    /// Bits of a channel.
    pub depth: Depth,
    /// The ICC profile that says what they mean.
    pub icc: Option<&'a [u8]>,
    /// Pixels per metre.
    pub pixels_per_m: Option<u32>,
}

impl<'a> Pixels<'a> {
    /// As a file's header says it.
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

/// Writes a PNG: `fill` writes all its pixels, from the top row. The size of its writes changes no byte.
///
/// # Errors
/// The error of `to` or `fill`.
pub fn write_png<E: From<Error>>(
    to: impl Write,
    info: png::Info<'_>,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let encoder = png::Encoder::with_info(to, info).map_err(Error::from)?;
    let mut file = encoder.write_header().map_err(Error::from)?;
    let mut rows = file.stream_writer_with_size(CHUNK).map_err(Error::from)?;
    fill(&mut rows)?;
    rows.finish().map_err(Error::from)?;
    file.finish().map_err(Error::from)?;
    Ok(())
}
