//! A recording in progress.

use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui::Context;
use maulstick_recorder::{
    Continuation, CopyTrouble, Recorder, RecorderEvent, RecorderSettings, Ring,
};
use maulstick_rig::UserError;
use maulstick_ui_kit::notifications::Notifications;
use tokio::runtime::Runtime;

use crate::dialogs::paths;
use crate::rig::state::RigState;
use crate::sessions::RECORDING;
use crate::sessions::progress::RecordingProgress;

/// Interval at which the elapsed time is shown.
const TICK: Duration = Duration::from_millis(500);

/// Begins a recording beside the painting.
pub(super) fn start(runtime: &Runtime, rig: &mut RigState) -> Recorder {
    let now = jiff::Zoned::now().strftime("%Y-%m-%d %H.%M").to_string();
    let file = place(&painting(rig), &now);
    let settings = RecorderSettings::default();
    let ring = Ring::new(&file, settings.division);
    let recorder = Recorder::start(runtime.handle(), &rig.live.name, settings, ring);
    rig.recording = Some(RecordingProgress {
        file,
        begun_ns: rig.live.now_ns,
    });
    recorder
}

/// Notifies of what the recorder reports, and of its end; true then.
pub(super) fn poll(
    recorder: &mut Recorder,
    context: &Context,
    rig: &mut RigState,
    notifications: &mut Notifications,
) -> bool {
    let result = recorder.result();
    while let Ok(event) = recorder.events.try_recv() {
        if let (RecorderEvent::Continued { file, .. }, Some(recording)) =
            (&event, &mut rig.recording)
        {
            file.clone_into(&mut recording.file);
        }
        notify(&event, notifications);
    }
    let Some(result) = result else {
        context.request_repaint_after(TICK);
        return false;
    };
    let recording = rig.recording.take();
    let file = recording.map_or_else(String::new, |recording| paths::shown(&recording.file));
    match result {
        Ok(()) => notifications.note(tr!("The recording is in {file}.", file)),
        Err(error) => {
            let fault = UserError::from(error);
            let help = fault
                .help
                .unwrap_or_else(|| tr!("What came before is in {file}. Record anew.", file));
            notifications.fault(fault.what, help);
        }
    }
    true
}

/// Notifies of an event that concerns the painter.
pub(super) fn notify(event: &RecorderEvent, notifications: &mut Notifications) {
    match event {
        RecorderEvent::Continued {
            file,
            cause: Continuation::JournalBroke,
        } => {
            let file = paths::shown(file);
            notifications.note(tr!("The recording continues in {file}.", file));
        }
        RecorderEvent::PaintingUnavailable(trouble) => {
            let why = match trouble {
                CopyTrouble::InMemory => tr!("the painting is in no file"),
                CopyTrouble::Failed(error) => &error.to_string(),
            };
            notifications.fault(
                tr!("So far this recording cannot be painted again: {why}", why),
                tr!("Once the painting is in a file, it can from there on."),
            );
        }
        RecorderEvent::FileEnded(summary) if summary.lacks_painting => {
            let file = paths::shown(&summary.file);
            notifications.fault(
                tr!(
                    "The recording {file} cannot be painted again: it lacks the painting.",
                    file
                ),
                tr!("Keep the painting in a file before you record."),
            );
        }
        RecorderEvent::Begun { .. }
        | RecorderEvent::Continued { .. }
        | RecorderEvent::PaintingAttached { .. }
        | RecorderEvent::FileEnded(_) => {}
    }
}

/// The file of the painting; empty for one in memory.
pub(super) fn painting(rig: &RigState) -> PathBuf {
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
