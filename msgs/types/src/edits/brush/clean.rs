//! Takes all paint off a brush.

use crate::edits::{Form, StepForm};
use crate::values::{BrushName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Clean a brush
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Clean {
        /// Brush of the rig
        #[serde(default)]
        #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
        pub brush: BrushName,
    }
}

impl Form for Clean {
    const STEPS: &'static [StepForm] = &[StepForm::switch("clean", &[], "{ clean = true }")];
    const ARGUMENTS: Option<&'static str> = Some("brush|clean");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("clean", "brush"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            brush: BrushName::main(),
        })
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }
}
