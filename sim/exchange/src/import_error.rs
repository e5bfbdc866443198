//! Errors of imports.

use maulstick_painting::EditError;

/// Greatest number of pixels of a picture across and down.
pub const MOST_SIDE: u32 = 20_000;

/// Errors of importing a picture.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    File(#[source] std::io::Error),
    /// The file is not a picture, or is damaged.
    #[error("this is not an intact PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster picture: {0}")]
    NotAPicture(String),
    /// Its variant of the format is not supported.
    #[error("pictures of this kind are not read: {0}")]
    Unsupported(String),
    /// A pixel is not a number: across and down from the upper left one, which is 0, 0.
    #[error("pixel {0}, {1} from the upper left corner is not a number (NaN)")]
    NotANumber(usize, usize),
    /// Metadata exceed the limit of memory, MB.
    #[error("the metadata of the file take more than {0} MB")]
    Beside(usize),
    /// Its width or height exceeds the limit.
    #[error(
        "a picture of {0}×{1} pixels is too large: import one of at most {MOST_SIDE} pixels either way"
    )]
    TooLarge(u32, u32),
    /// Its size in memory exceeds the limit.
    #[error("a picture of {0}×{1} pixels takes too much memory; make it smaller")]
    Memory(u32, u32),
    /// As surroundings it is not twice as wide as high.
    #[error(
        "a picture of surroundings by latitude and longitude is twice as wide as high, not {0}×{1} pixels"
    )]
    NotPanoramic(usize, usize),
    /// As surroundings it has a pixel of no light: across and down from the upper left one, which is 0, 0.
    #[error(
        "pixel {0}, {1} from the upper left corner has a radiance that is negative or infinite"
    )]
    Radiance(usize, usize),
    /// As surroundings it has no light before the painting.
    #[error("the middle half of this picture, which faces the painting, is black")]
    Black,
    /// The canvas has more cells than the limit of resampling.
    #[error("a canvas of {0}×{1} cells is too large for a picture: it may have 67 million cells")]
    Canvas(usize, usize),
    /// The film is too thin or too thick.
    #[error("a film cannot be {0} µm thick; choose 1 to 5000 µm")]
    Thickness(f64),
    /// The number of paints is 0 or exceeds the limit.
    #[error("a picture cannot be mixed from {0} paints; choose 1 to 16")]
    Paints(usize),
    /// The painting rejects it.
    #[error(transparent)]
    Refused(EditError),
    /// It cannot be written as a PNG.
    #[error("the picture cannot be stored: {0}")]
    Png(#[source] png::EncodingError),
}

impl From<EditError> for ImportError {
    fn from(refusal: EditError) -> Self {
        Self::Refused(refusal)
    }
}
