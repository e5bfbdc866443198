//! Changes the tooth of a surface.

use maulstick_canvas::assets::Assets;
use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{MaterialName, ValueError};

use crate::edits::surface::is_held;
use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::EditError;
use crate::painting::Painting;
use crate::setup::{PaintingSetup, relief_called};

/// Change the tooth of the canvas
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
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

fn first() -> u64 {
    1
}

impl EditFields for Tooth {
    const NAME: &'static str = "tooth";
}

impl Form for Tooth {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "tooth",
        &["seed", "width_mm", "depth_um"],
        "{ tooth = \"linen\", seed = 2 }, { tooth = \"weave.png\", width_mm = 60, depth_um = 80 }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> =
        Some(&["canvas", "tooth", "linen", "--seed", "2"]);
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

impl PaintingEdit for Tooth {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let bench = &mut painting.bench;
        let desk = &bench.desk;
        let on = desk.surfaces.at(self.surface)?;
        let cell_m = desk.surfaces[on].cell_m;
        relief_called(&self.tooth, self.seed, cell_m, &desk.optics.assets)?;
        bench.change_material(StepName::Tooth, on, |material| {
            material.tooth = self.tooth.to_string();
            material.tooth_seed = self.seed;
        });
        Ok(Applied::Done)
    }

    fn check_names(&self) -> Result<(), EditError> {
        if is_held(&self.tooth) {
            return Ok(());
        }
        let cell_m = PaintingSetup::default().cell_m;
        relief_called(&self.tooth, self.seed, cell_m, &Assets::default())?;
        Ok(())
    }

    fn log_words(&self) -> String {
        let surface = words::surface(self.surface);
        format!(
            "give the {surface} another tooth: {}, seed {}",
            self.tooth, self.seed
        )
    }
}
