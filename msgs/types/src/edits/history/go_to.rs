//! Takes steps back, or does them again, up to one of them.

use crate::edits::{Form, StepForm};
use crate::values::ValueError;
use crate::wire::define::wire_struct;

wire_struct! {
    /// Undo or redo steps until one of them is the newest that is done
    pub struct GoTo {
        /// Number of that step; 0 is the beginning.
        pub step: u64,
    }
}

impl Form for GoTo {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = None;

    fn example() -> Result<Self, ValueError> {
        Ok(Self { step: 7 })
    }
}
