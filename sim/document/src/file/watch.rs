//! Checks that the files of an open painting are still at their paths: SQLite keeps writing into files without a name,
//! and commits there are lost with the process.

use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use maulstick_files::{FileId, companion};

use crate::file::path::{length, resolved};

/// The files of an open painting by device and inode.
#[derive(Debug)]
pub(crate) struct FileWatch {
    path: PathBuf,
    /// `None` if the painting is not in a file of the system, as with another VFS.
    file: Option<FileId>,
    /// `None` until SQLite has created the journal.
    journal: Option<FileId>,
    /// Sizes of both after the last write, bytes.
    bytes: [u64; 2],
}

/// State of the files of an open painting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FileState {
    /// They are at their paths.
    InPlace,
    /// The file has a second name.
    Linked,
    /// The file or its journal was removed or replaced.
    Gone(PathBuf),
    /// The file or its journal was cut short, or its beginning overwritten, and its contents are lost.
    Cut(PathBuf),
}

/// First bytes of a write-ahead log: its magic number, whose last bit is the byte order of its checksums.
const JOURNAL_MAGIC: u32 = 0x377f_0682;

impl FileWatch {
    /// Watch over a painting that was just opened.
    pub(crate) fn new(path: &Path) -> Self {
        let path = resolved(path);
        let mut watch = Self {
            file: FileId::of(&path).ok(),
            journal: FileId::of(&companion(&path, "-wal")).ok(),
            bytes: [0; 2],
            path,
        };
        watch.note_sizes();
        watch
    }

    /// Records the sizes of the files after a write, which makes neither shorter.
    pub(crate) fn note_sizes(&mut self) {
        let paths = [self.path.clone(), companion(&self.path, "-wal")];
        for (bytes, path) in self.bytes.iter_mut().zip(paths) {
            *bytes = length(&path).unwrap_or(0).max(*bytes);
        }
    }

    /// Records that the journal was merged into the file, which makes it shorter.
    pub(crate) fn note_merged(&mut self) {
        self.bytes[1] = 0;
        self.note_sizes();
    }

    /// Compares the files at the paths with those that were opened.
    pub(crate) fn check(&mut self) -> FileState {
        let Some(file) = self.file else {
            return FileState::InPlace;
        };
        let links = match std::fs::metadata(&self.path) {
            Ok(found) if FileId::from(&found) == file => {
                if found.len() < self.bytes[0] {
                    return FileState::Cut(self.path.clone());
                }
                found.nlink()
            }
            // A failing disk reports an error on writing.
            Err(error) if error.kind() != ErrorKind::NotFound => return FileState::InPlace,
            _ => return FileState::Gone(self.path.clone()),
        };
        let journal = companion(&self.path, "-wal");
        let found = match FileId::of(&journal) {
            Err(error) if error.kind() != ErrorKind::NotFound => return FileState::InPlace,
            found => found.ok(),
        };
        self.journal = self.journal.or(found);
        if self.journal != found {
            FileState::Gone(journal)
        } else if length(&journal).unwrap_or(0) < self.bytes[1] || is_overwritten(&journal) {
            FileState::Cut(journal)
        } else if links > 1 {
            FileState::Linked
        } else {
            FileState::InPlace
        }
    }

    /// Removes the journal of a painting that was moved, if it is still this one's: otherwise no other painting could
    /// be created beside it.
    pub(crate) fn remove_journal(&self) {
        let journal = companion(&self.path, "-wal");
        if self.journal.is_some() && FileId::of(&journal).ok() == self.journal {
            std::fs::remove_file(journal).ok();
        }
    }
}

/// True if a journal lacks its header: it was truncated and written on since. SQLite locks the painting, not its
/// journal, so opening and closing the journal drops no lock.
fn is_overwritten(journal: &Path) -> bool {
    let mut magic = [0; 4];
    let read = File::open(journal).and_then(|mut file| file.read_exact(&mut magic));
    read.is_ok() && u32::from_be_bytes(magic) & !1 != JOURNAL_MAGIC
}
