//! Setup of a take: embedded into it, and extracted from it.

use std::path::Path;

use maulstick_device::{Take, TakeSetup};
use maulstick_exchange::PictureKind;
use maulstick_optics::paints::MEASURED;
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, RigConfig, is_path};
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::user_error::EXIT_FAILURE;
use maulstick_types::Mixture;

use crate::performance::brush_file;

/// The canvas, palette, brush, paints and light of a rig, with the files that they name.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read.
pub fn kit_of(
    config: &RigConfig,
    brush: &BrushSection,
    loads: &[Mixture],
) -> Result<TakeSetup, UserError> {
    let read = |path: &Path| std::fs::read(path).map_err(|error| UserError::reading(path, &error));
    let unwritten = |what: String| UserError::failure(what);
    let mut kit = TakeSetup {
        loads: loads.iter().map(ToString::to_string).collect(),
        ..TakeSetup::default()
    };
    let mut settings = RigConfig {
        canvas: config.canvas.clone(),
        palette: config.palette.clone(),
        light: config.light.clone(),
        ..RigConfig::default()
    };
    settings.device.clear();
    let head = brush_file(brush)?.to_toml();
    let head = head.map_err(|error| unwritten(error.to_string()))?;
    settings.brush = vec![BrushSection {
        kind: kit.add(head.into_bytes(), "toml"),
        size_mm: None,
        ..brush.clone()
    }];
    let paints = match &config.paint.paints {
        Some(path) => read(path)?,
        None => MEASURED.as_bytes().to_vec(),
    };
    settings.paint.paints = Some(kit.add(paints, "csv").into());
    if is_path(&config.light.illuminant) {
        let power = read(Path::new(&config.light.illuminant))?;
        settings.light.illuminant = kit.add(power, "csv");
    }
    if is_path(&config.canvas.ground) {
        let file = Path::new(&config.canvas.ground);
        let extension = match PictureKind::is_named(file) {
            true => file.extension().unwrap_or_default().to_ascii_lowercase(),
            false => "csv".into(),
        };
        settings.canvas.ground = kit.add(read(file)?, &extension.to_string_lossy());
    }
    let text = toml::to_string(&settings).map_err(|error| unwritten(error.to_string()))?;
    kit.settings = kit.add(text.into_bytes(), "toml");
    Ok(kit)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_take_can_embed_each_kind_of_picture() {
        for ending in PictureKind::ENDINGS {
            assert!(TakeSetup::knows(ending), "{ending}");
        }
        assert!(!TakeSetup::knows("exe"));
    }
}
