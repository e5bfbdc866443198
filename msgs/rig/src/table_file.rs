//! Tables in files that a user names.

use std::io::Read as _;
use std::path::Path;

use maulstick_tables::{TableError, decode};

use crate::UserError;

/// Most bytes of a table.
pub const MOST_BYTES: u64 = 1 << 30;

/// The text of a table of at most `most` bytes.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read, is longer, or holds no text, with its line.
pub fn read_table(path: &Path, most: u64) -> Result<String, UserError> {
    let failed = |error: std::io::Error| UserError::reading(path, &error);
    let file = std::fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // A device or a pipe may have no end.
    file.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(
            UserError::usage(format!("a table of more than {most} bytes"))
                .at(path.display().to_string())
                .help("name a table with a line for each sample or wavelength"),
        );
    }
    table_text(path, &bytes)
}

/// The text of a table's bytes.
///
/// # Errors
/// A [`UserError`] with the line where they are no text.
pub fn table_text(path: &Path, bytes: &[u8]) -> Result<String, UserError> {
    match decode(bytes) {
        Ok(text) => Ok(text.trim_start_matches('\u{feff}').to_owned()),
        Err(error) => Err(table_fault(&path.display().to_string(), &error)),
    }
}

/// Error of a table of this name, as the user sees it.
#[must_use]
pub fn table_fault(name: &str, error: &TableError) -> UserError {
    UserError::usage(error.what())
        .at(format!("{name}:{}", error.line))
        .help(error.fault.help())
}
