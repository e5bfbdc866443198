//! Ends a drying.

use maulstick_canvas::EditError;
use maulstick_types::EditFields;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::ValueError;

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::painting::Painting;

/// Stop a running drying; what is still wet stays wet
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StopDrying {
    /// The surface.
    #[serde(default = "read::canvas")]
    pub surface: u32,
}

impl EditFields for StopDrying {
    const NAME: &'static str = "stop_drying";
}

impl Form for StopDrying {
    const STEPS: &'static [StepForm] = &[StepForm::switch(
        "stop_drying",
        &[],
        "{ stop_drying = true }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("layer|dry|--stop");

    fn example() -> Result<Self, ValueError> {
        Ok(Self { surface: CANVAS })
    }
}

impl PaintingEdit for StopDrying {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        if painting.clock.stop(Some(self.surface)) {
            Ok(Applied::Done)
        } else {
            Err(EditError::NotDrying)
        }
    }

    fn log_words(&self) -> String {
        format!("stop drying the {}", words::surface(self.surface))
    }

    fn reply(&self) -> Option<&'static str> {
        Some("the drying is ended")
    }
}
