//! Edits that keys, gestures and dialogs ask for; those of a control are in its panel.

use maulstick_painting::edits::{
    Clean, Dry, Handle, Load, LoadFrom, Place, Redo, Relight, Scrape, StopDrying, Tune, Undo, Wells,
};
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushHandling, CANVAS, Light, PALETTE, Tuning, Well};
use maulstick_types::values::{BrushName, Distance, ThinnerShare, ValueError};
use maulstick_types::{Mixture, Pose};

/// Takes the last step back.
pub(crate) fn undo() -> Command {
    Undo { brush: None }.into()
}

/// Does again what was taken back last.
pub(crate) fn redo() -> Command {
    Redo { brush: None }.into()
}

/// Dries the whole canvas.
pub(crate) fn dry() -> Command {
    Dry::whole(CANVAS).into()
}

/// Lets the wet paint of the canvas stay wet.
pub(crate) fn stop_drying() -> Command {
    StopDrying { surface: CANVAS }.into()
}

/// Scrapes the palette.
pub(crate) fn scrape() -> Command {
    Scrape {
        region: None,
        surface: PALETTE,
    }
    .into()
}

/// Another light, at its own exposure.
pub(crate) fn relight(light: Light) -> Command {
    Relight {
        light,
        expose: false,
    }
    .into()
}

/// Cleans a brush.
pub(crate) fn clean(brush: &str) -> Result<Command, ValueError> {
    let brush = BrushName::new(brush)?;
    Ok(Clean { brush }.into())
}

/// Loads a brush with a mixture, and with another one beside it.
pub(crate) fn load(
    brush: &str,
    mixture: Mixture,
    beside: Option<Mixture>,
) -> Result<Command, ValueError> {
    let brush = BrushName::new(brush)?;
    Ok(Load {
        mixture,
        beside,
        brush,
    }
    .into())
}

/// Brush, mixture and the one beside it, of a command that loads a brush.
pub(crate) fn loaded(command: &Command) -> Option<(String, Mixture, Option<Mixture>)> {
    let Load {
        mixture,
        beside,
        brush,
    } = command.edit()?;
    Some((brush.into(), mixture, beside))
}

/// Loads a brush with the mixture at a place of a surface, m.
pub(crate) fn load_from(
    brush: &str,
    (surface, [x, y]): (u32, [f64; 2]),
    thinner: ThinnerShare,
) -> Result<Command, ValueError> {
    Ok(LoadFrom {
        x: Distance::new(x)?,
        y: Distance::new(y)?,
        surface,
        thinner,
        brush: BrushName::new(brush)?,
    }
    .into())
}

/// Sets mode and limits of a brush.
pub(crate) fn handle(handling: &BrushHandling) -> Result<Command, ValueError> {
    Handle::try_from(handling).map(Into::into)
}

/// Sets stiffness and wetness of a brush.
pub(crate) fn tune(tuning: &Tuning) -> Result<Command, ValueError> {
    Tune::try_from(tuning).map(Into::into)
}

/// Places the palette.
pub(crate) fn lay_palette(pose: Pose, zoom: f64) -> Result<Command, ValueError> {
    Place::new(PALETTE, pose, zoom).map(Into::into)
}

/// Replaces the wells of the palette.
pub(crate) fn lay_wells(wells: Vec<Well>) -> Result<Command, ValueError> {
    Wells::new(PALETTE, wells).map(Into::into)
}
