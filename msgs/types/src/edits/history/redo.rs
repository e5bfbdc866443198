//! Does the newest undone step again.

use crate::edits::{Form, StepForm};
use crate::values::{BrushName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Redo the newest undone step
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Redo {
        /// Brush whose newest step is meant, unless something was painted over it [default: the newest step
        /// of all brushes]
        #[serde(default)]
        #[cfg_attr(feature = "cli", arg(long, value_name = "BRUSH"))]
        pub brush: Option<BrushName>,
    }
}

impl Form for Redo {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = Some("painting|redo|--brush|main");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("redo", "painting"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            brush: Some(BrushName::main()),
        })
    }
}
