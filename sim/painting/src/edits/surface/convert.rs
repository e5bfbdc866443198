//! Converts the paint of a surface to another model.

use maulstick_models::{AutoRole, auto_model, model_called};
use maulstick_types::EditFields;
use maulstick_types::paint::StepName;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{ModelName, ValueError};

use crate::edits::{Applied, Form, PaintingEdit, StepForm, read, words};
use crate::error::{EditError, SurfaceError};
use crate::history::materials;
use crate::painting::Painting;

/// Convert the canvas to another paint model
///
/// Each cell keeps its volumes. Where the models differ in colour, the paints of each cell are fitted from those of the
/// painting.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Convert {
    /// Name of the paint model: impasto, dab, stokes or marker
    pub model: ModelName,
    /// Convert the palette instead of the canvas
    #[serde(default = "read::canvas")]
    #[cfg_attr(feature = "cli", arg(long = "palette", action = clap::ArgAction::SetTrue, value_parser = read::surface()))]
    pub surface: u32,
}

impl EditFields for Convert {
    const NAME: &'static str = "convert";
}

impl Form for Convert {
    const STEPS: &'static [StepForm] = &[StepForm::new(
        "model",
        &["surface"],
        "{ model = \"dab\" }, { model = \"impasto\", surface = 1 }",
    )];
    const ARGUMENTS: Option<&'static [&'static str]> = Some(&["canvas", "convert", "dab"]);
    #[cfg(feature = "cli")]
    const COMMAND: Option<crate::edits::CommandForm> =
        Some(crate::edits::CommandForm::of::<Self>("convert", "canvas"));

    fn example() -> Result<Self, ValueError> {
        Ok(Self {
            model: ModelName::new(auto_model(AutoRole::Lighter).name)?,
            surface: CANVAS,
        })
    }
}

impl PaintingEdit for Convert {
    /// Converts a surface to another paint model, as one step that can be undone. Each cell keeps the volume of each of
    /// its layers; where the models differ in colour, its paints are fitted to the old appearance. Loads of brushes are
    /// unchanged.
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        let Painting { bench, clock } = painting;
        let on = bench.desk.surfaces.at(self.surface)?;
        let to = model_called(&self.model)?;
        let from = bench.desk.surfaces[on].model;
        if std::ptr::eq(from, to) {
            return Err(SurfaceError::SameModel(to.name).into());
        }
        bench.close_windows();
        clock.stop(Some(self.surface));
        let is_painted = bench.desk.surfaces[on].tiles().next().is_some();
        let colouring = to.shown.colouring();
        if from.shown.colouring() != colouring && is_painted {
            bench.desk.take_up_wells()?;
        }
        bench.begin_step(StepName::Model, None);
        let models = bench.desk.surfaces.model_names();
        bench.past.history.name_models(&models);
        bench.past.versions.name_models(&models);
        let (tiles, distance) = bench.desk.converted(on, colouring);
        bench.put_converted(on, tiles);
        let mut materials = materials(&bench.desk.scene);
        to.name.clone_into(&mut materials[on].model);
        bench.desk.set_materials(&materials);
        bench.end_own_step();
        let cell_m = bench.desk.surfaces[on].cell_m;
        Ok(Applied::Converted { distance, cell_m })
    }

    fn log_words(&self) -> String {
        let surface = words::surface(self.surface);
        format!("convert the {surface} to {}", self.model)
    }

    fn reply(&self) -> Option<&'static str> {
        Some("converted: ")
    }
}
