//! Restores a version of the painting.
use maulstick_canvas::EditError;
use maulstick_types::EditFields;
use maulstick_types::values::{ValueError, VersionName};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::painting::Painting;

/// Return the painting to a version; this can be undone
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ReturnTo {
    /// Name of the version.
    #[serde(alias = "return")]
    pub name: VersionName,
}

impl EditFields for ReturnTo {
    const NAME: &'static str = "return_to";
}

impl Form for ReturnTo {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "return",
        &[],
        "{ return = \"before the glaze\" }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("painting|versions|--return|before the glaze");

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            name: VersionName::new("before the glaze")?,
        })
    }
}

impl PaintingEdit for ReturnTo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.return_to(&self.name).map(|()| Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("return to the version '{}'", self.name)
    }
}
