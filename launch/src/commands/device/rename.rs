//! `maulstick device rename`: a device goes by another name, in the user's file and in the running rig.

use clap::Args;
use maulstick_device_setup::rename::rename;
use maulstick_rig::UserError;

use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick device rename`.
#[derive(Args, Clone, Debug)]
pub struct RenameOptions {
    /// Name of the device
    device: String,
    /// Its new name: letters, digits, '_' or '-'
    #[arg(value_name = "NAME")]
    new_name: String,
    #[command(flatten)]
    target: Target,
}

/// Renames a device.
///
/// # Errors
/// A [`UserError`] where the user has no such device, the name is taken or invalid, or the rig refuses it;
/// nothing is changed then.
pub(super) fn run(options: &RenameOptions) -> Result<i32, UserError> {
    let (device, name) = (&options.device, &options.new_name);
    rename(device, name, options.target.rig())?;
    say!("'{device}' is called '{name}' now");
    Ok(0)
}
