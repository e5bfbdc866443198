//! The recorder: `maulstick recording record`, a process beside the window.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use eframe::egui::Context;
use maulstick_ui_kit::notifications::Notifications;
use serde::Deserialize;

use crate::dialogs::paths;
use crate::rig::child_process::{ChildProcess, Ended, Refused};
use crate::rig::state::RigState;
use crate::sessions::RECORDING;

/// Interval at which the elapsed time is shown.
const TICK: Duration = Duration::from_millis(500);

/// A recording in progress.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordingProgress {
    /// Its file.
    pub file: PathBuf,
    /// Its beginning, rig clock, ns.
    pub begun_ns: u64,
}

/// The process.
#[derive(Debug)]
pub(crate) struct Recorder {
    child: ChildProcess,
}

impl Recorder {
    /// Begins a recording by `command`, which lacks its file.
    ///
    /// # Errors
    /// The system's, where the process cannot be started.
    pub(crate) fn start(
        context: &Context,
        mut command: Command,
        rig: &mut RigState,
    ) -> std::io::Result<Self> {
        let now = jiff::Zoned::now().strftime("%Y-%m-%d %H.%M").to_string();
        let file = place(&painting(rig), &now);
        let child = ChildProcess::start(context, {
            command.arg("--json").arg("--output").arg(&file);
            command
        })?;
        rig.recording = Some(RecordingProgress {
            file,
            begun_ns: rig.live.now_ns,
        });
        Ok(Self { child })
    }

    /// Ends the recording.
    pub(crate) fn stop(&self) {
        self.child.interrupt();
    }

    /// Tells what the recorder says, and the end of the recording; true then.
    pub(crate) fn follow(
        &mut self,
        context: &Context,
        rig: &mut RigState,
        notifications: &mut Notifications,
    ) -> bool {
        self.child
            .lines()
            .for_each(|line| tell(&line, notifications));
        let Some(Ended { lines, result }) = self.child.ended() else {
            context.request_repaint_after(TICK);
            return false;
        };
        lines.iter().for_each(|line| tell(line, notifications));
        let recording = rig.recording.take();
        let file = recording.map_or_else(String::new, |recording| paths::shown(&recording.file));
        match result {
            Ok(()) => notifications.note(tr!("The recording is in {file}.", file)),
            Err(Refused { what, help }) => {
                let what = match what.is_empty() {
                    true => tr!("The recorder ended by itself").to_owned(),
                    false => what,
                };
                let help = match help.is_empty() {
                    true => tr!("What came before is in {file}. Record anew.", file),
                    false => help,
                };
                notifications.fault(what, help);
            }
        }
        true
    }
}

/// A line of `maulstick recording record --json` that concerns the painter.
#[derive(Debug, Deserialize)]
struct RecorderLine {
    /// Why the painting cannot be copied at present.
    lacks_painting: String,
}

/// A line that says that the recording goes on in another file, for the journal broke off.
#[derive(Debug, Deserialize)]
struct BrokenOff {
    /// The file.
    recording: PathBuf,
    /// True, or absent where a recording begins.
    broke_off: bool,
}

/// Tells what the painter has to know of a line.
fn tell(line: &str, notifications: &mut Notifications) {
    if let Ok(BrokenOff {
        recording,
        broke_off: true,
    }) = serde_json::from_str(line)
    {
        let file = paths::shown(&recording);
        notifications.note(tr!("The recording goes on in {file}.", file));
    }
    if let Ok(RecorderLine {
        lacks_painting: why,
    }) = serde_json::from_str(line)
    {
        notifications.fault(
            tr!("So far this recording cannot be painted again: {why}", why),
            tr!("Once the painting is in a file, it can from there on."),
        );
    }
}

/// The file of the painting; empty for one in memory.
fn painting(rig: &RigState) -> PathBuf {
    let node = rig.live.paint.as_ref();
    node.map_or_else(PathBuf::new, |node| PathBuf::from(&node.status.path))
}

/// The first free name of a recording that begins at `now`: beside the painting, or among the documents of the user.
pub(super) fn place(painting: &Path, now: &str) -> PathBuf {
    let (folder, stem) = match (painting.parent(), painting.file_stem()) {
        (Some(folder), Some(stem)) => (folder.to_owned(), stem.to_string_lossy().into_owned()),
        _ => (paths::documents(), tr!("Painting").to_owned()),
    };
    paths::free(&folder, &format!("{stem} {now}"), RECORDING)
}
