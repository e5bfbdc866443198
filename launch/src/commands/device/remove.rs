//! `maulstick device remove`: a device paints no more.

use clap::Args;
use maulstick_device_setup::remove::remove;
use maulstick_rig::UserError;

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
    let name = &options.device;
    let removed = remove(name, options.target.rig())?;
    if let Some(file) = removed.file {
        say!("'{name}' is kept no more in {}", file.display());
    }
    if removed.was_in_rig {
        say!("'{name}' has left the rig");
    }
    Ok(0)
}
