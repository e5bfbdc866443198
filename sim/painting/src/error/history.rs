//! Errors of undo, redo and versions.

use maulstick_types::command::advice::Advice;
use maulstick_types::nearest::choice;
use maulstick_types::paint::StepName;

/// A step that cannot be gone to.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HistoryError {
    /// Nothing to undo, of a brush or at all.
    #[error("there is nothing{} to undo", .0.as_ref().map_or(String::new(), |brush| format!(" by brush '{brush}'")))]
    NothingToUndo(Option<String>),
    /// Nothing to redo.
    #[error("there is nothing to redo")]
    NothingToRedo,
    /// A step that is no longer apart.
    #[error("this step is no longer in the history")]
    NoStep,
    /// A step under a later one.
    #[error("'{what}' is covered by a later step{}", .over.as_ref().map_or(String::new(), |over| format!(", '{over}'")))]
    Covered {
        /// The step.
        what: StepName,
        /// The later one.
        over: Option<StepName>,
    },
}

impl HistoryError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        Advice::say(match self {
            Self::NothingToUndo(None) => "paint something first",
            Self::NothingToUndo(Some(_)) => {
                "undo the newest step of all brushes, or name another brush"
            }
            Self::NothingToRedo => "only what was undone and not painted over can be redone",
            Self::NoStep => {
                "choose another one: old steps are merged, and new ones replace undone ones"
            }
            Self::Covered { .. } => return Advice::UndoNewest,
        })
    }
}

/// A version, or the name of one, that is rejected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VersionError {
    /// An unknown version.
    #[error("there is no version called '{name}'")]
    Unknown {
        /// Its name.
        name: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// A name that is taken.
    #[error("there is a version called '{0}' already")]
    Taken(String),
    /// The name reserved for the current painting.
    #[error("'{0}' stands for the current painting and cannot name a version")]
    Now(&'static str),
}

impl VersionError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        match self {
            Self::Unknown { known, .. } if known.is_empty() => {
                Advice::say("this painting has no versions yet: keep one first")
            }
            Self::Unknown { name, known } => {
                Advice::say(choice(name, known.iter().map(String::as_str)))
            }
            Self::Taken(_) => Advice::say("choose another name, or forget that version first"),
            Self::Now(_) => Advice::say("choose another name"),
        }
    }
}
