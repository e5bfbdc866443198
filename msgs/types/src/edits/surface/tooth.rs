//! Gives a surface another tooth.

use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{MaterialName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Change the tooth of the canvas
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Tooth {
        /// Tooth: linen, cotton, panel, paper
        pub tooth: MaterialName,
        /// Number of the pattern: another piece of the same cloth
        #[serde(default = "first")]
        #[cfg_attr(feature = "cli", arg(long, default_value_t = 1))]
        pub seed: u64,
        /// The surface.
        #[serde(default = "read::canvas")]
        #[cfg_attr(feature = "cli", arg(skip = CANVAS))]
        pub surface: u32,
    }
}

fn first() -> u64 {
    1
}

impl Form for Tooth {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "tooth",
        &["seed", "width_mm", "depth_um"],
        "{ tooth = \"linen\", seed = 2 }, { tooth = \"weave.png\", width_mm = 60, depth_um = 80 }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("canvas|tooth|linen|--seed|2");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("tooth", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            tooth: MaterialName::new("linen")?,
            seed: 2,
            surface: CANVAS,
        })
    }
}
