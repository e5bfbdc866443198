//! Redoes the newest undone step.

use maulstick_types::EditFields;
use maulstick_types::values::{BrushName, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Redo the newest undone step
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Redo {
    /// Brush whose newest step is meant, unless something was painted over it [default: the newest step
    /// of all brushes]
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, value_name = "BRUSH"))]
    pub brush: Option<BrushName>,
}

impl EditFields for Redo {
    const NAME: &'static str = "redo";
}

impl Form for Redo {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["painting", "redo", "--brush", "main"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("redo", "painting"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            brush: Some(BrushName::main()),
        })
    }
}

impl PaintingEdit for Redo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.redo(self.brush.as_deref()).map(Applied::Step)
    }

    fn log_words(&self) -> String {
        format!("redo{}", words::of_brush(self.brush.as_ref()))
    }

    fn reply(&self) -> Option<&'static str> {
        Some("redone: ")
    }
}
