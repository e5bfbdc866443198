//! Recordings beside the painting that a window before this one was cut off from: completed, and reported once.

use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_recorder::{CutOff, RecorderError, complete_in};
use maulstick_ui_kit::background_task::BackgroundTask;
use maulstick_ui_kit::notifications::Notifications;

use crate::dialogs::paths;

/// Recordings of a folder that were cut off, each whole or with what keeps it from being completed.
type Found = Result<Vec<Result<CutOff, RecorderError>>, RecorderError>;

/// Completion of the recordings in the folder of the painting.
#[derive(Debug, Default)]
pub(super) struct CutOffRecordings {
    /// The folder that was looked through.
    folder: PathBuf,
    task: Option<BackgroundTask<Found>>,
}

impl CutOffRecordings {
    /// Looks through the folder of a painting in a file, once, and notifies of what was found.
    pub(super) fn poll(
        &mut self,
        context: &Context,
        painting: &Path,
        notifications: &mut Notifications,
    ) {
        if let Some(folder) = painting.parent().filter(|folder| **folder != self.folder)
            && self.task.is_none()
        {
            folder.clone_into(&mut self.folder);
            let folder = folder.to_owned();
            let run = move || complete_in(&folder);
            self.task = Some(BackgroundTask::start(context, "recordings", run));
        }
        let Some(Poll::Ready(found)) = self.task.as_ref().map(BackgroundTask::poll) else {
            return;
        };
        self.task = None;
        match found {
            Some(Ok(found)) => found.iter().for_each(|found| match found {
                Ok(cut) => notify(&cut.file, notifications),
                Err(error) => tracing::warn!("a recording beside the painting: {error}"),
            }),
            Some(Err(error)) => tracing::warn!("recordings beside the painting: {error}"),
            None => {}
        }
    }
}

fn notify(file: &Path, notifications: &mut Notifications) {
    let file = paths::shown(file);
    notifications.fault(
        tr!(
            "The recording {file} ended early: the window that made it was cut off.",
            file
        ),
        tr!("All that was recorded until then can be played."),
    );
}
