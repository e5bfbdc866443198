//! Recent paintings, the newest first.

use std::path::{Path, PathBuf};
use std::task::Poll;
use std::time::SystemTime;

use eframe::egui::{Button, Context, RichText, Sense, Ui};
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::browser::PICTURE;
use crate::dialogs::browser::pictures::Pictures;
use crate::dialogs::paths;

/// Greatest number of shown paintings.
const MOST: usize = 4;

/// A painting that was open before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Recent {
    pub path: PathBuf,
    /// Time since it was last changed, in words; `None` if the file is gone.
    pub age: Option<String>,
}

/// The recent paintings, as they come.
#[derive(Debug)]
pub(crate) struct RecentList {
    coming: Option<BackgroundTask<Vec<Recent>>>,
    here: Vec<Recent>,
}

impl RecentList {
    /// Checks which of these paintings still exist, except the open one.
    #[must_use]
    pub(crate) fn new(context: &Context, recent: &[PathBuf], open: &Path) -> Self {
        let others = recent.iter().filter(|path| path.as_path() != open);
        let paths: Vec<PathBuf> = others.take(MOST).cloned().collect();
        let look = move || {
            let now = SystemTime::now();
            let of = |path: PathBuf| {
                let changed = std::fs::metadata(&path).and_then(|about| about.modified());
                Recent {
                    age: changed.ok().map(|changed| paths::age(changed, now)),
                    path,
                }
            };
            paths.into_iter().map(of).collect()
        };
        Self {
            coming: Some(BackgroundTask::start(context, "recent", look)),
            here: Vec::new(),
        }
    }

    /// A list of known paintings.
    #[cfg(test)]
    pub(crate) fn of(here: Vec<Recent>) -> Self {
        Self { coming: None, here }
    }

    /// Shows them; the one that was chosen.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        mut pictures: Option<&mut Pictures>,
    ) -> Option<PathBuf> {
        if let Some(task) = &self.coming
            && let Poll::Ready(found) = task.poll()
        {
            self.here = found.unwrap_or_default();
            self.coming = None;
        }
        if self.here.is_empty() {
            return None;
        }
        let mut chosen = None;
        ui.label(RichText::new(tr!("Recent paintings")).weak());
        for recent in &self.here {
            let folder = recent.path.parent().map_or_else(String::new, paths::shown);
            let age = recent.age.as_deref().unwrap_or(tr!("no longer there"));
            let beside = RichText::new(age).weak().small();
            let response = ui.horizontal(|ui| {
                if let Some(pictures) = &mut pictures {
                    let (place, _) = ui.allocate_exact_size(PICTURE, Sense::hover());
                    pictures.draw(ui, place, &recent.path);
                }
                let button = Button::new(paths::name(&recent.path))
                    .right_text(beside)
                    .truncate()
                    .frame_when_inactive(false)
                    .min_size([ui.available_width(), 24.0].into());
                ui.add_enabled(recent.age.is_some(), button)
            });
            let response = response.inner;
            if response.on_hover_text(folder).clicked() {
                chosen = Some(recent.path.clone());
            }
        }
        ui.add_space(6.0);
        chosen
    }
}
