//! Files that are whole under their name, or not there at all.

use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use crate::kind::{Kind, destination};
use crate::private::create;

/// Files that are being written and have not their name yet.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Files that are being written: they are removed if this process has to stop meanwhile, see
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

/// Removes a file, or a folder with all that is in it; it may not be there.
fn remove(path: &Path) {
    if path.is_dir() && !path.is_symlink() {
        std::fs::remove_dir_all(path).ok()
    } else {
        std::fs::remove_file(path).ok()
    };
}

/// From now on SIGINT and SIGTERM end the process with `code`, and no half-written file stays.
///
/// # Errors
/// The system's error if signals cannot be watched.
pub fn clear_on_signals(code: i32) -> Result<(), Error> {
    let mut signals = Signals::new([SIGTERM, SIGINT])?;
    let wait = move || {
        if signals.forever().next().is_some() {
            let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
            for path in &*unfinished {
                remove(path);
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
    // Two threads may write to one name; the last one has it.
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let number = NUMBER.fetch_add(1, Relaxed);
    name.push(format!(".{}-{number}.tmp", std::process::id()));
    path.with_file_name(name)
}

/// Writes a file of a kind through `fill`: whole under its name, or not at all.
///
/// # Errors
/// Reason why the file at the path may not be replaced, or the error of the file system; no half-written file is left.
pub fn write_whole(
    path: &Path,
    kind: Kind,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), Error>,
) -> Result<(), Error> {
    write_whole_at(path, kind, |beside| {
        let mut file = BufWriter::new(create(beside, kind)?);
        fill(&mut file)?;
        file.flush()?;
        file.get_ref().sync_all()
    })
}

/// As [`write_whole`], for what is written by another program: `fill` gets the name that the file has meanwhile.
///
/// # Errors
/// As [`write_whole`].
pub fn write_whole_at(
    path: &Path,
    kind: Kind,
    fill: impl FnOnce(&Path) -> Result<(), Error>,
) -> Result<(), Error> {
    write_to(&destination(path, kind)?, fill)
}

/// Makes a folder of files, whole under its name or not at all: `fill` gets the name that the folder has meanwhile.
///
/// # Errors
/// If there is anything at the path but an empty folder, or the error of `fill` or the file system; no half-written folder
/// is left.
pub fn write_folder(
    path: &Path,
    fill: impl FnOnce(&Path) -> Result<(), Error>,
) -> Result<(), Error> {
    check_folder(path)?;
    // A name that ends in a slash has the same last part.
    write_to(&path.components().collect::<PathBuf>(), |beside| {
        std::fs::create_dir(beside)?;
        fill(beside)
    })
}

/// Sees whether a folder can be made by [`write_folder`].
///
/// # Errors
/// As there.
pub fn check_folder(path: &Path) -> Result<(), Error> {
    let there = match std::fs::read_dir(path) {
        Ok(mut files) => files.next().is_some(),
        Err(_) => path.symlink_metadata().is_ok(),
    };
    if there {
        Err(Error::new(
            ErrorKind::AlreadyExists,
            "it exists already: name a new folder",
        ))
    } else {
        Ok(())
    }
}

fn write_to(path: &Path, fill: impl FnOnce(&Path) -> Result<(), Error>) -> Result<(), Error> {
    let beside = beside(path);
    let _unfinished = Unfinished::new(vec![beside.clone()]);
    let written = fill(&beside).and_then(|()| std::fs::rename(&beside, path));
    written.inspect_err(|_| remove(&beside))
}

/// Sees, before the work that fills it, whether a file of a kind can be written.
///
/// # Errors
/// As [`write_whole`].
pub fn check_writable(path: &Path, kind: Kind) -> Result<(), Error> {
    let path = &destination(path, kind)?;
    let beside = beside(path);
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
        write_whole(&path, Kind::Own, |file| file.write_all(b"old")).expect("written");
        let failed = write_whole(&path, Kind::Own, |file| {
            file.write_all(b"half of the ne")?;
            Err(Error::other("the disk is full"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(&path).expect("there"), b"old");
        write_whole(&path, Kind::Own, |file| file.write_all(b"new")).expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), b"new");
        assert_eq!(
            std::fs::read_dir(folder.path()).expect("a folder").count(),
            1
        );
    }

    #[test]
    fn a_folder_is_whole_or_not_there_and_takes_the_place_of_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("frames/");
        let frame = |to: &Path| std::fs::write(to.join("1.png"), "picture");
        let failed = write_folder(&path, |to| {
            frame(to)?;
            Err(Error::other("the disk is full"))
        });
        assert!(failed.is_err());
        let names = || std::fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(names(), 0);
        std::fs::create_dir(&path).expect("made");
        write_folder(&path, frame).expect("an empty one gives way");
        assert_eq!(
            std::fs::read(path.join("1.png")).expect("there"),
            b"picture"
        );
        let refused = write_folder(&path, frame).expect_err("refused");
        assert_eq!(refused.kind(), ErrorKind::AlreadyExists);
        let file = folder.path().join("a.txt");
        std::fs::write(&file, "own").expect("written");
        assert!(write_folder(&file, frame).is_err());
        assert_eq!(
            (names(), std::fs::read(&file).expect("there")),
            (2, b"own".into())
        );
    }

    #[test]
    fn links_stay_what_they_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let (real, link) = (
            folder.path().join("real.txt"),
            folder.path().join("link.txt"),
        );
        std::fs::write(&real, "old").expect("written");
        std::os::unix::fs::symlink(&real, &link).expect("a link");
        write_whole(&link, Kind::Own, |file| file.write_all(b"new")).expect("written");
        assert!(
            std::fs::symlink_metadata(&link)
                .expect("there")
                .is_symlink()
        );
        assert_eq!(std::fs::read(&real).expect("there"), b"new");
    }

    #[test]
    fn what_is_no_file_is_refused_and_not_opened() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        nix::unistd::mkfifo(&at("pipe"), nix::sys::stat::Mode::S_IRWXU).expect("a pipe");
        std::os::unix::net::UnixListener::bind(at("socket")).expect("a socket");
        std::os::unix::fs::symlink("/dev/null", at("null")).expect("a link");
        std::fs::create_dir(at("folder")).expect("made");
        // Nobody reads the pipe: whoever opened it to write would wait for ever.
        for name in ["pipe", "socket", "null", "folder"] {
            assert!(check_writable(&at(name), Kind::Own).is_err(), "{name}");
            let written = write_whole(&at(name), Kind::Own, |file| file.write_all(b"gone"));
            let kind = match name {
                "folder" => ErrorKind::IsADirectory,
                _ => ErrorKind::InvalidInput,
            };
            assert_eq!(written.expect_err(name).kind(), kind, "{name}");
        }
        assert_eq!(
            std::fs::read_dir(folder.path()).expect("a folder").count(),
            4
        );
    }

    #[test]
    fn a_link_to_the_journal_of_a_painting_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let [journal, link] = ["a.maul-wal", "a.png"].map(|name| folder.path().join(name));
        std::fs::write(&journal, "frames").expect("written");
        std::os::unix::fs::symlink(&journal, &link).expect("a link");
        for path in [&journal, &link] {
            assert!(check_writable(path, Kind::Own).is_err());
            assert!(write_whole(path, Kind::Own, |file| file.write_all(b"gone")).is_err());
        }
        assert_eq!(std::fs::read(&journal).expect("there"), b"frames");
    }

    #[test]
    fn nothing_is_written_over_a_painting() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        std::fs::write(&path, b"SQLite format 3\0and a painting").expect("written");
        assert!(check_writable(&path, Kind::Own).is_err());
        let written = write_whole(&path, Kind::Own, |file| file.write_all(b"a picture"));
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
        assert!(check_writable(&folder.path().join("a.txt"), Kind::Own).is_ok());
        assert!(check_writable(&folder.path().join("none/a.txt"), Kind::Own).is_err());
        assert!(check_writable(folder.path(), Kind::Own).is_err());
        assert_eq!(
            std::fs::read_dir(folder.path()).expect("a folder").count(),
            0
        );
    }
}
