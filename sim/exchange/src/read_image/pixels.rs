//! A picture as its file has it, before anything is made of its numbers.

use image::metadata::Orientation;
use image::{DynamicImage, ImageBuffer, ImageError, Pixel};

use super::colours::{Colours, UnusedMark};
use crate::import_error::{ImportError, MOST_SIDE};

/// Relation of colours to opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alpha {
    /// Colours are as if the pixel were opaque.
    Straight,
    /// Colours that were multiplied by it (*associated*, *premultiplied*).
    Associated,
}

/// Pixels of a file.
pub(super) struct Picture {
    pub(super) pixels: DynamicImage,
    pub(super) alpha: Alpha,
    pub(super) colours: Colours,
    pub(super) unused: Option<UnusedMark>,
    /// Orientation in which it was taken.
    pub(super) turned: Orientation,
}

/// The numbers of pixels, row after row from the top.
pub(super) enum Numbers {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    /// Linear light.
    Floats(Vec<f32>),
}

impl Numbers {
    /// Pixels of 1 or 3 colour channels, with an even number of channels opacity as the last.
    ///
    /// # Errors
    /// [`ImportError::NotAPicture`] where the numbers are not as many as the pixels need.
    pub(super) fn into_image(
        self,
        size: [u32; 2],
        channels: usize,
    ) -> Result<DynamicImage, ImportError> {
        let image = match (self, channels) {
            (Self::Bytes(values), 1) => of(size, values).map(DynamicImage::ImageLuma8),
            (Self::Bytes(values), 2) => of(size, values).map(DynamicImage::ImageLumaA8),
            (Self::Bytes(values), 3) => of(size, values).map(DynamicImage::ImageRgb8),
            (Self::Bytes(values), 4) => of(size, values).map(DynamicImage::ImageRgba8),
            (Self::Words(values), 1) => of(size, values).map(DynamicImage::ImageLuma16),
            (Self::Words(values), 2) => of(size, values).map(DynamicImage::ImageLumaA16),
            (Self::Words(values), 3) => of(size, values).map(DynamicImage::ImageRgb16),
            (Self::Words(values), 4) => of(size, values).map(DynamicImage::ImageRgba16),
            (Self::Floats(values), 1) => {
                let grey = values.into_iter().flat_map(|value| [value; 3]);
                of(size, grey.collect()).map(DynamicImage::ImageRgb32F)
            }
            (Self::Floats(values), 2) => {
                let pixels = values.chunks_exact(2);
                let grey = pixels.flat_map(|pixel| [pixel[0], pixel[0], pixel[0], pixel[1]]);
                of(size, grey.collect()).map(DynamicImage::ImageRgba32F)
            }
            (Self::Floats(values), 3) => of(size, values).map(DynamicImage::ImageRgb32F),
            (Self::Floats(values), 4) => of(size, values).map(DynamicImage::ImageRgba32F),
            _ => None,
        };
        image.ok_or_else(|| ImportError::NotAPicture("pixels are missing".to_owned()))
    }
}

fn of<P: Pixel>(
    [width, height]: [u32; 2],
    values: Vec<P::Subpixel>,
) -> Option<ImageBuffer<P, Vec<P::Subpixel>>> {
    ImageBuffer::from_raw(width, height, values)
}

/// Checks the size of a picture before memory is allocated for it.
///
/// # Errors
/// [`ImportError`] where it is too large, or has no pixels.
pub(super) fn check_size(
    [width, height]: [u32; 2],
    bytes_per_pixel: usize,
    most_bytes: u64,
) -> Result<(), ImportError> {
    if width.max(height) > MOST_SIDE {
        return Err(ImportError::TooLarge(width, height));
    }
    if width.min(height) == 0 {
        return Err(ImportError::NotAPicture("it has no pixels".to_owned()));
    }
    let bytes = u64::from(width) * u64::from(height) * bytes_per_pixel as u64;
    if bytes > most_bytes {
        Err(ImportError::Memory(width, height))
    } else {
        Ok(())
    }
}

/// Sees that each float is a number.
///
/// # Errors
/// [`ImportError::NotANumber`] with the first pixel that is none.
pub(super) fn check_numbers(pixels: &DynamicImage) -> Result<(), ImportError> {
    let first = |values: &[f32], channels: usize| {
        let place = values.iter().position(|value| value.is_nan())?;
        Some(place / channels)
    };
    let found = match pixels {
        DynamicImage::ImageRgb32F(pixels) => first(pixels, 3),
        DynamicImage::ImageRgba32F(pixels) => first(pixels, 4),
        _ => None,
    };
    match found {
        None => Ok(()),
        Some(place) => {
            let width = pixels.width() as usize;
            Err(ImportError::NotANumber(place % width, place / width))
        }
    }
}

/// An error of the decoders of `image`.
pub(super) fn wrong_image(error: ImageError) -> ImportError {
    match error {
        ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            ImportError::File(error)
        }
        other => ImportError::NotAPicture(other.to_string()),
    }
}
