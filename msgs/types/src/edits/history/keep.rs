//! Keeps the painting as a version.

use crate::edits::{Form, StepForm};
use crate::values::{ValueError, VersionName};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Keep the painting as a version
    pub struct Keep {
        /// Name of the version.
        #[serde(rename = "keep")]
        pub name: VersionName,
    }
}

impl Form for Keep {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "keep",
        &[],
        "{ keep = \"before the glaze\" }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("painting|versions|--keep|before the glaze");

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            name: VersionName::new("before the glaze")?,
        })
    }
}
