//! Lists the languages of the window.

use std::fmt::Write as _;
use std::path::PathBuf;

/// Folder of the languages, a file each; a file is called by its code of ISO 639.
const LANGUAGES: &str = "languages";

/// Writes the list of codes and texts that `src/language` includes.
fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed={LANGUAGES}");
    let folder = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?).join(LANGUAGES);
    let files: Result<Vec<PathBuf>, _> = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect();
    let mut files = files?;
    files.sort();
    let mut list =
        "/// Codes and texts of the languages.\npub const FILES: &[(&str, &str)] = &[\n".to_owned();
    for file in files
        .iter()
        .filter(|file| file.extension().is_some_and(|end| end == "toml"))
    {
        let code = file.file_stem().unwrap_or_default().to_string_lossy();
        writeln!(list, "    ({code:?}, include_str!({file:?})),")?;
    }
    list += "];\n";
    let place = PathBuf::from(std::env::var("OUT_DIR")?).join("languages.rs");
    Ok(std::fs::write(place, list)?)
}
