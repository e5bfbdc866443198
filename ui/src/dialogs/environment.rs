//! Surroundings of the light from a picture file, which is read on a thread.

use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_exchange::environment::{ENVIRONMENT_MEMORY, environment};
use maulstick_exchange::{Image, ImportError};
use maulstick_painting::edits::Relight;
use maulstick_types::scene::Environment;
use maulstick_types::values::ValueError;
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::paths;
use crate::reference::picture::unread;
use crate::widgets::context::{PanelContext, ask};

/// A picture that is being read.
#[derive(Debug, Default)]
pub(super) struct EnvironmentFile {
    coming: Option<(PathBuf, BackgroundTask<Result<Environment, ImportError>>)>,
}

impl EnvironmentFile {
    /// Begins to read a file.
    pub(super) fn read(&mut self, context: &Context, path: PathBuf) {
        let file = path.clone();
        let work = move || read(&file);
        self.coming = Some((path, BackgroundTask::start(context, "environment", work)));
    }

    /// Changes the light once the file is read.
    pub(super) fn take_in(&mut self, work: &mut PanelContext<'_>) {
        let Some(found) = self.coming.as_ref().map(|(_, task)| task.poll()) else {
            return;
        };
        let Poll::Ready(found) = found else {
            return;
        };
        let path = self.coming.take().map(|(path, _)| path).unwrap_or_default();
        let scene = work.rig.live.scene.as_ref();
        match (found, scene.map(|scene| scene.light.clone())) {
            (Some(Ok(environment)), Some(mut light)) => {
                light.environment = environment;
                let checked = light.check().map_err(ValueError::from);
                let expose = false;
                ask(work, checked.map(|()| Relight { light, expose }));
            }
            (Some(Err(error)), _) => {
                let file = paths::shown(&path);
                let what = tr!("{file} cannot surround the painting", file);
                work.notifications.fault(what, unread(&error));
            }
            _ => {}
        }
    }
}

fn read(path: &Path) -> Result<Environment, ImportError> {
    let image = Image::open_within(path, ENVIRONMENT_MEMORY)?;
    let name = path.file_stem().unwrap_or_default();
    environment(&image, &name.to_string_lossy())
}
