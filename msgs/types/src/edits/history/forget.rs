//! Deletes a version.

use crate::edits::{Form, StepForm};
use crate::values::{ValueError, VersionName};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Delete a version
    pub struct Forget {
        /// Name of the version.
        pub name: VersionName,
    }
}

impl Form for Forget {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = Some("painting|versions|--forget|before the glaze");

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            name: VersionName::new("before the glaze")?,
        })
    }
}
