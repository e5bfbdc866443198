//! The devices of a user, kept for whatever rig is started without settings of its own: `devices.toml` in the user's
//! folder of settings, sections `[[device]]` as in `rig.toml`.

use std::path::{Path, PathBuf};

use crate::config::{DeviceSection, RigConfig};
use crate::user_error::UserError;

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

/// The devices in such a file, none if there is none.
///
/// # Errors
/// A [`UserError`] with the line.
pub fn read(path: &Path) -> Result<Vec<DeviceSection>, UserError> {
    match path.try_exists() {
        Ok(false) => Ok(Vec::new()),
        _ => Ok(RigConfig::read(path)?.device),
    }
}
