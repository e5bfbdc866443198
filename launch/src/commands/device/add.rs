//! `maulstick device add`: an attached device paints from now on.

use clap::Args;
use maulstick_device_setup::add::{NewDevice, add};
use maulstick_rig::UserError;

use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick device add`.
#[derive(Args, Clone, Debug)]
pub struct AddOptions {
    /// Name for the device [default: by what it is]
    device: Option<String>,
    /// Its driver [default: the one that fits what is attached]
    #[arg(long)]
    driver: Option<String>,
    /// Which of several: vendor:product or a path, as `maulstick device list` shows them
    #[arg(long)]
    address: Option<String>,
    /// Brush that it moves
    #[arg(long, default_value = "main")]
    brush: String,
    /// Of devices in range the one with the highest priority paints
    #[arg(long, default_value_t = 0, allow_negative_numbers = true)]
    priority: i32,
    #[command(flatten)]
    target: Target,
}

/// Adds a device.
///
/// # Errors
/// A [`UserError`] where none or several fit, it is invalid, or it cannot be saved.
pub(super) fn run(options: &AddOptions) -> Result<i32, UserError> {
    let new = NewDevice {
        name: options.device.clone(),
        driver: options.driver.clone(),
        address: options.address.clone(),
        brush: Some(options.brush.clone()),
        priority: options.priority,
    };
    let added = add(&new, options.target.rig())?;
    if let Some((device, missing)) = &added.missing {
        say!("{device}: {missing}");
    }
    let (name, driver) = (&added.name, &added.driver);
    say!("'{name}' ({driver}) is kept in {}", added.file.display());
    match added.started {
        Some(detail) => say!("{detail}; `maulstick device list` shows how it fares"),
        None => say!("it paints when the rig is started: `maulstick up`"),
    }
    Ok(0)
}
