//! Recordings beside the painting that a window before this one was cut off from: completed, and offered once.

use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_recorder::{CutOff, RecorderError, complete_in};
use maulstick_ui_kit::background_task::BackgroundTask;
use maulstick_ui_kit::notifications::Notifications;

use crate::dialogs::paths;

/// Completion of the recordings in the folder of the painting.
#[derive(Debug, Default)]
pub(super) struct CutOffRecordings {
    /// The folder that was looked through.
    folder: PathBuf,
    task: Option<BackgroundTask<Result<Vec<CutOff>, RecorderError>>>,
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
            Some(Ok(found)) => found
                .iter()
                .for_each(|cut| notify(&cut.file, notifications)),
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
