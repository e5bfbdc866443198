//! `maulstick endpoint`: data for a program in any language to join a running rig.

use clap::Args;
use maulstick_bus::RigFolder;
use maulstick_rig::UserError;
use maulstick_types::STYLUS_CONTRACT;
use serde_json::json;

use crate::commands::print_json;
use crate::commands::say;

/// Options of `maulstick endpoint`.
#[derive(Args, Clone, Debug)]
pub struct EndpointOptions {
    /// Name of the rig
    #[arg(long, value_name = "RIG", default_value = "studio")]
    name: String,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Prints where the rig is.
///
/// # Errors
/// A [`UserError`] where no such rig runs.
pub fn run(options: &EndpointOptions) -> Result<i32, UserError> {
    let (_, info) = RigFolder::join(&options.name)?;
    if options.json {
        print_json(&json!({
            "rig": info.rig,
            "contract": STYLUS_CONTRACT,
            "endpoint": info.endpoint,
            "prefix": info.prefix,
            "clock_offset_ns": info.clock_offset_ns,
            "pid": info.pid,
        }))?;
    } else {
        say!("{}", info.endpoint);
    }
    Ok(0)
}
