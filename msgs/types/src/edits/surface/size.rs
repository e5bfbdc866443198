//! Sizes a surface.

use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{StainThickness, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Size the canvas
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Size {
        /// Thickness of paint that cannot be brushed off, µm; 0: a well-sized canvas
        #[serde(rename = "stain_um")]
        #[cfg_attr(feature = "cli", arg(value_name = "STAIN_UM", allow_negative_numbers = true))]
        pub stain: StainThickness,
        /// The surface.
        #[serde(default = "read::canvas")]
        #[cfg_attr(feature = "cli", arg(skip = CANVAS))]
        pub surface: u32,
    }
}

impl Form for Size {
    const STEPS: &'static [StepForm] = &[StepForm::new("stain_um", &[], "{ stain_um = 3 }")];
    const ARGUMENTS: Option<&'static str> = Some("canvas|size|3");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("size", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            stain: StainThickness::in_unit(3.0)?,
            surface: CANVAS,
        })
    }
}
