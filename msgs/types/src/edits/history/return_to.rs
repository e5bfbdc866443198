//! Makes the painting as it was in a version.

use crate::edits::{Form, StepForm};
use crate::values::{ValueError, VersionName};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Return the painting to a version; this can be undone
    pub struct ReturnTo {
        /// Name of the version.
        #[serde(rename = "return")]
        pub name: VersionName,
    }
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
