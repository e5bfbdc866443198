//! `maulstick device remove`: a device paints no more.

use clap::Args;
use maulstick_rig::UserError;

use super::user_file::{UserFile, in_rig, remove_from_rig};
use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick device remove`.
#[derive(Args, Clone, Debug)]
pub struct RemoveOptions {
    /// Name of the device
    device: String,
    #[command(flatten)]
    target: Target,
}

/// Removes a device.
///
/// # Errors
/// A [`UserError`] where neither the user nor the rig has it.
pub(super) fn run(options: &RemoveOptions) -> Result<i32, UserError> {
    let mut file = UserFile::read()?;
    let name = &options.device;
    let in_rig = in_rig(&options.target)?;
    let was_in_rig = remove_from_rig(&options.target, name)?;
    match file.device(name, &in_rig).map(drop) {
        Ok(()) => {
            file.remove(name)?;
            say!("'{name}' is kept no more in {}", file.path().display());
        }
        Err(fault) if !was_in_rig => return Err(fault),
        Err(_) => {}
    }
    if was_in_rig {
        say!("'{name}' has left the rig");
    }
    Ok(0)
}
