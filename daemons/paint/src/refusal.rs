//! Refusals of what the node does besides painting, with advice.

use maulstick_painting::EditError;
use maulstick_types::command::Outcome;
use maulstick_types::command::advice::Advice;

/// A command that is not carried out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The error.
    pub what: String,
    /// Advice.
    pub advice: Advice,
}

impl Refusal {
    /// A refusal with advice.
    #[must_use]
    pub fn new(what: impl Into<String>, advice: Advice) -> Self {
        Self {
            what: what.into(),
            advice,
        }
    }

    /// A refusal with advice in words.
    #[must_use]
    pub fn say(what: impl Into<String>, help: &str) -> Self {
        Self::new(what, Advice::say(help))
    }
}

impl From<EditError> for Refusal {
    fn from(error: EditError) -> Self {
        Self::new(error.to_string(), error.advice())
    }
}

impl From<Refusal> for Outcome {
    fn from(refusal: Refusal) -> Self {
        Self::Refused {
            what: refusal.what,
            advice: refusal.advice,
        }
    }
}
