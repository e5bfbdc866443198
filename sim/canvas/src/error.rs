//! Errors of the files and names that grounds and teeth are made of.

use maulstick_types::command::advice::Advice;

/// A picture, or the name of one, that is rejected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CanvasError {
    /// The name of a pictured tooth that cannot be read.
    #[error("'{name}' does not name a tooth: {fault}")]
    ToothName {
        /// Requested name.
        name: String,
        /// Fault, as a clause.
        fault: &'static str,
    },
    /// Bytes that are not a picture, or a picture of another kind or size.
    #[error("{0}")]
    Picture(String),
    /// A picture that the painting lacks, by its hash.
    #[error("this painting has no picture with the hash {0}")]
    NoPicture(String),
    /// A text that is not a hash.
    #[error("'{0}' is not the hash of a picture")]
    NoHash(String),
    /// A picture of heights instead of colours.
    #[error("a picture of heights cannot be a ground")]
    Heights,
    /// A picture of colours instead of heights.
    #[error("a picture of colours cannot be a tooth")]
    Colours,
}

impl CanvasError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        Advice::say(match self {
            Self::ToothName { .. } => {
                "write image:HASH@120mm,80um: a picture 120 mm wide, 80 µm deep"
            }
            Self::Picture(_) => {
                "use a PNG of 8-bit RGB or 16-bit grey with at most 67 million pixels"
            }
            Self::NoPicture(_) => "import the picture first",
            Self::NoHash(_) => "write image: and the 64 digits of its SHA-256",
            Self::Heights => "import it as a ground, which keeps its colours",
            Self::Colours => "import it as a tooth, which keeps it as 16-bit heights",
        })
    }
}
