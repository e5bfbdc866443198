//! Undoes the newest step.
use maulstick_canvas::EditError;
use maulstick_types::EditFields;
use maulstick_types::values::{BrushName, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::painting::Painting;

/// Undo the newest step
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Undo {
    /// Brush whose newest step is meant, unless something was painted over it [default: the newest step
    /// of all brushes]
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, value_name = "BRUSH"))]
    pub brush: Option<BrushName>,
}

impl EditFields for Undo {
    const NAME: &'static str = "undo";
}

impl Form for Undo {
    const STEPS: &'static [StepForm] = &[StepForm::new("undo", &[], "{ undo = 1 }")];
    const ARGUMENTS: Option<&'static str> = Some("painting|undo");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("undo", "painting"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self { brush: None })
    }
}

impl PaintingEdit for Undo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.undo(self.brush.as_deref()).map(Applied::Step)
    }

    fn log_words(&self) -> String {
        format!("undo{}", words::of_brush(self.brush.as_ref()))
    }

    fn reply(&self) -> Option<&'static str> {
        Some("undone: ")
    }
}
