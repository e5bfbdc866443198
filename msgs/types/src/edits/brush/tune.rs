//! Makes a brush stiffer or softer than its file says.

use crate::edits::{Form, StepForm};
use crate::scene::Tuning;
use crate::values::{BrushName, Stiffness, ValueError, Wetness};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Make a brush stiffer or softer
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Tune {
        /// Factor on the stiffness in the brush file
        #[cfg_attr(feature = "cli", arg(long, default_value = "1", allow_negative_numbers = true))]
        pub stiffness: Stiffness,
        /// Wetness, from 0 (as in the brush file) to 1 (soaked: half as stiff)
        #[cfg_attr(feature = "cli", arg(long, default_value = "0", allow_negative_numbers = true))]
        pub wetness: Wetness,
        /// Brush of the rig
        #[cfg_attr(feature = "cli", arg(long, default_value = "main"))]
        pub brush: BrushName,
    }
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
    type Error = crate::values::ValueError;

    fn try_from(tuning: &Tuning) -> Result<Self, Self::Error> {
        Ok(Self {
            stiffness: Stiffness::new(tuning.stiffness)?,
            wetness: Wetness::new(tuning.wetness)?,
            brush: BrushName::new(&*tuning.brush)?,
        })
    }
}

impl Form for Tune {
    const STEPS: &'static [StepForm] = &[];
    const ARGUMENTS: Option<&'static str> = Some("brush|tune|--stiffness|1.5|--wetness|0.5");
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
