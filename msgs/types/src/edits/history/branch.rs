//! Begins a version from another one.

use crate::edits::{Form, StepForm};
use crate::values::{ValueError, VersionName};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Begin a version from another one, and return the painting to it
    pub struct Branch {
        /// Name of the other version.
        pub from: VersionName,
        /// Name of the new version.
        pub name: VersionName,
    }
}

impl Form for Branch {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = Some("painting|versions|--branch|sketch|warm");

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            from: VersionName::new("sketch")?,
            name: VersionName::new("warm")?,
        })
    }
}
