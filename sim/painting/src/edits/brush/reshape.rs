//! Brings a bent brush back into shape.

use maulstick_types::EditFields;
use maulstick_types::values::{BrushName, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Bring a bent brush back into shape
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Reshape {
    /// Brush of the rig
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

impl EditFields for Reshape {
    const NAME: &'static str = "reshape";
}

impl Form for Reshape {
    const STEPS: &'static [StepForm] = &[StepForm::switch("reshape", &[], "{ reshape = true }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["brush", "reshape"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("reshape", "brush"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            brush: BrushName::main(),
        })
    }
}

impl PaintingEdit for Reshape {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let brush = bench.brushes.at(&self.brush)?;
        bench.brushes[brush].reshape(&mut bench.desk.scene);
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("reshape {}", self.brush)
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }
}
