//! Gives the paint of a surface another model.

use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{ModelName, ValueError};
use crate::wire::define::wire_struct;

wire_struct! {
    /// Convert the canvas to another paint model
    ///
    /// Volumes stay as they are, cell by cell. Where the models show paint in other colours, the paints of each cell are
    /// chosen anew from those of the painting, as near as they come.
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Convert {
        /// Name of the paint model: impasto, dab, stokes or marker
        pub model: ModelName,
        /// Convert the palette instead of the canvas
        #[serde(default = "read::canvas")]
        #[cfg_attr(feature = "cli", arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface()))]
        pub surface: u32,
    }
}

impl Form for Convert {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "model",
        &["surface"],
        "{ model = \"dab\" }, { model = \"impasto\", surface = 1 }",
    )];
    const ARGUMENTS: Option<&'static str> = Some("canvas|convert|dab");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("convert", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            model: ModelName::new("dab")?,
            surface: CANVAS,
        })
    }
}
