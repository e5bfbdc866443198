//! JPEG.

use std::io::{BufRead, Seek};

use image::codecs::jpeg::JpegDecoder;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder as _};

use super::colours::Colours;
use super::pixels::{Alpha, Picture, check_size, wrong_image};
use crate::import_error::ImportError;

pub(super) fn read(source: impl BufRead + Seek, most_bytes: u64) -> Result<Picture, ImportError> {
    let mut decoder = JpegDecoder::new(source).map_err(wrong_image)?;
    let (width, height) = decoder.dimensions();
    let kind = decoder.color_type();
    check_size(
        [width, height],
        usize::from(kind.bytes_per_pixel()),
        most_bytes,
    )?;
    let channels = if kind.has_color() { 3 } else { 1 };
    let icc = decoder.icc_profile().unwrap_or_default();
    let turned = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let found = icc.map(|icc| Colours::of_profile(&icc, channels));
    let (colours, unused) = match found {
        None => (Colours::srgb(), None),
        Some(Ok(colours)) => (colours, None),
        Some(Err(unused)) => (Colours::srgb(), Some(unused)),
    };
    Ok(Picture {
        pixels: DynamicImage::from_decoder(decoder).map_err(wrong_image)?,
        alpha: Alpha::Straight,
        colours,
        unused,
        turned,
    })
}
