//! The brush that a section of `rig.toml` asks for.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_rig::Fault;
use maulstick_rig::config::BrushSection;

/// The brush file of a section, at its size: one of the library, or read from where its kind says.
///
/// # Errors
/// A [`Fault`] for an unknown kind or a bad file.
pub fn brush_file(section: &BrushSection) -> Result<BrushFile, Fault> {
    let path = Path::new(&section.kind);
    let named = path.components().count() == 1 && path.extension().is_none();
    let file = if named {
        BrushFile::library(&section.kind).map_err(|error| {
            Fault::usage(error.to_string()).help("`--brush FILE.toml` takes a brush file")
        })?
    } else {
        let text = std::fs::read_to_string(path).map_err(|error| Fault::reading(path, &error))?;
        BrushFile::parse(&text).map_err(|error| {
            Fault::usage(error.to_string())
                .at(section.kind.clone())
                .help("correct the brush file")
        })?
    };
    match section.size_mm {
        Some(size_mm) => file
            .scaled_to(size_mm)
            .map_err(|error| Fault::usage(error.to_string())),
        None => Ok(file),
    }
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
        assert_eq!(fault.place.as_deref(), Some(kind.as_str()));
        assert!(
            brush_file(&section("ruond"))
                .expect_err("misspelt")
                .what
                .contains("'round'")
        );
    }
}
