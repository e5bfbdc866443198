//! The setup that a take embeds, laid out and used.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, RigConfig, is_path};
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::user_error::EXIT_FAILURE;

use crate::brush_file;
use crate::take::Take;

/// Brush that a 6-DOF stylus of a take holds: the one that the take embeds, else that of a new rig.
///
/// # Errors
/// A [`UserError`] where the take embeds something else than a setup, or its brush cannot be read.
pub fn held_brush(take: &Take, path: &Path) -> Result<BrushFile, UserError> {
    let mut config = RigConfig::default();
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    use_kit(take, path, folder.path(), &mut config)?;
    brush_file(&config.brush[0])
}

/// Lays what a take embeds into a folder, and has a rig's settings use it. Returned is what the strokes
/// load; nothing where the take embeds nothing.
///
/// # Errors
/// A [`UserError`] where it cannot be written, or is no settings of a rig.
pub fn use_kit(
    take: &Take,
    path: &Path,
    folder: &Path,
    config: &mut RigConfig,
) -> Result<Vec<String>, UserError> {
    let Some(kit) = &take.setup else {
        return Ok(Vec::new());
    };
    std::fs::create_dir_all(folder).map_err(|error| UserError::writing(folder, &error))?;
    for (name, bytes) in &kit.files {
        let file = folder.join(name);
        write_whole(&file, Kind::Own, |file| {
            std::io::Write::write_all(file, bytes)
        })
        .map_err(|error| UserError::writing(&file, &error))?;
    }
    let place = format!("{}, what it embeds", path.display());
    let settings = RigConfig::read(&folder.join(&kit.settings)).map_err(|fault| match fault {
        fault if fault.code == EXIT_FAILURE => fault,
        fault => fault.at(place.clone()),
    })?;
    let mut names = vec![
        settings.light.illuminant.clone(),
        settings.light.environment.clone(),
        settings.canvas.ground.clone(),
    ];
    names.extend(settings.brush.iter().map(|brush| brush.kind.clone()));
    names.extend(
        settings
            .paint
            .paints
            .iter()
            .map(|path| path.display().to_string()),
    );
    for name in names.iter().filter(|name| is_path(name)) {
        let file = Path::new(name);
        let embedded = file.parent() == Some(folder) && file.is_file();
        if !embedded {
            return Err(UserError::usage("a file that the take embeds is missing, or not what it was")
                .at(place)
                .help("`maulstick take recover` keeps its samples; embed again with `maulstick take embed`"));
        }
    }
    config.canvas = settings.canvas;
    config.palette = settings.palette;
    config.light = settings.light;
    config.paint.paints = settings.paint.paints;
    if let Some(brush) = settings.brush.into_iter().next() {
        let name = config.brush[0].name.clone();
        config.brush[0] = BrushSection { name, ..brush };
    }
    Ok(kit.loads.clone())
}
