//! Changes the ground of a surface.

use std::str::FromStr;

use maulstick_appearance::ground::{add_spectrum, check_ground};
use maulstick_canvas::assets::{Assets, SPECTRUM};
use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{MaterialName, SpectrumText, ValueError};

use crate::edits::surface::is_held;
use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;

/// Source of a ground.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
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

impl FromStr for GroundSource {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        MaterialName::new(text).map(|name| Self::Named { name })
    }
}

/// Change the ground of the canvas
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
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

impl EditFields for Ground {
    const NAME: &'static str = "ground";
}

impl Form for Ground {
    const STEPS: &'static [StepForm] = &[StepForm::new("ground", &[], "{ ground = \"grey\" }")];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["canvas", "ground", "grey"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("ground", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Self::named(CANVAS, "grey")
    }
}

impl PaintingEdit for Ground {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let on = bench.desk.surfaces.at(self.surface)?;
        let assets = &mut bench.desk.optics.assets;
        let ground = match &self.ground {
            GroundSource::Named { name } => name.to_string(),
            GroundSource::Spectrum { csv } => {
                format!("{SPECTRUM}{}", add_spectrum(assets, csv)?)
            }
        };
        check_ground(&ground, assets)?;
        bench.change_material(StepName::Ground, on, |material| material.ground = ground);
        Ok(Applied::Done)
    }

    fn check_names(&self) -> Result<(), EditError> {
        if let GroundSource::Named { name } = &self.ground
            && !is_held(name)
        {
            check_ground(name, &Assets::default())?;
        }
        Ok(())
    }

    fn log_words(&self) -> String {
        let ground = match &self.ground {
            GroundSource::Named { name } => name.as_str(),
            GroundSource::Spectrum { .. } => "a measured one",
        };
        let surface = words::surface(self.surface);
        format!("give the {surface} another ground: {ground}")
    }
}
