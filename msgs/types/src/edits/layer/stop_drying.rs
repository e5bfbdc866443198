//! Ends a drying.

use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::ValueError;
use crate::wire::define::wire_struct;

wire_struct! {
    /// Stop a running drying; what is still wet stays wet
    pub struct StopDrying {
        /// The surface.
        #[serde(default = "read::canvas")]
        pub surface: u32,
    }
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
