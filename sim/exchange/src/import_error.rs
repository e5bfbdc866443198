//! Errors of imports.

use maulstick_painting::EditError;

/// Most pixels of a picture across and down.
pub const MOST_SIDE: u32 = 20_000;

/// A picture that cannot be imported.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    File(#[source] std::io::Error),
    /// It holds no picture, or one that is damaged.
    #[error("this is not an intact PNG, JPEG, TIFF, OpenEXR or OpenRaster picture: {0}")]
    NotAPicture(String),
    /// It is of a kind of its format that is not read.
    #[error("pictures of this kind are not read: {0}")]
    Unsupported(String),
    /// A pixel is no number: across and down from the upper left one, which is 0, 0.
    #[error("pixel {0}, {1} from the upper left corner is not a number (NaN)")]
    NotANumber(usize, usize),
    /// Metadata that take too much memory, with the limit, MB.
    #[error("the metadata of the file take more than {0} MB")]
    Beside(usize),
    /// It is larger than pictures may be.
    #[error(
        "a picture of {0}×{1} pixels is too large: import one of at most {MOST_SIDE} pixels either way"
    )]
    TooLarge(u32, u32),
    /// It takes more memory than it may.
    #[error("a picture of {0}×{1} pixels takes too much memory; make it smaller")]
    Memory(u32, u32),
    /// The canvas has more cells than a picture is fitted to.
    #[error("a canvas of {0}×{1} cells is too large for a picture: it may have 67 million cells")]
    Canvas(usize, usize),
    /// The film is too thin or too thick.
    #[error("a film of {0} µm cannot be laid; choose 1 to 5000 µm")]
    Thickness(f64),
    /// There is nothing to mix, or too much.
    #[error("a picture cannot be mixed from {0} paints; choose 1 to 16")]
    Paints(usize),
    /// The painting refuses.
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
