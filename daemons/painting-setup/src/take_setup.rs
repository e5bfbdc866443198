//! Setup of a take, to be embedded into it.

use std::path::Path;

use maulstick_device::TakeSetup;
use maulstick_exchange::PictureKind;
use maulstick_optics::paints::MEASURED;
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, RigConfig, is_path};
use maulstick_types::Mixture;

use crate::brushes::brush_file;

/// The canvas, palette, brush, paints and light of a rig, with the files that they name.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read.
pub fn take_setup(
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
    for name in [&mut settings.canvas.ground, &mut settings.light.environment] {
        if is_path(name) {
            let file = Path::new(name.as_str());
            let extension = if PictureKind::is_named(file) {
                file.extension().unwrap_or_default().to_ascii_lowercase()
            } else {
                "csv".into()
            };
            *name = kit.add(read(file)?, &extension.to_string_lossy());
        }
    }
    let text = toml::to_string(&settings).map_err(|error| unwritten(error.to_string()))?;
    kit.settings = kit.add(text.into_bytes(), "toml");
    Ok(kit)
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
