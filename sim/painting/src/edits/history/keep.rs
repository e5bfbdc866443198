//! Keeps the painting as a version.
use maulstick_types::EditFields;
use maulstick_types::values::{ValueError, VersionName};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Keep the painting as a version
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Keep {
    /// Name of the version.
    #[serde(alias = "keep")]
    pub name: VersionName,
}

impl EditFields for Keep {
    const NAME: &'static str = "keep";
}

impl Form for Keep {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "keep",
        &[],
        "{ keep = \"before the glaze\" }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["painting", "versions", "--keep", "before the glaze"]);

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            name: VersionName::new("before the glaze")?,
        })
    }
}

impl PaintingEdit for Keep {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.bench.keep(&self.name)?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("keep the version '{}'", self.name)
    }
}
