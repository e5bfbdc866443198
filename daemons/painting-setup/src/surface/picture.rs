//! Pictures that a command reads.

use std::path::Path;

use maulstick_exchange::{Image, ImportError};
use maulstick_rig::UserError;
use maulstick_rig::log::say;

/// Reads a picture, with a warning where its colours may be off.
///
/// # Errors
/// A [`UserError`] where it cannot be read or is none.
pub fn open_picture(path: &Path) -> Result<Image, UserError> {
    let image = Image::open(path).map_err(|error| no_picture(path, &error))?;
    if let Some(mark) = image.unused_mark() {
        say(&format!("note: {}: {mark}\n", path.display()));
    }
    Ok(image)
}

/// The error that a file is no picture that can be used, as the user sees it.
#[must_use]
pub fn no_picture(path: &Path, error: &ImportError) -> UserError {
    let help = match error {
        ImportError::File(error) => return UserError::reading(path, error),
        ImportError::NotANumber(..) => {
            "paint over that pixel in the program that made it, and save it again"
        }
        ImportError::Unsupported(_) => "save it as PNG, or as TIFF of RGB",
        ImportError::Beside(_) => "save it without its profile and notes",
        _ => {
            "give a PNG, JPEG, TIFF, OpenEXR, Radiance or OpenRaster picture of at most 20,000 pixels either way"
        }
    };
    UserError::usage(error.to_string())
        .at(path.display().to_string())
        .help(help)
}
