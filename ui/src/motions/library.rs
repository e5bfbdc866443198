//! Takes of a folder, the names first, then one take after the other, on a thread: the folder may be on a network.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::task::Poll;

use eframe::egui::Context;
use maulstick_device::Take;
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::paths;
use crate::motions::drawn_paths::DrawnPaths;
use crate::sessions::RECORDING;

/// So many takes of a folder are shown at most.
const MOST: usize = 400;
/// Larger files are recordings of sessions, no motions, bytes.
const LARGEST: u64 = 32 << 20;

/// A take that can be put down.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motion {
    pub path: PathBuf,
    /// Its strokes.
    pub drawn: DrawnPaths,
    /// Its length, s.
    pub seconds: f64,
}

/// State of a file, as far as it was read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Known {
    /// It is to be read, or is being read.
    Coming,
    /// It is no take that paints.
    Unusable,
    Here(Motion),
}

/// The takes of a folder.
#[derive(Debug)]
pub(crate) struct Library {
    pub folder: PathBuf,
    /// Length of the head that a 6-DOF stylus holds, m.
    head_m: f64,
    listing: Option<BackgroundTask<std::io::Result<Vec<PathBuf>>>>,
    /// The files in order, or why there are none.
    pub files: std::io::Result<Vec<(PathBuf, Known)>>,
    reading: Option<(usize, BackgroundTask<Option<Motion>>)>,
}

impl Library {
    /// The folder of a user who has chosen none.
    #[must_use]
    pub(crate) fn default_folder() -> PathBuf {
        let own = directories::ProjectDirs::from("", "", "maulstick");
        own.map_or_else(paths::documents, |own| own.data_dir().join("motions"))
    }

    /// Begins to list a folder.
    #[must_use]
    pub(crate) fn new(context: &Context, folder: PathBuf, head_m: f64) -> Self {
        let path = folder.clone();
        Self {
            listing: Some(BackgroundTask::start(context, "motions", move || {
                list(&path)
            })),
            folder,
            head_m,
            files: Ok(Vec::new()),
            reading: None,
        }
    }

    /// True until the folder is listed.
    #[must_use]
    pub(crate) fn is_coming(&self) -> bool {
        self.listing.is_some()
    }

    /// Takes in what was read, and has the next one read.
    pub(crate) fn take_in(&mut self, context: &Context) {
        if let Some(task) = &self.listing
            && let Poll::Ready(found) = task.poll()
        {
            let fell = || Err(ErrorKind::Interrupted.into());
            let found = found.unwrap_or_else(fell);
            let coming = |path: PathBuf| (path, Known::Coming);
            self.files = found.map(|files| files.into_iter().map(coming).collect());
            self.listing = None;
        }
        let Ok(files) = &mut self.files else {
            return;
        };
        if let Some((number, task)) = &self.reading
            && let Poll::Ready(read) = task.poll()
        {
            files[*number].1 = read.flatten().map_or(Known::Unusable, Known::Here);
            self.reading = None;
        }
        let next = files.iter().position(|(_, known)| *known == Known::Coming);
        if self.reading.is_none()
            && let Some(number) = next
        {
            let (path, head_m) = (files[number].0.clone(), self.head_m);
            let read = move || read(&path, head_m);
            self.reading = Some((number, BackgroundTask::start(context, "motion", read)));
        }
    }
}

/// Files of a folder that may be takes, by their names.
fn list(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let found = match std::fs::read_dir(folder) {
        Ok(found) => found,
        // It is made by who lays the first take into it.
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(error),
    };
    let is_take = |path: &PathBuf| {
        let about = std::fs::metadata(path);
        let is_small = about.is_ok_and(|about| about.is_file() && about.len() <= LARGEST);
        is_small && paths::ending(path) == RECORDING
    };
    let files = found.flatten().map(|entry| entry.path()).filter(is_take);
    let mut files: Vec<PathBuf> = files.collect();
    files.sort_by_cached_key(|path| paths::name(path).to_lowercase());
    files.truncate(MOST);
    Ok(files)
}

/// A take that paints; `None` for what is none.
fn read(path: &Path, head_m: f64) -> Option<Motion> {
    let take = Take::read(path)
        .inspect_err(|fault| tracing::debug!("no motion: {fault}"))
        .ok()?;
    let drawn = DrawnPaths::of(&take, head_m);
    (!drawn.strokes.is_empty()).then(|| Motion {
        path: path.to_owned(),
        seconds: take.length_ns() as f64 * 1e-9,
        drawn,
    })
}
