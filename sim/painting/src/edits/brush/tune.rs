//! Makes a brush stiffer or softer than its file says.

use maulstick_types::EditFields;
use maulstick_types::scene::Tuning;
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::{BrushName, Stiffness, ValueError, Wetness};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Make a brush stiffer or softer
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Tune {
    /// Factor on the stiffness in the brush file
    #[cfg_attr(
        feature = "cli",
        arg(long, help = Stiffness::option_help(), default_value = "1", allow_negative_numbers = true)
    )]
    pub stiffness: Stiffness,
    /// Wetness of its head
    #[cfg_attr(
        feature = "cli",
        arg(long, help = Wetness::option_help(), default_value = "0", allow_negative_numbers = true)
    )]
    pub wetness: Wetness,
    /// Brush of the rig
    #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
    pub brush: BrushName,
}

impl From<Tune> for Tuning {
    fn from(edit: Tune) -> Self {
        Self {
            brush: edit.brush.into(),
            stiffness: edit.stiffness.get(),
            wetness: edit.wetness.get(),
        }
    }
}

impl TryFrom<&Tuning> for Tune {
    type Error = maulstick_types::values::ValueError;

    fn try_from(tuning: &Tuning) -> Result<Self, Self::Error> {
        Ok(Self {
            stiffness: Stiffness::new(tuning.stiffness)?,
            wetness: Wetness::new(tuning.wetness)?,
            brush: BrushName::new(&*tuning.brush)?,
        })
    }
}

impl EditFields for Tune {
    const NAME: &'static str = "tune";
}

impl Form for Tune {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["brush", "tune", "--stiffness", "1.5", "--wetness", "0.5"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("tune", "brush"));

    fn example() -> Result<Self, ValueError> {
        let tuning = Tuning {
            brush: "main".to_owned(),
            stiffness: 1.5,
            wetness: 0.5,
        };
        Self::try_from(&tuning)
    }
}

impl PaintingEdit for Tune {
    /// Makes a brush stiffer or softer; its solver is informed by the scene.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.bench.brushes.at(&self.brush)?;
        let scene = &mut painting.bench.desk.scene;
        let tunings = &mut scene.tunings;
        tunings.retain(|other| other.brush != self.brush.as_str());
        tunings.push(self.clone().into());
        scene.version += 1;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        format!(
            "make {} {} times as stiff, {} wet",
            self.brush,
            words::number(self.stiffness.get()),
            words::percent(self.wetness.get())
        )
    }
}
