//! Probe of the disk: tests whether it can still read the bytes of a painting.
//!
//! Where the system reports a read error, SQLite reports a malformed database (`SQLITE_IOERR_CORRUPTFS` in `vdbe.c`),
//! as for a file with wrong bytes. A painting on a failing disk is not damaged.

use std::fs::File;
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};

use maulstick_files::companion;

use crate::error::DocumentError;
use crate::file::path::resolved;

/// Number of bytes read at once.
const PIECE: usize = 1 << 20;

/// A separate handle of the file beside SQLite's. It is opened once the file is locked, and closed after SQLite has
/// closed it: closing any file descriptor of it drops all locks of this process on the file.
#[derive(Debug)]
pub(crate) struct Probe {
    file: File,
    path: PathBuf,
}

impl Probe {
    /// A probe of a painting locked by this process; `None` where it cannot be opened.
    pub(crate) fn new(path: &Path) -> Option<Self> {
        let path = resolved(path);
        let file = File::open(&path).ok()?;
        Some(Self { file, path })
    }

    /// The disk's error where bytes of the painting or its journal cannot be read, otherwise `error`.
    pub(crate) fn judged(&self, error: DocumentError) -> DocumentError {
        if !matches!(error, DocumentError::Damaged(_)) {
            return error;
        }
        // SQLite has no locks on the journal.
        let journal = File::open(companion(&self.path, "-wal")).ok();
        let mut files = [Some(&self.file), journal.as_ref()].into_iter().flatten();
        match files.find_map(|file| read_through(file).err()) {
            Some(fault) => DocumentError::Disk(fault.to_string()),
            None => error,
        }
    }
}

fn read_through(file: &File) -> std::io::Result<()> {
    let mut piece = vec![0; PIECE];
    let mut at = 0;
    loop {
        match file.read_at(&mut piece, at)? {
            0 => return Ok(()),
            read => at += read as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn damaged() -> DocumentError {
        DocumentError::Damaged("page 7 is missing".to_owned())
    }

    #[test]
    fn a_file_whose_bytes_cannot_be_read_is_a_fault_of_the_disk() {
        let folder = tempfile::tempdir().expect("a folder");
        // A folder can be opened as a file, and each read of it fails (EISDIR).
        let probe = Probe::new(folder.path()).expect("opened");
        let judged = probe.judged(damaged());
        assert!(matches!(judged, DocumentError::Disk(_)), "{judged:?}");
        // Only damage is probed.
        let judged = probe.judged(DocumentError::Full);
        assert!(matches!(judged, DocumentError::Full), "{judged:?}");
    }

    #[test]
    fn a_journal_whose_bytes_cannot_be_read_is_a_fault_of_the_disk() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sea.maul");
        std::fs::write(&path, "paint").expect("written");
        let probe = Probe::new(&path).expect("opened");
        let judged = probe.judged(damaged());
        assert!(matches!(judged, DocumentError::Damaged(_)), "{judged:?}");
        std::fs::create_dir(companion(&path, "-wal")).expect("made");
        let judged = probe.judged(damaged());
        assert!(matches!(judged, DocumentError::Disk(_)), "{judged:?}");
    }
}
