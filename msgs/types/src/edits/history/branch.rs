//! Begins a version from another one.

use crate::define::wire_struct;
use crate::edits::{Form, StepForm};
use crate::values::{ValueError, VersionName};

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
