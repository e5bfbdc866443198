//! Takes the newest step back.

use crate::edits::{Form, StepForm};
use crate::values::{BrushName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Undo the newest step
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Undo {
        /// Brush whose newest step is meant, unless something was painted over it [default: the newest step
        /// of all brushes]
        #[serde(default)]
        #[cfg_attr(feature = "cli", arg(long, value_name = "BRUSH"))]
        pub brush: Option<BrushName>,
    }
}

impl Form for Undo {
    const STEPS: &'static [StepForm] = &[StepForm::new("undo", &[], "{ undo = 1 }")];
    const ARGUMENTS: Option<&'static str> = Some("painting|undo");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("undo", "painting"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self { brush: None })
    }
}
