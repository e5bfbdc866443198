//! Radiance's picture format: linear light, three mantissas and an exponent a pixel.

use std::io::{BufRead, Seek};

use image::codecs::hdr::HdrDecoder;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder as _};

use super::colours::Colours;
use super::pixels::{Alpha, Picture, check_size, wrong_image};
use crate::import_error::ImportError;

/// Directions of rows and columns that are read, as most files have them.
const UPRIGHT: ((i8, i8), (i8, i8)) = ((1, 0), (0, 1));

pub(super) fn read(source: impl BufRead + Seek, most_bytes: u64) -> Result<Picture, ImportError> {
    let decoder = HdrDecoder::new(source).map_err(wrong_image)?;
    let (width, height) = decoder.dimensions();
    check_size([width, height], 3 * size_of::<f32>(), most_bytes)?;
    if decoder.metadata().orientation != UPRIGHT {
        let what = "its rows do not go from the left and down".to_owned();
        return Err(ImportError::Unsupported(what));
    }
    Ok(Picture {
        pixels: DynamicImage::from_decoder(decoder).map_err(wrong_image)?,
        alpha: Alpha::Straight,
        colours: Colours::srgb(),
        unused: None,
        turned: Orientation::NoTransforms,
    })
}
