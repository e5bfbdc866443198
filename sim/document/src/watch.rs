//! Checks that the files of an open painting are still at their paths: SQLite keeps writing into files that no longer
//! have a name, and what is committed there is lost with the process.

use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use maulstick_files::FileId;

use crate::database::{beside, resolved};

/// The files of an open painting by device and inode.
#[derive(Debug)]
pub(crate) struct Watch {
    path: PathBuf,
    /// `None` if the painting is in no file of the system, as with another VFS.
    file: Option<FileId>,
    /// None until SQLite has made it.
    journal: Option<FileId>,
}

/// State of the files of an open painting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// They are where they were.
    Whole,
    /// The file has a second name.
    Linked,
    /// One of them is gone, or another is in its place; this one.
    Gone(PathBuf),
}

impl Watch {
    /// Begins to watch a painting that was just opened.
    pub(crate) fn new(path: &Path) -> Self {
        let path = resolved(path);
        Self {
            file: FileId::of(&path).ok(),
            journal: FileId::of(&beside(&path, "-wal")).ok(),
            path,
        }
    }

    /// Looks at the names of the files.
    pub(crate) fn look(&mut self) -> Found {
        let Some(file) = self.file else {
            return Found::Whole;
        };
        let found = std::fs::metadata(&self.path);
        let links = match found {
            Ok(found) if FileId::from(&found) == file => found.nlink(),
            _ => return Found::Gone(self.path.clone()),
        };
        let journal = beside(&self.path, "-wal");
        let found = FileId::of(&journal).ok();
        self.journal = self.journal.or(found);
        match self.journal == found {
            false => Found::Gone(journal),
            true if links > 1 => Found::Linked,
            true => Found::Whole,
        }
    }

    /// Removes the journal of a painting that was moved, if it is still this one's: no other painting could be created
    /// beside it.
    pub(crate) fn remove_journal(&self) {
        let journal = beside(&self.path, "-wal");
        if self.journal.is_some() && FileId::of(&journal).ok() == self.journal {
            std::fs::remove_file(journal).ok();
        }
    }
}
