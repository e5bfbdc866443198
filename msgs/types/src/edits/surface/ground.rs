//! Gives a surface another ground.

use std::str::FromStr;

use crate::edits::{Form, StepForm, read};
use crate::scene::CANVAS;
use crate::values::{MaterialName, SpectrumText, ValueError};
use crate::wire::define::{wire_enum, wire_struct};

wire_enum! {
    /// What a ground is made of.
    pub enum GroundSource {
        /// A ground of this name; before a front end has read it, perhaps the path of a file.
        Named {
            /// Its name.
            name: MaterialName,
        },
        /// A measured reflectance, which the painting holds from then on.
        Spectrum {
            /// A CSV file of nm,reflectance.
            csv: SpectrumText,
        },
    }
}

impl FromStr for GroundSource {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        MaterialName::new(text).map(|name| Self::Named { name })
    }
}

wire_struct! {
    /// Change the ground of the canvas
    #[cfg_attr(feature = "cli", derive(clap::Args))]
    pub struct Ground {
        /// Ground: gesso, grey, black, or a CSV file of nm,reflectance
        #[serde(deserialize_with = "read::text")]
        #[cfg_attr(feature = "cli", arg(value_name = "NAME|FILE"))]
        pub ground: GroundSource,
        /// The surface.
        #[serde(default = "read::canvas")]
        #[cfg_attr(feature = "cli", arg(skip = CANVAS))]
        pub surface: u32,
    }
}

impl Ground {
    /// A ground of a name.
    ///
    /// # Errors
    /// [`ValueError`] for a name that is blank or too long.
    pub fn named(surface: u32, name: &str) -> Result<Self, ValueError> {
        Ok(Self {
            ground: name.parse()?,
            surface,
        })
    }

    /// A ground of a measured reflectance.
    ///
    /// # Errors
    /// [`ValueError`] for a text that is too long.
    pub fn spectrum(surface: u32, csv: &str) -> Result<Self, ValueError> {
        let csv = SpectrumText::new(csv)?;
        Ok(Self {
            ground: GroundSource::Spectrum { csv },
            surface,
        })
    }
}

impl Form for Ground {
    const STEPS: &'static [StepForm] = &[StepForm::new("ground", &[], "{ ground = \"grey\" }")];
    const ARGUMENTS: Option<&'static str> = Some("canvas|ground|grey");
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("ground", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Self::named(CANVAS, "grey")
    }
}
