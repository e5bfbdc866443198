//! Databases that this process has open.
//!
//! SQLite locks a file by POSIX record locks, which belong to the process and the inode: closing *any*
//! descriptor of the inode drops all of them (POSIX.1-2017, `fcntl`). So no other part of the process may
//! open a file that is open here as a database, by whatever name it leads there.

use std::collections::BTreeMap;
use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Read as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Device and inode of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileId {
    device: u64,
    inode: u64,
}

impl FileId {
    /// The file that a name leads to.
    ///
    /// # Errors
    /// The error of the file system.
    pub fn of(path: &Path) -> Result<Self, Error> {
        std::fs::metadata(path).map(|found| Self::from(&found))
    }
}

impl From<&Metadata> for FileId {
    fn from(found: &Metadata) -> Self {
        Self {
            device: found.dev(),
            inode: found.ino(),
        }
    }
}

/// Open databases, and how often each is open.
static OPEN: Mutex<BTreeMap<FileId, usize>> = Mutex::new(BTreeMap::new());

fn open() -> MutexGuard<'static, BTreeMap<FileId, usize>> {
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A database that this process has open, until this is dropped.
#[derive(Debug)]
pub struct OpenDatabase(FileId);

impl OpenDatabase {
    /// Registers a database.
    #[must_use]
    pub fn new(file: FileId) -> Self {
        *open().entry(file).or_default() += 1;
        Self(file)
    }
}

impl Drop for OpenDatabase {
    fn drop(&mut self) {
        let mut open = open();
        match open.get_mut(&self.0) {
            Some(2..) => *open.entry(self.0).or_default() -= 1,
            _ => drop(open.remove(&self.0)),
        }
    }
}

/// Reads the first bytes of a file into `head`, as many as it has, and says how many. A database that is
/// open in this process is not opened a second time.
///
/// # Errors
/// [`ErrorKind::ResourceBusy`] where the file is open here, or the error of the file system.
pub fn read_head(path: &Path, head: &mut [u8]) -> Result<usize, Error> {
    // None is registered while the file is read.
    let open = open();
    if open.contains_key(&FileId::of(path)?) {
        return Err(Error::new(
            ErrorKind::ResourceBusy,
            "this painting is open here already",
        ));
    }
    let mut file = File::open(path)?;
    let mut read = 0;
    while read < head.len() {
        match file.read(&mut head[read..])? {
            0 => break,
            more => read += more,
        }
    }
    Ok(read)
}

#[cfg(test)]
mod tests {
    use nix::fcntl::{FcntlArg, fcntl};
    use nix::libc;

    use super::*;

    /// A write lock of the whole file, as a database has one.
    fn lock(kind: i32) -> libc::flock {
        libc::flock {
            l_type: kind as i16,
            l_whence: libc::SEEK_SET as i16,
            l_start: 0,
            l_len: 0,
            l_pid: 0,
        }
    }

    /// True if this process holds a POSIX lock of the file, as the kernel lists them.
    fn is_locked(file: FileId) -> bool {
        let me = std::process::id().to_string();
        let locks = std::fs::read_to_string("/proc/locks").expect("Linux");
        locks.lines().any(|line| {
            line.contains("POSIX")
                && line.split_whitespace().any(|word| word == me)
                && line.contains(&format!(":{} ", file.inode))
        })
    }

    #[test]
    fn a_look_at_an_open_database_leaves_its_locks_whatever_it_is_called() {
        let folder = tempfile::tempdir().expect("a folder");
        let [path, link] = ["a.maul", "b.maul"].map(|name| folder.path().join(name));
        std::fs::write(&path, "SQLite format 3\0").expect("written");
        std::fs::hard_link(&path, &link).expect("a second name");
        let file = FileId::of(&path).expect("there");
        let held = File::options().read(true).write(true).open(&path);
        let held = held.expect("open");
        fcntl(&held, FcntlArg::F_SETLK(&lock(libc::F_WRLCK))).expect("locked");
        let claims = [OpenDatabase::new(file), OpenDatabase::new(file)];
        for name in [&path, &link] {
            let error = read_head(name, &mut [0; 16]).expect_err("it is open here");
            assert_eq!(error.kind(), ErrorKind::ResourceBusy);
        }
        assert!(is_locked(file));
        let [first, second] = claims;
        drop(first);
        assert!(read_head(&path, &mut [0; 16]).is_err());
        drop(second);
        let mut head = [0; 99];
        assert_eq!(read_head(&path, &mut head).expect("read"), 16);
        assert!(head.starts_with(b"SQLite"));
        assert!(!is_locked(file), "what closing a descriptor does");
    }
}
