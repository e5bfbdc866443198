//! A device that paints no more.

use std::path::PathBuf;

use maulstick_rig::UserError;

use crate::running::{in_rig, remove_from_rig};
use crate::user_file::UserFile;

/// Where a device was removed from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removed {
    /// The file of this user's devices, if it was in there.
    pub file: Option<PathBuf>,
    /// True if it was in the rig.
    pub was_in_rig: bool,
}

/// Removes a device from those of this user, and from the rig of this name if it runs.
///
/// # Errors
/// A [`UserError`] where neither the user nor the rig has it.
pub fn remove(name: &str, rig: &str) -> Result<Removed, UserError> {
    let mut file = UserFile::read()?;
    let in_rig = in_rig(rig)?;
    let was_in_rig = remove_from_rig(rig, name)?;
    let kept = match file.device(name, &in_rig).map(drop) {
        Ok(()) => {
            file.remove(name)?;
            Some(file.path().to_owned())
        }
        Err(fault) if !was_in_rig => return Err(fault),
        Err(_) => None,
    };
    Ok(Removed {
        file: kept,
        was_in_rig,
    })
}
