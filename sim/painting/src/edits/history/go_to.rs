//! Undoes or redoes steps up to one of them.

use maulstick_types::EditFields;
use maulstick_types::values::ValueError;

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Undo or redo steps until one of them is the newest that is done
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GoTo {
    /// Number of that step; 0 is the beginning.
    pub step: u64,
}

impl EditFields for GoTo {
    const NAME: &'static str = "go_to";
}

impl Form for GoTo {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> = None;

    fn example() -> Result<Self, ValueError> {
        Ok(Self { step: 7 })
    }
}

impl PaintingEdit for GoTo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.go_to(self.step).map(Applied::Step)
    }

    fn log_words(&self) -> String {
        format!("go to step {}", self.step)
    }
}
