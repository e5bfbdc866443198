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

#[cfg(test)]
mod tests {
    use maulstick_types::scene::Light;

    use super::*;

    #[test]
    fn surroundings_are_named_or_read_from_a_panorama() {
        assert_eq!(environment("window"), Ok(Environment::Window));
        assert!(environment("widow").is_err() && environment("none.hdr").is_err());
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hall.png");
        let write = |size: [u32; 2], value: u8| {
            let file = std::fs::File::create(&path).expect("a file");
            let mut encoder = png::Encoder::new(file, size[0], size[1]);
            encoder.set_color(png::ColorType::Grayscale);
            let pixels = vec![value; (size[0] * size[1]) as usize];
            let written = encoder
                .write_header()
                .and_then(|mut to| to.write_image_data(&pixels));
            written.expect("written");
            environment(&path.display().to_string())
        };
        let light = Light {
            environment: write([64, 32], 200).expect("a hall"),
            ..Light::default()
        };
        assert_eq!((light.environment.name(), light.check()), ("hall", Ok(())));
        for fault in [write([64, 31], 200), write([64, 32], 0)] {
            let fault = fault.expect_err("no surroundings");
            assert!(fault.place.is_some() && fault.help.is_some(), "{fault}");
        }
    }
}
