//! Takes all paint off a brush, whose bend goes with it.

use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::values::{BrushName, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm};
use crate::error::EditError;
use crate::painting::Painting;

/// Clean a brush
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Clean {
    /// Brush of the rig
    #[serde(default)]
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

impl EditFields for Clean {
    const NAME: &'static str = "clean";
}

impl Form for Clean {
    const STEPS: &'static [StepForm] = &[StepForm::switch("clean", &[], "{ clean = true }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["brush", "clean"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("clean", "brush"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            brush: BrushName::main(),
        })
    }
}

impl PaintingEdit for Clean {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let brush = bench.brushes.at(&self.brush)?;
        bench.begin_step(StepName::Clean, Some(brush));
        bench.brushes[brush].empty(&mut bench.accounts.ledger);
        bench.brushes[brush].reshape(&mut bench.desk.scene);
        bench.end_step_of(brush);
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!("clean {}", self.brush)
    }

    fn brush_mut(&mut self) -> Option<&mut BrushName> {
        Some(&mut self.brush)
    }
}
