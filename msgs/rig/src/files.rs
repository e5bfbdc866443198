//! Files that are whole under their name, or not there at all.

use std::fs::File;
use std::io::{BufWriter, Error, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// Files that are being written and have not their name yet.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Files that are being written: they go where this process is told to stop meanwhile, see
/// [`clear_on_signals`].
#[derive(Debug)]
pub struct Unfinished(Vec<PathBuf>);

impl Unfinished {
    /// Remembers files until this is dropped.
    #[must_use]
    pub fn new(paths: Vec<PathBuf>) -> Self {
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        unfinished.extend(paths.iter().cloned());
        Self(paths)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        unfinished.retain(|path| !self.0.contains(path));
    }
}

/// From now on SIGINT and SIGTERM end the process with `code`, and no half-written file stays.
///
/// # Errors
/// What the system says where signals cannot be watched.
pub fn clear_on_signals(code: i32) -> Result<(), Error> {
    let mut signals = Signals::new([SIGTERM, SIGINT])?;
    let wait = move || {
        if signals.forever().next().is_some() {
            let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            for path in &*unfinished {
                // It may not be there yet.
                std::fs::remove_file(path).ok();
            }
            std::process::exit(code);
        }
    };
    std::thread::Builder::new()
        .name("signals".into())
        .spawn(wait)?;
    Ok(())
}

/// The name under which a file is written before it takes its own.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

/// Where a file is really written: what a link leads to, not the link.
fn target(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Whether something that is no file stands there, a device or a pipe: it is written into, and stays.
fn is_special(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Refuses to write over a painting, or another program's database: what it holds would be gone.
fn spare_databases(path: &Path) -> Result<(), Error> {
    const DATABASE: &[u8; 16] = b"SQLite format 3\0";
    let mut head = [0; 16];
    use std::io::Read as _;
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut head));
    match read {
        Ok(()) if &head == DATABASE => Err(Error::new(
            std::io::ErrorKind::AlreadyExists,
            "it is a painting, and nothing is written over one",
        )),
        _ => Ok(()),
    }
}

/// Writes a file through `fill`: whole under its name, or not at all.
///
/// # Errors
/// What the file system says; no half-written file is left.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), Error>,
) -> Result<(), Error> {
    if is_special(path) {
        let mut pipe = BufWriter::new(File::options().write(true).open(path)?);
        fill(&mut pipe)?;
        return pipe.flush();
    }
    let path = &target(path);
    spare_databases(path)?;
    let beside = beside(path);
    let _unfinished = Unfinished::new(vec![beside.clone()]);
    let write = || {
        let mut file = BufWriter::new(File::create(&beside)?);
        fill(&mut file)?;
        file.flush()?;
        file.get_ref().sync_all()?;
        std::fs::rename(&beside, path)
    };
    write().inspect_err(|_| {
        std::fs::remove_file(&beside).ok();
    })
}

/// Sees, before the work that fills it, whether a file can be written.
///
/// # Errors
/// What the file system says.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    if path.is_dir() {
        return Err(Error::from(std::io::ErrorKind::IsADirectory));
    }
    if is_special(path) {
        return File::options().write(true).open(path).map(drop);
    }
    spare_databases(path)?;
    let beside = beside(&target(path));
    File::create(&beside)?;
    std::fs::remove_file(&beside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_whole_or_not_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        write_whole(&path, |file| file.write_all(b"old")).expect("written");
        let failed = write_whole(&path, |file| {
            file.write_all(b"half of the ne")?;
            Err(Error::other("the disk is full"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(&path).expect("there"), b"old");
        write_whole(&path, |file| file.write_all(b"new")).expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), b"new");
        assert_eq!(
            std::fs::read_dir(folder.path()).expect("a folder").count(),
            1
        );
    }

    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let (real, link) = (
            folder.path().join("real.txt"),
            folder.path().join("link.txt"),
        );
        std::fs::write(&real, "old").expect("written");
        std::os::unix::fs::symlink(&real, &link).expect("a link");
        write_whole(&link, |file| file.write_all(b"new")).expect("written");
        assert!(
            std::fs::symlink_metadata(&link)
                .expect("there")
                .is_symlink()
        );
        assert_eq!(std::fs::read(&real).expect("there"), b"new");
        let null = folder.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &null).expect("a link");
        check_writable(&null).expect("a device");
        write_whole(&null, |file| file.write_all(b"gone")).expect("written");
        assert!(is_special(Path::new("/dev/null")));
    }

    #[test]
    fn nothing_is_written_over_a_painting() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        std::fs::write(&path, b"SQLite format 3\0and a painting").expect("written");
        assert!(check_writable(&path).is_err());
        let written = write_whole(&path, |file| file.write_all(b"a picture"));
        assert!(
            written
                .expect_err("refused")
                .to_string()
                .contains("a painting")
        );
        assert!(
            std::fs::read(&path)
                .expect("there")
                .ends_with(b"and a painting")
        );
    }

    #[test]
    fn what_cannot_be_written_is_known_before() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(check_writable(&folder.path().join("a.txt")).is_ok());
        assert!(check_writable(&folder.path().join("none/a.txt")).is_err());
        assert!(check_writable(folder.path()).is_err());
        assert_eq!(
            std::fs::read_dir(folder.path()).expect("a folder").count(),
            0
        );
    }
}
