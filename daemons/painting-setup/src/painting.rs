//! The painting that the settings of a rig ask for.

use maulstick_models::{AUTO, AutoRole, auto_model, model_called};
use maulstick_optics::{Illuminant, PaintError, PaintLibrary};
use maulstick_painting::PaintingSetup;
use maulstick_rig::UserError;
use maulstick_rig::config::{LightSection, RigConfig};
use maulstick_types::Mixture;
use maulstick_types::scene::Light;

use crate::refusal::refused;
use crate::surface::environment::environment;
use crate::surface::ground::GroundFile;
use crate::viewing::illuminant;

/// The light of the rig's settings, with the spectrum and the surroundings of files if it names them.
fn light(section: &LightSection) -> Result<Light, UserError> {
    let mut light = section.light();
    if Illuminant::named(&section.illuminant).is_none() {
        let found = illuminant(&section.illuminant).map_err(|fault| match fault.place {
            None => fault.at("illuminant of [light], or --illuminant"),
            Some(_) => fault,
        })?;
        light.illuminant = found.name;
        light.spectrum = found.power.0.to_vec();
    }
    light.environment = environment(&section.environment).map_err(|fault| match fault.place {
        None => fault.at("environment of [light], or --environment"),
        Some(_) => fault,
    })?;
    light.check()?;
    Ok(light)
}

/// Paints of the wells: as the settings say. Without wells in the settings, the painter's own paints lie in them in the
/// order of their file.
fn wells(config: &RigConfig, library: &PaintLibrary) -> Vec<String> {
    let default = RigConfig::default().palette.wells;
    let wells = &config.palette.wells;
    let all_known = wells.iter().all(|name| library.find(name).is_ok());
    if all_known || config.paint.paints.is_none() || *wells != default {
        return wells.clone();
    }
    let names = library.paints().iter().map(|paint| paint.name.clone());
    names.take(default.len()).collect()
}

/// The name of the canvas's paint model: `auto` begins with one that it may propose to change later.
fn canvas_model(name: &str) -> Result<String, UserError> {
    match name {
        AUTO => Ok(auto_model(AutoRole::First).name.to_owned()),
        name => model(name, "model of [paint], or --model"),
    }
}

/// The name of a paint model.
fn model(name: &str, place: &str) -> Result<String, UserError> {
    let entry = model_called(name).map_err(|error| refused(error).at(place))?;
    Ok(entry.name.to_owned())
}

/// The painting that the rig's settings ask for.
///
/// # Errors
/// A [`UserError`] for a well that is no mixture, an invalid light, an unknown model or ground.
pub fn painting_setup(
    config: &RigConfig,
    library: &PaintLibrary,
) -> Result<PaintingSetup, UserError> {
    let canvas = &config.canvas;
    let wells = wells(config, library);
    let wells = wells
        .iter()
        .map(|text| {
            text.parse::<Mixture>()
                .map_err(|error| refused(PaintError::from(error)).at("[palette] wells"))
        })
        .collect::<Result<_, _>>()?;
    let mut setup = PaintingSetup {
        cells: canvas.cells(),
        cell_m: canvas.cell_mm * 1e-3,
        tooth: canvas.tooth.clone(),
        tooth_seed: canvas.tooth_seed,
        stain_m: canvas.stain_um * 1e-6,
        piles_last: config.palette.piles == "last",
        wells,
        light: light(&config.light)?,
        exposure: config.light.exposure,
        model: canvas_model(&config.paint.model)?,
        palette_model: model(&config.palette.model, "model of [palette]")?,
        ..PaintingSetup::default()
    };
    GroundFile::read(&canvas.ground)?.prime(&mut setup)?;
    Ok(setup)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PaintingOptions, library};

    #[test]
    fn a_paint_model_is_chosen_for_a_new_painting_alone() {
        let setup = |canvas: &str, palette: &str| {
            let options = PaintingOptions {
                model: Some(canvas.into()),
                ..Default::default()
            };
            assert_eq!(options.for_a_new_one(), Some("--model"));
            let mut config = RigConfig::default();
            palette.clone_into(&mut config.palette.model);
            options.apply(&mut config)?;
            painting_setup(&config, &library()?).map(|setup| [setup.model, setup.palette_model])
        };
        let marker = ["marker", "impasto"].map(str::to_owned);
        let auto = ["impasto", "impasto"].map(str::to_owned);
        assert_eq!(setup("auto", "impasto"), Ok(auto));
        assert!(
            setup("impasto", "auto").is_err(),
            "nobody falls behind on a palette"
        );
        assert_eq!(setup("marker", "impasto"), Ok(marker));
        for (canvas, palette, place) in [
            ("makrer", "impasto", "model of [paint], or --model"),
            ("impasto", "makrer", "model of [palette]"),
        ] {
            let fault = setup(canvas, palette).expect_err("misspelt").to_string();
            let told = fault.contains("'makrer'") && fault.contains("did you mean 'marker'");
            assert!(told && fault.contains(place), "{fault}");
        }
    }
}
