//! Files that are whole under their name, or not there at all.

use std::fs::File;
use std::io::{BufWriter, Error, Write as _};
use std::path::{Path, PathBuf};

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
    let beside = beside(path);
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
