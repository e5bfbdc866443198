//! Surroundings that gloss mirrors, by name or from a picture.

use std::path::Path;

use maulstick_exchange::environment::{self, ENVIRONMENT_MEMORY};
use maulstick_exchange::{Image, ImportError};
use maulstick_rig::UserError;
use maulstick_rig::config::is_path;
use maulstick_types::nearest::choice;
use maulstick_types::scene::Environment;

use crate::surface::picture::no_picture;

/// Surroundings by their name, or of a picture by latitude and longitude.
///
/// # Errors
/// A [`UserError`] for an unknown name, with the nearest, or a file that is no such picture.
pub fn environment(name: &str) -> Result<Environment, UserError> {
    if let Some(known) = Environment::named(name) {
        return Ok(known);
    }
    let path = Path::new(name);
    if !is_path(name) && !path.exists() {
        let fault = UserError::usage(format!("there is no environment '{name}'"));
        return Err(fault.help(choice(name, Environment::NAMES)));
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let image = Image::open_within(path, ENVIRONMENT_MEMORY);
    let read = image.and_then(|image| environment::environment(&image, &stem));
    read.map_err(|error| unread(path, &error))
}

/// The error that a picture is no surroundings, as the user sees it.
fn unread(path: &Path, error: &ImportError) -> UserError {
    let help = match error {
        ImportError::NotPanoramic(..) => {
            "give an equirectangular picture, as panoramas of a whole room are saved"
        }
        ImportError::Radiance(..) => "save the picture again without negative or infinite values",
        ImportError::Black => "its middle column is what faces the painting: shift or brighten it",
        other => return no_picture(path, other),
    };
    UserError::usage(error.to_string())
        .at(path.display().to_string())
        .help(help)
}
