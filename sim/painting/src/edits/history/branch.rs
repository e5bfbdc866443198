//! Begins a version from another one.

use maulstick_types::EditFields;
use maulstick_types::values::{ValueError, VersionName};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Begin a version from another one, and return the painting to it
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Branch {
    /// Name of the other version.
    pub from: VersionName,
    /// Name of the new version.
    pub name: VersionName,
}

impl EditFields for Branch {
    const NAME: &'static str = "branch";
}

impl Form for Branch {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["painting", "versions", "--branch", "sketch", "warm"]);

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            from: VersionName::new("sketch")?,
            name: VersionName::new("warm")?,
        })
    }
}

impl PaintingEdit for Branch {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        bench.branch(clock, &self.from, &self.name)?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("branch '{}' off the version '{}'", self.name, self.from)
    }
}
