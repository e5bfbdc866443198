//! Checks the shaders of a crate, for its build script: an error in one is an error of the build.

use std::error::Error;
use std::path::Path;

use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn check(path: &Path, prefix: &str) -> Result<(), Box<dyn Error>> {
    let source = format!("{prefix}{}", std::fs::read_to_string(path)?);
    let name = path.display().to_string();
    let module =
        wgsl::parse_str(&source).map_err(|error| error.emit_to_string_with_path(&source, &name))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string_with_path(&source, &name))?;
    Ok(())
}

/// Checks all shaders of a folder; `prefixes` are those that the others begin with, here as at run time.
pub(crate) fn check_all(folder: &str, prefixes: &[&str]) -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={folder}");
    let mut text = String::new();
    for name in prefixes {
        let path = Path::new(folder).join(name);
        println!("cargo::rerun-if-changed={}", path.display());
        text += &std::fs::read_to_string(path)?;
    }
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() || prefixes.iter().any(|prefix| path.ends_with(prefix)) {
            continue;
        }
        if let Err(error) = check(&path, &text) {
            for line in error.to_string().lines() {
                println!("cargo::error={line}");
            }
        }
    }
    Ok(())
}
