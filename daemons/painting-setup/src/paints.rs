//! Paints that are measured, or of a file, and their mixtures.

use std::path::Path;

use maulstick_optics::{PaintError, PaintLibrary};
use maulstick_rig::UserError;
use maulstick_rig::table_file::{MOST_BYTES, read_table};
use maulstick_types::Mixture;

use crate::refusal::refused;

/// The measured paints.
///
/// # Errors
/// None in practice: they are part of the program.
pub fn library() -> Result<PaintLibrary, UserError> {
    PaintLibrary::measured().map_err(|error| UserError::failure(error.to_string()))
}

/// The paints of a paint file; without one, the measured ones.
///
/// # Errors
/// A [`UserError`] with file and line for a file that is no paint file.
pub fn library_from(path: Option<&Path>) -> Result<PaintLibrary, UserError> {
    let Some(path) = path else {
        return library();
    };
    let text = read_table(path, MOST_BYTES)?;
    PaintLibrary::parse(&text).map_err(|error| match error {
        PaintError::File { line, fault } => UserError::usage(fault.to_string())
            .at(format!("{}:{line}", path.display()))
            .help("a row: paint, colour index, source, K or S, then 101 values, 380 to 780 nm"),
        other => refused(other),
    })
}

/// A mixture of a library's paints, their names spelt as the library does.
///
/// # Errors
/// A [`UserError`] for a bad mixture or an unknown paint, with the nearest name.
pub fn mixture_of(text: &str, library: &PaintLibrary) -> Result<Mixture, UserError> {
    let mixture = text.parse().map_err(PaintError::Mixture);
    mixture
        .and_then(|mixture: Mixture| library.check(&mixture))
        .map_err(refused)
}
