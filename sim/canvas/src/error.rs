//! Errors of edits.

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
}
