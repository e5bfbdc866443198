//! Deletes a version.
use maulstick_types::EditFields;
use maulstick_types::values::{ValueError, VersionName};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Delete a version
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Forget {
    /// Name of the version.
    pub name: VersionName,
}

impl EditFields for Forget {
    const NAME: &'static str = "forget";
}

impl Form for Forget {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["painting", "versions", "--forget", "before the glaze"]);

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            name: VersionName::new("before the glaze")?,
        })
    }
}

impl PaintingEdit for Forget {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.bench.forget(&self.name)?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("forget the version '{}'", self.name)
    }
}
