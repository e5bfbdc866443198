//! Errors of exports.

use std::io;

/// Errors of exporting a painting.
#[derive(Debug, thiserror::Error)]
pub enum ExchangeError {
    /// The painting has no such surface.
    #[error("there is no surface {0}; the canvas is 0, the palette 1")]
    NoSurface(u32),
    /// A part of the painting cannot be read back from its document, so the file lacks paint.
    #[error("the painting's document is damaged: {0}")]
    Damaged(String),
    /// The file cannot be written.
    #[error("the file cannot be written: {0}")]
    Write(#[from] io::Error),
    /// An OpenEXR file cannot contain this painting.
    #[error("the OpenEXR file cannot be written: {0}")]
    OpenExr(String),
    /// An option of a solid is out of its range.
    #[error("a {what} of {value}; choose {least} to {most}")]
    OutOfRange {
        /// Name of the option, with its unit.
        what: &'static str,
        /// Requested value.
        value: f64,
        /// Least value.
        least: f64,
        /// Greatest value.
        most: f64,
    },
    /// A solid with more triangles than its format can count.
    #[error(
        "{triangles} triangles are too many for the file; choose a larger step, of {step} cells or more"
    )]
    TooManyTriangles {
        /// Number of triangles.
        triangles: u64,
        /// Step that gives a workable number of triangles, cells.
        step: u32,
    },
}

impl From<exr::error::Error> for ExchangeError {
    fn from(error: exr::error::Error) -> Self {
        match error {
            exr::error::Error::Io(error) => Self::Write(error),
            other => Self::OpenExr(other.to_string()),
        }
    }
}

impl From<zip::result::ZipError> for ExchangeError {
    fn from(error: zip::result::ZipError) -> Self {
        match error {
            zip::result::ZipError::Io(error) => Self::Write(error),
            other => Self::Write(io::Error::other(other)),
        }
    }
}

impl From<png::EncodingError> for ExchangeError {
    fn from(error: png::EncodingError) -> Self {
        Self::Write(error.into())
    }
}
