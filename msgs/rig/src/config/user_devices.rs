//! The devices of a user, kept for whatever rig is started without settings of its own: `devices.toml` in the user's
//! folder of settings, sections `[[device]]` as in `rig.toml`.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::config::{DeviceSection, RigConfig, toml_fault};
use crate::user_error::UserError;

/// Command line that lets the user at a machine use its devices, where `maulstick device allow` cannot ask for the
/// password.
pub const ALLOW_BY_HAND: &str = "maulstick device list --udev | sudo tee /etc/udev/rules.d/70-maulstick.rules && sudo \
                                 udevadm control --reload && sudo udevadm trigger && sudo udevadm settle --timeout=5";

/// The file.
///
/// # Errors
/// A [`UserError`] where the system has no folder for it.
pub fn path() -> Result<PathBuf, UserError> {
    let folders = directories::ProjectDirs::from("", "", "maulstick").ok_or_else(|| {
        UserError::failure("there is no folder for the settings of this user")
            .help("set HOME to a folder of your own")
    })?;
    Ok(folders.config_dir().join("devices.toml"))
}

/// The sections of the file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sections {
    #[serde(default)]
    device: Vec<DeviceSection>,
}

/// The devices in such a file, none if there is none. Whether they fit into a rig is checked there.
///
/// # Errors
/// A [`UserError`] with the line.
pub fn read(path: &Path) -> Result<Vec<DeviceSection>, UserError> {
    if matches!(path.try_exists(), Ok(false)) {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    parse(&text, path)
}

/// The devices in the text of such a file; paths in it are relative to its folder.
///
/// # Errors
/// A [`UserError`] with the line.
pub fn parse(text: &str, path: &Path) -> Result<Vec<DeviceSection>, UserError> {
    let name = path.display().to_string();
    let sections: Sections =
        toml::from_str(text).map_err(|error| toml_fault(text, &name, &error))?;
    let mut config = RigConfig {
        device: sections.device,
        ..RigConfig::default()
    };
    if let Some(folder) = path.parent() {
        config.resolve(folder);
    }
    Ok(config.device)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_of_devices_are_read_and_others_are_told() {
        let path = Path::new("/home/me/devices.toml");
        let text = "[[device]]\nname = 'arm'\ndriver = 'polhem'\nbrush = 'second'\n\
                    library = 'own/libHD.so'\n";
        let read = parse(text, path).expect("valid");
        assert_eq!((read.len(), read[0].brush.as_str()), (1, "second"));
        // A rig refuses it: a library is found by a whole path or by its name.
        assert_eq!(read[0].library.as_deref(), Some(Path::new("own/libHD.so")));
        assert_eq!(parse("", path), Ok(Vec::new()));
        let fault = parse("[canvas]\nwidth_mm = 3\n", path)
            .expect_err("no device")
            .to_string();
        assert!(
            fault.contains("canvas") && fault.contains("devices.toml:1"),
            "{fault}"
        );
    }
}
