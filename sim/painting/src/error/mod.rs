//! Errors of a painting. They become words where a person reads them: a reply has the sentence and the advice, and each
//! front end has its own words for that.

mod brush;
mod history;
mod layer;
mod surface;

pub use brush::BrushError;
pub use history::{HistoryError, VersionError};
pub use layer::LayerError;
pub use surface::SurfaceError;

use maulstick_appearance::LookError;
use maulstick_canvas::CanvasError;
use maulstick_canvas::quantum::SLOTS;
use maulstick_models::NoModel;
use maulstick_optics::PaintError;
use maulstick_types::EditFault;
use maulstick_types::command::Outcome;
use maulstick_types::command::advice::Advice;
use maulstick_types::values::ValueError;

/// An edit that was refused: the painting is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// A paint or a mixture.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// One paint more than a painting can have.
    #[error("'{0}' would be paint {count} of this painting", count = SLOTS + 1)]
    TooManyPaints(String),
    /// A paint that the painting does not use.
    #[error("paint '{0}' is not in use in this painting")]
    NoSlot(String),
    /// A brush, or its state.
    #[error(transparent)]
    Brush(#[from] BrushError),
    /// A surface, or what it is made of.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A picture that grounds and teeth are made of.
    #[error(transparent)]
    Canvas(#[from] CanvasError),
    /// A light or a ground.
    #[error(transparent)]
    Look(#[from] LookError),
    /// A paint model.
    #[error(transparent)]
    Model(#[from] NoModel),
    /// A dry layer, or a drying.
    #[error(transparent)]
    Layer(#[from] LayerError),
    /// A step of the history.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// A version.
    #[error(transparent)]
    Version(#[from] VersionError),
    /// A value out of its range.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// An edit that this program does not know, or a field that it does not have.
    #[error(transparent)]
    Edit(#[from] EditFault),
    /// What one kind of edit alone refuses, in its own words.
    #[error("{what}")]
    Own {
        /// What is wrong.
        what: &'static str,
        /// What to do.
        help: &'static str,
    },
    /// A document whose parts do not fit together.
    #[error("{0}")]
    Damaged(String),
}

impl EditError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        match self {
            Self::Paint(PaintError::Unknown { .. }) => Advice::ListPaints,
            Self::Paint(_) => {
                Advice::say("write mixtures as \"Cobalt Blue=0.7,Titanium White=0.3\"")
            }
            Self::TooManyPaints(_) => Advice::say(format!(
                "a painting has at most {SLOTS} paints: mix it from those in use"
            )),
            Self::NoSlot(_) => Advice::say("load a brush with it first"),
            Self::Brush(error) => error.advice(),
            Self::Surface(error) => error.advice(),
            Self::Canvas(error) => error.advice(),
            Self::Look(error) => error.advice(),
            Self::Model(error) => error.advice(),
            Self::Layer(error) => error.advice(),
            Self::History(error) => error.advice(),
            Self::Version(error) => error.advice(),
            Self::Edit(fault) => Advice::say(fault.help()),
            Self::Value(_) => Advice::say("choose a value in range"),
            Self::Own { help, .. } => Advice::say(*help),
            Self::Damaged(_) => Advice::Recover,
        }
    }
}

impl From<EditError> for Outcome {
    fn from(error: EditError) -> Self {
        Self::Refused {
            what: error.to_string(),
            advice: error.advice(),
        }
    }
}
