//! Errors of brushes.

use maulstick_types::brush::BRUSHES_MOST;
use maulstick_types::command::advice::Advice;

/// A brush, or a state of one, that is rejected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BrushError {
    /// One brush more than a painting can have.
    #[error("'{0}' would be brush {count} of this painting", count = BRUSHES_MOST + 1)]
    TooMany(String),
    /// A brush that the rig does not have.
    #[error("there is no brush called '{name}' in this rig")]
    Unknown {
        /// Its name.
        name: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// A brush without paint.
    #[error("brush '{0}' carries no paint")]
    Empty(String),
    /// A state with numbers that no brush has.
    #[error("brush '{brush}' sent an invalid state: {fault}")]
    State {
        /// Name of the brush.
        brush: String,
        /// The fault.
        fault: &'static str,
    },
    /// A state of another brush file.
    #[error("brush '{0}' sent a state of another brush file")]
    Unfit(String),
}

impl BrushError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        Advice::say(match self {
            Self::TooMany(_) => "paint with one that it has, or give one of them this brush's file",
            Self::Unknown { known, .. } => {
                return Advice::say(format!("choose one of: {}", known.join(", ")));
            }
            Self::Empty(_) => "load it first",
            Self::State { .. } => {
                "restart the brush node, or report the fault of the program that sends the states"
            }
            Self::Unfit(_) => "restart the brush node",
        })
    }
}
