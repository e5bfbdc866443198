//! The process that records each run of a rig.

use std::time::Duration;

use maulstick_recorder::{Division, Listener, Recorder, RecorderSettings, Ring};
use maulstick_rig::UserError;
use nix::sys::signal::Signal;
use tokio::runtime::Handle;

use super::{NodeOptions, RECORDER};
use crate::commands::LogFormat;
use crate::runtime::block_on;

/// Wait at the end of the rig for a copy of the painting: the launcher waits little longer.
const LAST_WAIT: Duration = Duration::from_millis(300);

/// Options of the recorder.
#[derive(clap::Args, Debug)]
pub(crate) struct RecorderOptions {
    #[command(flatten)]
    node: NodeOptions,
}

pub(super) fn run(options: &RecorderOptions) -> Result<i32, UserError> {
    // A recording gets its index at the end, so the process is asked to stop, not killed.
    let member = options.node.join(RECORDER, Signal::SIGTERM)?;
    let Some(section) = member.config.record.clone() else {
        return Err(UserError::usage("rig.toml has no section [record]").help(
            "give it one with a folder, or record with `maulstick recording record -o FILE`",
        ));
    };
    let folder = &section.folder;
    std::fs::create_dir_all(folder).map_err(|error| UserError::writing(folder, &error))?;
    let settings = RecorderSettings {
        division: Division {
            last: section
                .last()
                .map_err(|error| UserError::usage(error.to_string()))?,
            quota_bytes: section.quota_mb.map(|mb| mb.saturating_mul(1_000_000)),
            ..Division::default()
        },
        longest_wait: LAST_WAIT,
        ..RecorderSettings::default()
    };
    let rig = rig_name(member.topics.prefix());
    let ring = Ring::dated(folder, rig, &jiff::Zoned::now(), settings.division)?;
    let mut listener = Listener::over(member, &settings.topic)?;
    let pulse = listener.member.pulse()?;
    listener.member.ready()?;
    block_on(async {
        let runtime = Handle::current();
        let mut recorder = Recorder::over(&runtime, listener, pulse, settings, ring);
        while let Some(event) = recorder.events.recv().await {
            LogFormat::Log.show(&event)?;
        }
        recorder.ended().await?;
        Ok(0)
    })
}

/// Name of the rig whose topics begin with `prefix`.
fn rig_name(prefix: &str) -> &str {
    let prefix = prefix.trim_end_matches('/');
    prefix.rsplit_once('/').map_or(prefix, |(_, name)| name)
}
