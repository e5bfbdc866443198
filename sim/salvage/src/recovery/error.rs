//! Errors of a recovery.

use maulstick_document::DocumentError;
use maulstick_types::command::advice::Advice;

/// The reason why a painting cannot be recovered.
#[derive(Debug, thiserror::Error)]
pub enum SalvageError {
    /// The intact rows do not make a painting without this.
    #[error("the painting cannot be recovered: it has lost {0}")]
    Lost(String),
    /// Error of the damaged file, or of the new painting.
    #[error(transparent)]
    Document(#[from] DocumentError),
}

impl SalvageError {
    /// Advice.
    #[must_use]
    pub fn advice(&self) -> Advice {
        match self {
            Self::Lost(_) => Advice::say("use the newest intact copy of it"),
            Self::Document(error) => error.advice(),
        }
    }
}

impl From<rusqlite::Error> for SalvageError {
    fn from(error: rusqlite::Error) -> Self {
        Self::Document(error.into())
    }
}

impl From<std::io::Error> for SalvageError {
    fn from(error: std::io::Error) -> Self {
        Self::Document(error.into())
    }
}

impl From<serde_json::Error> for SalvageError {
    fn from(error: serde_json::Error) -> Self {
        Self::Document(error.into())
    }
}
