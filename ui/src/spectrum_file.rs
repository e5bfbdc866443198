//! Spectra from CSV files.

use std::io::Read as _;
use std::path::Path;

use maulstick_optics::{Illuminant, Reflectance};
use maulstick_rig::UserError;
use maulstick_rig::table_file::table_text;
use maulstick_types::limits::SPECTRUM_MAX;

/// The text of a table with such rows; a folder, a device or a huge file is rejected.
fn text(path: &Path, row: &str) -> Result<String, UserError> {
    let failed = |error: std::io::Error| UserError::reading(path, &error);
    let place = || path.display().to_string();
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(UserError::usage(tr!("this is no file"))
            .at(place())
            .help(tr!("name a file: {row}", row)));
    }
    let file = std::fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    let most = SPECTRUM_MAX as u64;
    file.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() > SPECTRUM_MAX {
        return Err(UserError::usage(tr!("a file of this size is no spectrum"))
            .at(place())
            .help(tr!("write no more than {row}", row)));
    }
    table_text(path, &bytes)
}

/// The light of a CSV file of wavelengths, nm, and powers; its name is the file's.
///
/// # Errors
/// A [`UserError`] with file and line.
pub(crate) fn light(path: &Path) -> Result<Illuminant, UserError> {
    let row = tr!("a line for each wavelength in nm and its power");
    let text = text(path, row)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Illuminant::parse(&stem, &text).map_err(|error| {
        UserError::usage(error.fault.to_string())
            .at(format!("{}:{}", path.display(), error.line))
            .help(tr!(
                "write {row}, a comma between; the wavelengths rise",
                row
            ))
    })
}

/// The text of a CSV file of wavelengths, nm, and reflectances, 0 to 1.
///
/// # Errors
/// A [`UserError`] with file and line.
pub(crate) fn reflectance(path: &Path) -> Result<String, UserError> {
    let row = tr!("a line for each wavelength in nm and its reflectance");
    let text = text(path, row)?;
    Reflectance::parse(&text).map_err(|error| {
        UserError::usage(error.fault.to_string())
            .at(format!("{}:{}", path.display(), error.line))
            .help(tr!(
                "write {row}, 0 to 1, a comma between; the wavelengths rise",
                row
            ))
    })?;
    Ok(text)
}

/// A fault in one line: place, fault, remedy.
#[must_use]
pub(crate) fn told(fault: &UserError) -> String {
    let place = fault.place.iter().map(|place| format!("{place}: "));
    let help = fault.help.iter().map(|help| format!("; {help}"));
    place
        .chain(std::iter::once(fault.what.clone()))
        .chain(help)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_or_refused_with_their_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("candle.csv");
        let write = |text: &str| std::fs::write(&path, text).expect("written");
        write("\u{feff}nm,power\n380,0.1\n780,1\n");
        assert_eq!(light(&path).expect("a light").name, "candle");
        assert!(reflectance(&path).expect("a ground").starts_with("nm,"));
        write("380,0.1\n780,1.5\n");
        assert!(light(&path).is_ok());
        let line = told(&reflectance(&path).expect_err("more than all"));
        assert!(
            line.contains("candle.csv:2") && line.contains("0 to 1"),
            "{line}"
        );
        write(&"380,1\n".repeat(50_000));
        let line = told(&light(&path).expect_err("too large"));
        assert!(line.contains("size") && line.contains("line"), "{line}");
        for (path, word) in [
            (folder.path(), "no file"),
            (Path::new("/none"), "check the path"),
        ] {
            let line = told(&light(path).expect_err("no file"));
            assert!(line.contains(word), "{line}");
        }
    }
}
