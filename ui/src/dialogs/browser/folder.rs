//! Listing of a folder, read on a thread: the folder may be on a network.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};
use std::task::Poll;
use std::time::SystemTime;

use eframe::egui::Context;
use maulstick_ui_kit::background_task::BackgroundTask;

use crate::dialogs::paths;

/// Greatest number of displayed entries of a folder.
const MOST: usize = 5_000;

/// A file or folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub name: String,
    /// True for a folder.
    pub is_folder: bool,
    /// When it was last changed, in words; empty for a folder.
    pub age: String,
}

/// Content of a folder.
#[derive(Debug)]
enum Content {
    Coming(BackgroundTask<std::io::Result<Vec<Entry>>>),
    Here(std::io::Result<Vec<Entry>>),
}

/// A folder that is being looked at.
#[derive(Debug)]
pub(crate) struct Folder {
    /// Path of the folder.
    pub path: PathBuf,
    kinds: &'static [&'static str],
    content: Option<Content>,
}

impl Folder {
    /// A folder, of whose files those that end in `kinds` count.
    #[must_use]
    pub(crate) fn new(path: PathBuf, kinds: &'static [&'static str]) -> Self {
        Self {
            path,
            kinds,
            content: None,
        }
    }

    /// A folder whose entries are known.
    #[cfg(test)]
    pub(crate) fn of(path: PathBuf, kinds: &'static [&'static str], entries: Vec<Entry>) -> Self {
        Self {
            path,
            kinds,
            content: Some(Content::Here(Ok(entries))),
        }
    }

    /// Changes to another folder, or stays.
    pub(crate) fn go(&mut self, path: PathBuf) {
        if self.path != path {
            self.path = path;
            self.content = None;
        }
    }

    /// The entries; `None` until they have been read.
    ///
    /// # Errors
    /// The system's error.
    pub(crate) fn entries(&mut self, context: &Context) -> Option<Result<&[Entry], &Error>> {
        let content = self.content.get_or_insert_with(|| {
            let (path, kinds) = (self.path.clone(), self.kinds);
            let read = move || read(&path, kinds);
            Content::Coming(BackgroundTask::start(context, "folder", read))
        });
        if let Content::Coming(task) = content
            && let Poll::Ready(found) = task.poll()
        {
            let fell = || Err(ErrorKind::Interrupted.into());
            *content = Content::Here(found.unwrap_or_else(fell));
        }
        match content {
            Content::Coming(_) => None,
            Content::Here(Ok(entries)) => Some(Ok(entries)),
            Content::Here(Err(error)) => Some(Err(error)),
        }
    }
}

fn read(path: &Path, kinds: &[&str]) -> std::io::Result<Vec<Entry>> {
    let now = SystemTime::now();
    let found = std::fs::read_dir(path)?;
    let mut entries = Vec::new();
    for entry in found.flatten().take(MOST) {
        let name = entry.file_name().to_string_lossy().into_owned();
        // A link is followed to its target.
        let Ok(about) = std::fs::metadata(entry.path()) else {
            continue;
        };
        let is_wanted = about.is_dir() || kinds.contains(&paths::ending(Path::new(&name)).as_str());
        if name.starts_with('.') || !is_wanted {
            continue;
        }
        let changed = about.modified().ok().filter(|_| !about.is_dir());
        entries.push(Entry {
            name,
            is_folder: about.is_dir(),
            age: changed.map_or_else(String::new, |changed| paths::age(changed, now)),
        });
    }
    entries.sort_by_cached_key(|entry| (!entry.is_folder, entry.name.to_lowercase()));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_come_first_and_other_files_do_not_count() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["sea.maul", "Birch.MAUL", "notes.txt", ".hidden.maul"] {
            std::fs::write(folder.path().join(name), "").expect("written");
        }
        std::fs::create_dir(folder.path().join("studies")).expect("made");
        let entries = read(folder.path(), &[paths::PAINTING]).expect("read");
        let names: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(names, ["studies", "Birch.MAUL", "sea.maul"]);
        assert!(entries[0].is_folder && entries[0].age.is_empty());
        assert_eq!(entries[2].age, "just now");
        let none = read(&folder.path().join("none"), &[]).expect_err("none");
        assert_eq!(none.kind(), ErrorKind::NotFound);
        let file = read(&folder.path().join("sea.maul"), &[]).expect_err("a file");
        assert_eq!(file.kind(), ErrorKind::NotADirectory);
    }
}
