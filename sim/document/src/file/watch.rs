//! Checks that the files of an open painting are still at their paths: SQLite keeps writing into files that no longer
//! have a name, and what is committed there is lost with the process.

use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use maulstick_files::FileId;

use crate::file::database::{companion, resolved};

/// The files of an open painting by device and inode.
#[derive(Debug)]
pub(crate) struct FileWatch {
    path: PathBuf,
    /// `None` if the painting is in no file of the system, as with another VFS.
    file: Option<FileId>,
    /// `None` until SQLite has created it.
    journal: Option<FileId>,
}

/// State of the files of an open painting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FileState {
    /// They are at their paths.
    InPlace,
    /// The file has a second name.
    Linked,
    /// This one was removed or replaced.
    Gone(PathBuf),
}

impl FileWatch {
    /// Watch over a painting that was just opened.
    pub(crate) fn new(path: &Path) -> Self {
        let path = resolved(path);
        Self {
            file: FileId::of(&path).ok(),
            journal: FileId::of(&companion(&path, "-wal")).ok(),
            path,
        }
    }

    /// Compares the files at the paths with those that were opened.
    pub(crate) fn check(&mut self) -> FileState {
        let Some(file) = self.file else {
            return FileState::InPlace;
        };
        let found = std::fs::metadata(&self.path);
        let links = match found {
            Ok(found) if FileId::from(&found) == file => found.nlink(),
            _ => return FileState::Gone(self.path.clone()),
        };
        let journal = companion(&self.path, "-wal");
        let found = FileId::of(&journal).ok();
        self.journal = self.journal.or(found);
        match self.journal == found {
            false => FileState::Gone(journal),
            true if links > 1 => FileState::Linked,
            true => FileState::InPlace,
        }
    }

    /// Removes the journal of a painting that was moved, if it is still this one's: no other painting could be created
    /// beside it.
    pub(crate) fn remove_journal(&self) {
        let journal = companion(&self.path, "-wal");
        if self.journal.is_some() && FileId::of(&journal).ok() == self.journal {
            std::fs::remove_file(journal).ok();
        }
    }
}
