//! Devices of a running rig.

use std::time::Duration;

use maulstick_client::connection::Client;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::command::{Detail, RigCommand};
use maulstick_types::values::{DeviceName, DeviceToml};

use crate::user_file::toml_text;

/// Longest wait until the rig has started a device.
const PATIENCE: Duration = Duration::from_secs(10);

/// The devices of the rig called `rig`, none if that does not run.
///
/// # Errors
/// A [`UserError`] where its settings cannot be read.
pub(crate) fn in_rig(rig: &str) -> Result<Vec<DeviceSection>, UserError> {
    match Client::open(rig) {
        Ok(client) => Ok(client.config()?.device),
        Err(_) => Ok(Vec::new()),
    }
}

/// Starts a device in the rig called `rig`, if that runs; its answer then.
///
/// # Errors
/// A [`UserError`] with the rig's refusal.
pub(crate) fn put_in_rig(rig: &str, device: &DeviceSection) -> Result<Option<Detail>, UserError> {
    let Ok(client) = Client::open(rig) else {
        return Ok(None);
    };
    let toml = DeviceToml::new(toml_text(device)?)?;
    let done = client.carry_out(RigCommand::PutDevice { toml }, PATIENCE)?;
    Ok(Some(done.detail))
}

/// Ends a device in the rig called `rig`, if that runs and has it; true if so.
///
/// # Errors
/// A [`UserError`] with the rig's refusal.
pub(crate) fn remove_from_rig(rig: &str, name: &str) -> Result<bool, UserError> {
    let Ok(client) = Client::open(rig) else {
        return Ok(false);
    };
    let has = client.config()?.device.iter().any(|own| own.name == name);
    if has {
        let name = DeviceName::new(name)?;
        client.send(RigCommand::RemoveDevice { name })?;
    }
    Ok(has)
}

/// Checks that the device of that name in the rig is the same as the user's.
///
/// # Errors
/// A [`UserError`] where it is another one.
pub(crate) fn is_same(
    own: &DeviceSection,
    running: Option<&DeviceSection>,
) -> Result<(), UserError> {
    match running {
        Some(other) if (&other.driver, &other.address) != (&own.driver, &own.address) => {
            let what = format!("the rig has another device called '{}'", own.name);
            Err(UserError::usage(what).help("give yours another name: `maulstick device rename`"))
        }
        _ => Ok(()),
    }
}
