//! `maulstick device allow`: installs the rule by which the user at this machine may use its devices.

use clap::Args;
use maulstick_device_setup::allow::allow;
use maulstick_device_setup::attached::RULE;
use maulstick_rig::UserError;

use crate::commands::say;

/// Options of `maulstick device allow`.
#[derive(Args, Clone, Debug)]
pub struct AllowOptions {}

/// Writes the rule, as root or with `pkexec`, which asks for the password.
///
/// # Errors
/// A [`UserError`] with the command to type if that fails.
pub(super) fn run(_: &AllowOptions) -> Result<i32, UserError> {
    allow()?;
    say!("the user at this machine may use its devices: {RULE}");
    Ok(0)
}
