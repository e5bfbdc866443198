//! The process that records each run of a rig.

use std::time::Duration;

use maulstick_rig::UserError;
use maulstick_rig::files::create_private;
use nix::sys::signal::Signal;

use super::{NodeOptions, RECORDER};
use crate::commands::client::Target;
use crate::commands::{Division, Listener, RecorderSettings, Ring, Voice, record_files};

/// Topics that are recorded.
const ALL: &str = "**";
/// Most messages a second of each topic that are written as JSON too.
const JSON_HZ: u32 = 20;
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
        target: Target::named(rig_name(member.topics.prefix())),
        topic: ALL.to_owned(),
        lasts: None,
        division: Division {
            last: section
                .last()
                .map_err(|error| UserError::usage(error.to_string()))?,
            quota_bytes: section.quota_mb.map(|mb| mb.saturating_mul(1_000_000)),
            ..Division::default()
        },
        json_hz: JSON_HZ,
        longest_wait: LAST_WAIT,
        voice: Voice::Log,
    };
    let rig = settings.target.rig();
    let ring = Ring::dated(folder, rig, &jiff::Zoned::now(), settings.division)?;
    let mut listener = Listener::over(member, ALL)?;
    listener.pulse = Some(listener.member.pulse()?);
    listener.member.ready()?;
    record_files(&settings, &mut listener, ring, create_private)?;
    listener.member.leave();
    Ok(0)
}

/// Name of the rig whose topics begin with `prefix`.
fn rig_name(prefix: &str) -> &str {
    let prefix = prefix.trim_end_matches('/');
    prefix.rsplit_once('/').map_or(prefix, |(_, name)| name)
}
