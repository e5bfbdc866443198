//! The process of a pen tablet or a 6-DOF mouse.

use std::path::PathBuf;

use maulstick_hid::daemon::HidSettings;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use nix::sys::signal::Signal;

use maulstick_painting_setup::outputs::{UsedFile, check_outputs, named_by};

use super::{NodeOptions, device_named};

/// Suffix of the name of a device's recorder.
const RECORDER: &str = "-recorder";

/// Options of the daemon of a pen tablet or a 6-DOF mouse.
#[derive(clap::Args, Debug)]
pub(crate) struct HidOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The device of rig.toml
    #[arg(long, value_name = "DEVICE")]
    device: String,
    /// Play this recording in place of the device
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
    /// Record what the device sends
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
}

pub(super) fn run(options: &HidOptions) -> Result<i32, UserError> {
    // Beside the device's own daemon a recorder acts as a separate device; only one of them moves a brush at a time.
    let beside = options.record.is_some() && options.node.node.is_none();
    let name = if beside {
        format!("{}{RECORDER}", options.device)
    } else {
        options.device.clone()
    };
    // A recording gets its name at the end, so the process is asked to stop, not killed.
    let mut member = options.node.join(&name, Signal::SIGTERM)?;
    let mut device = device_named(&member.config, &options.device)?;
    if beside {
        device.name = name;
    }
    let settings = HidSettings {
        device,
        canvas: member.config.canvas.clone(),
        replay: options.replay.clone(),
        record: options.record.clone(),
    };
    let played = settings.replay.as_ref();
    let inputs: Vec<_> = named_by(&member.config)
        .into_iter()
        .chain(UsedFile::given("the recording that is played", played))
        .collect();
    let output = UsedFile::written("the recording", settings.record.as_ref(), Kind::Recording);
    let outputs: Vec<_> = output.into_iter().collect();
    check_outputs(&outputs, &inputs)?;
    maulstick_hid::daemon::run(&mut member, &settings)?;
    member.leave();
    Ok(0)
}
