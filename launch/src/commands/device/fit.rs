//! `maulstick device fit`: the corners of the canvas, as a hand shows them with its device, written into the settings.

use std::path::PathBuf;

use clap::Args;
use maulstick_bus::Wake;
use maulstick_device_setup::fit::{FitEnd, FitEvent, FitSettings, fit};
use maulstick_rig::{Stop, UserError};
use serde_json::json;

use crate::EXIT_INTERRUPTED;
use crate::commands::client::Target;
use crate::commands::{print_json_line, print_line};

/// Options of `maulstick device fit`.
#[derive(Args, Clone, Debug)]
pub struct FitOptions {
    /// The device
    device: String,
    /// Settings of a rig, into which the corners are written [default: your own devices]
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Print a line of JSON for each that is said, with the corner that is to be touched
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Guides a hand to the corners and saves them; a running rig releases the device meanwhile.
///
/// # Errors
/// A [`UserError`] for an absent device, corners that do not fit the canvas, or settings that cannot be
/// written.
pub(super) fn run(options: &FitOptions) -> Result<i32, UserError> {
    // A signal ends the fit, which puts the device back.
    let stop = Stop::on_signals(&Wake::new())
        .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))?;
    let settings = FitSettings {
        device: &options.device,
        file: options.rig.as_deref(),
        rig: options.target.rig(),
    };
    let mut report = |event: FitEvent| {
        if !options.json {
            return print_line(&event.to_string());
        }
        let asks = match &event {
            FitEvent::Touch { corner, .. } => Some(corner.to_string()),
            _ => None,
        };
        print_json_line(&json!({"said": event.to_string(), "asks": asks}))
    };
    match fit(&settings, &stop, &mut report)? {
        FitEnd::Written => Ok(0),
        FitEnd::Stopped => Ok(EXIT_INTERRUPTED),
    }
}
