//! The recorder: `maulstick record`, a process beside the window.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use eframe::egui::Context;

use crate::dialogs::paths;
use crate::rig::child_process::{ChildProcess, Ended, Refused};
use crate::rig::state::RigState;
use crate::sessions::RECORDING;
use crate::widgets::notifications::Notifications;

/// Interval at which the elapsed time is shown.
const TICK: Duration = Duration::from_millis(500);

/// A recording in progress.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingProgress {
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
        notifications: &mut Notifications,
    ) -> std::io::Result<Self> {
        let now = jiff::Zoned::now().strftime("%Y-%m-%d %H.%M").to_string();
        let painting = painting(rig);
        let file = place(&painting, &now);
        let child = ChildProcess::start(context, {
            command.arg("--output").arg(&file);
            command
        })?;
        if painting.as_os_str().is_empty() {
            notifications.fault(
                tr!("This recording cannot be painted again: the painting is in no file."),
                tr!("Save the painting, then record anew."),
            );
        }
        rig.recording = Some(RecordingProgress {
            file,
            begun_ns: rig.now_ns,
        });
        Ok(Self { child })
    }

    /// Ends the recording.
    pub(crate) fn stop(&self) {
        self.child.interrupt();
    }

    /// Tells the end of the recording; true then.
    pub(crate) fn follow(
        &mut self,
        context: &Context,
        rig: &mut RigState,
        notifications: &mut Notifications,
    ) -> bool {
        let Some(Ended { result, .. }) = self.child.ended() else {
            context.request_repaint_after(TICK);
            return false;
        };
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

/// The file of the painting; empty for one in memory.
fn painting(rig: &RigState) -> PathBuf {
    let node = rig.paint.as_ref();
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
