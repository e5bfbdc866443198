//! The brush that a section of `rig.toml` asks for.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, toml_fault};
use maulstick_rig::files::ending;

/// The brush file of a section, at its size: one of the library, or read from where its kind says.
///
/// # Errors
/// A [`UserError`] for an unknown kind or a bad file.
pub fn brush_file(section: &BrushSection) -> Result<BrushFile, UserError> {
    let path = Path::new(&section.kind);
    let named = path.components().count() == 1 && path.extension().is_none();
    let file = if named {
        BrushFile::library(&section.kind).map_err(|error| {
            UserError::usage(error.to_string())
                .help("`maulstick brush list` lists them; give a file of your own with its extension: own.toml")
        })?
    } else {
        read_brush(path)?
    };
    match section.size_mm {
        Some(size_mm) => file
            .scaled_to(size_mm)
            .map_err(|error| UserError::usage(error.to_string()).help("choose another size_mm")),
        None => Ok(file),
    }
}

/// Reads a brush file, or a brush modelled in Blender (`.glb`, `.gltf`).
///
/// # Errors
/// A [`UserError`] with the file for one that cannot be read or is wrong.
pub fn read_brush(path: &Path) -> Result<BrushFile, UserError> {
    let bytes = std::fs::read(path).map_err(|error| UserError::reading(path, &error))?;
    let place = path.display().to_string();
    let wrong = |what: String, help: &str| UserError::usage(what).at(place.clone()).help(help);
    if matches!(&*ending(path), "glb" | "gltf") {
        return maulstick_brush::gltf::read(&bytes)
            .map_err(|error| wrong(error.to_string(), "correct the model in Blender"));
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        let help = "a brush file is TOML, or a model whose name ends in .glb or .gltf";
        wrong("this is no text".to_owned(), help)
    })?;
    let file: BrushFile =
        toml::from_str(&text).map_err(|error| toml_fault(&text, &place, &error))?;
    file.check()
        .map_err(|error| wrong(error.to_string(), "correct the brush file"))?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brush_comes_from_the_library_or_from_a_file_at_its_size() {
        let folder = tempfile::tempdir().expect("a folder");
        let section = |kind: &str| BrushSection {
            name: "main".into(),
            kind: kind.into(),
            size_mm: Some(20.0),
            depth_share: 0.5,
        };
        let library = brush_file(&section("round")).expect("a brush");
        assert!((library.head.width_mm - 20.0).abs() < 1e-9);
        let path = folder.path().join("own.toml");
        let kind = path.display().to_string();
        let text = BrushFile::library("round").and_then(|file| file.to_toml());
        std::fs::write(&path, text.expect("a file")).expect("written");
        assert_eq!(brush_file(&section(&kind)), Ok(library));
        std::fs::write(&path, "[head]\n").expect("written");
        let fault = brush_file(&section(&kind)).expect_err("half a file");
        let line = format!("{kind}:1");
        assert_eq!(fault.place, Some(line));
        // A model by its name, in capitals too.
        let model = folder.path().join("own.GLB");
        std::fs::write(&model, b"glTF\xff\xff").expect("written");
        let fault = read_brush(&model).expect_err("half a model");
        assert!(fault.help.is_some_and(|help| help.contains("Blender")));
        assert!(
            brush_file(&section("ruond"))
                .expect_err("misspelt")
                .what
                .contains("'round'")
        );
    }
}
