//! Sizes a surface.

use maulstick_types::EditFields;
use maulstick_types::scene::CANVAS;
#[cfg(feature = "cli")]
use maulstick_types::values::Quantity as _;
use maulstick_types::values::{StainThickness, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Size the canvas
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Size {
    /// Thickness of paint that cannot be brushed off
    #[serde(alias = "stain_um")]
    #[cfg_attr(
        feature = "cli",
        arg(value_name = "STAIN_UM", help = StainThickness::option_help(), allow_negative_numbers = true)
    )]
    pub stain: StainThickness,
    /// The surface.
    #[serde(default = "read::canvas")]
    #[cfg_attr(feature = "cli", arg(skip = CANVAS))]
    pub surface: u32,
}

impl EditFields for Size {
    const NAME: &'static str = "size";
}

impl Form for Size {
    const STEPS: &'static [StepForm] = &[StepForm::new("stain_um", &[], "{ stain_um = 3 }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["canvas", "size", "3"]);
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

impl PaintingEdit for Size {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let desk = &mut painting.bench.desk;
        desk.change_surface(self.surface, |own| own.stain_m = self.stain.get())?;
        Ok(Applied::Done)
    }

    fn log_words(&self) -> String {
        let stain = words::um(self.stain.get());
        format!(
            "size the {}: {stain} µm stain",
            words::surface(self.surface)
        )
    }
}
