//! The process of a force-feedback stylus.

use std::path::PathBuf;

use maulstick_haptic::daemon;
use maulstick_haptic::device::open::HapticSettings;
use maulstick_haptic::drivers::vendor_library::allow_library;
use maulstick_rig::UserError;
use nix::sys::signal::Signal;

use super::{NodeOptions, device_named};

/// Options of the daemon of a force-feedback stylus.
#[derive(clap::Args, Debug)]
pub(crate) struct HapticOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The device of rig.toml
    #[arg(long, value_name = "DEVICE")]
    device: String,
    /// A take that a simulated hand follows
    #[arg(long, value_name = "TAKE")]
    hand: Option<PathBuf>,
    /// Let the device load this vendor's library, outside of the folders of the system; may be given several times
    #[arg(long, value_name = "PATH")]
    allow_library: Vec<PathBuf>,
}

pub(super) fn run(options: &HapticOptions) -> Result<i32, UserError> {
    // The servo ramps its force down before it ends, so it is asked, not killed.
    let mut member = options.node.join(&options.device, Signal::SIGTERM)?;
    options
        .allow_library
        .iter()
        .for_each(|path| allow_library(path));
    let device = device_named(&member.config, &options.device)?;
    daemon::run(
        &mut member,
        &HapticSettings {
            device,
            hand: options.hand.clone(),
        },
    )?;
    member.leave();
    Ok(0)
}
