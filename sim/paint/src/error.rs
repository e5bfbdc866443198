//! Errors of edits.

use maulstick_optics::PaintError;

/// An edit that was refused: what is wrong, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct EditError {
    /// The error.
    pub what: String,
    /// Advice.
    pub help: String,
}

impl EditError {
    /// A refusal.
    #[must_use]
    pub fn new(what: String, help: &str) -> Self {
        Self {
            what,
            help: help.to_owned(),
        }
    }

    /// A refusal because of a paint or a mixture.
    #[must_use]
    pub fn paint(error: PaintError) -> Self {
        let help = match &error {
            PaintError::Unknown { .. } => "`maulstick paints` lists them all",
            _ => "write mixtures as \"Cobalt Blue=0.7,Titanium White=0.3\"",
        };
        Self {
            what: error.to_string(),
            help: help.to_owned(),
        }
    }
}
