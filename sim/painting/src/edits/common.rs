//! Edits as windows, commands and scripts build them, each by a function.

use maulstick_types::scene::{BrushHandling, CANVAS, Light, PALETTE, Tuning, Well};
use maulstick_types::values::{
    BrushName, Distance, MaterialName, ModelName, Share, ThinnerShare, ValueError, VersionName,
};
use maulstick_types::{Edit, Mixture, Pose};

use super::{
    Clean, Convert, Dry, Ground, GroundSource, Handle, Load, LoadFrom, Place, Redo, Relight,
    ReturnTo, Scrape, StopDrying, Tooth, Tune, Undo, Wells,
};

/// Takes the last step back.
#[must_use]
pub fn undo() -> Undo {
    Undo { brush: None }
}

/// Does again what was taken back last.
#[must_use]
pub fn redo() -> Redo {
    Redo { brush: None }
}

/// Makes the painting as it was in a version.
#[must_use]
pub fn return_to(name: VersionName) -> ReturnTo {
    ReturnTo { name }
}

/// Dries a share of the whole canvas.
#[must_use]
pub fn dry(share: Share) -> Dry {
    let whole = Dry::whole(CANVAS);
    Dry { share, ..whole }
}

/// Lets the wet paint of the canvas stay wet.
#[must_use]
pub fn stop_drying() -> StopDrying {
    StopDrying { surface: CANVAS }
}

/// Scrapes the palette.
#[must_use]
pub fn scrape() -> Scrape {
    Scrape {
        region: None,
        surface: PALETTE,
    }
}

/// Another light, whose own exposure stays.
#[must_use]
pub fn relight(light: Light) -> Relight {
    let expose = false;
    Relight { light, expose }
}

/// Another light, whose exposure is chosen so that the bare canvas does not clip.
#[must_use]
pub fn relight_exposed(light: Light) -> Relight {
    let expose = true;
    Relight { light, expose }
}

/// Converts a surface to another paint model.
#[must_use]
pub fn convert(surface: u32, model: ModelName) -> Convert {
    Convert { model, surface }
}

/// A ground of the canvas by its name.
///
/// # Errors
/// [`ValueError`] for a name that is blank or too long.
pub fn ground(name: &str) -> Result<Ground, ValueError> {
    Ground::named(CANVAS, name)
}

/// A ground of the canvas by its reflectances, a CSV file of nm,reflectance.
///
/// # Errors
/// [`ValueError`] for a text that is too long.
pub fn measured_ground(csv: &str) -> Result<Ground, ValueError> {
    Ground::spectrum(CANVAS, csv)
}

/// Name of the ground that an edit asks for; before a front end has read it, perhaps the path of a file.
#[must_use]
pub fn ground_name(edit: &Edit) -> Option<MaterialName> {
    match edit.get::<Ground>()?.ground {
        GroundSource::Named { name } => Some(name),
        GroundSource::Spectrum { .. } => None,
    }
}

/// A tooth of the canvas that does not depend on a seed.
///
/// # Errors
/// [`ValueError`] for a name that is blank or too long.
pub fn tooth(name: String) -> Result<Tooth, ValueError> {
    Ok(Tooth {
        tooth: MaterialName::new(name)?,
        seed: 1,
        surface: CANVAS,
    })
}

/// Cleans a brush.
///
/// # Errors
/// [`ValueError`] for a name that no brush may have.
pub fn clean(brush: &str) -> Result<Clean, ValueError> {
    let brush = BrushName::new(brush)?;
    Ok(Clean { brush })
}

/// Loads a brush with a mixture, and with another one beside it.
///
/// # Errors
/// As [`clean`].
pub fn load(brush: &str, mixture: Mixture, beside: Option<Mixture>) -> Result<Load, ValueError> {
    Ok(Load {
        mixture,
        beside,
        brush: BrushName::new(brush)?,
    })
}

/// Brush, mixture and the one beside it, of an edit that loads a brush.
#[must_use]
pub fn loaded(edit: &Edit) -> Option<(String, Mixture, Option<Mixture>)> {
    let load: Load = edit.get()?;
    Some((load.brush.into(), load.mixture, load.beside))
}

/// Loads a brush with the mixture at a place of a surface, m.
///
/// # Errors
/// [`ValueError`] for a name that no brush may have, and a place out of reach.
pub fn load_from(
    brush: &str,
    (surface, [x, y]): (u32, [f64; 2]),
    thinner: ThinnerShare,
) -> Result<LoadFrom, ValueError> {
    Ok(LoadFrom {
        x: Distance::new(x)?,
        y: Distance::new(y)?,
        surface,
        thinner,
        brush: BrushName::new(brush)?,
    })
}

/// Sets mode and limits of a brush.
///
/// # Errors
/// [`ValueError`] for a number out of range.
pub fn handle(handling: &BrushHandling) -> Result<Handle, ValueError> {
    Handle::try_from(handling)
}

/// Sets stiffness and wetness of a brush.
///
/// # Errors
/// As [`handle`].
pub fn tune(tuning: &Tuning) -> Result<Tune, ValueError> {
    Tune::try_from(tuning)
}

/// Places the palette.
///
/// # Errors
/// As [`Place::new`].
pub fn lay_palette(pose: Pose, zoom: f64) -> Result<Place, ValueError> {
    Place::new(PALETTE, pose, zoom)
}

/// Replaces the wells of the palette.
///
/// # Errors
/// As [`Wells::new`].
pub fn lay_wells(wells: Vec<Well>) -> Result<Wells, ValueError> {
    Wells::new(PALETTE, wells)
}
