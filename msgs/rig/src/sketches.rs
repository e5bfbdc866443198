//! Sketches: paintings that have no name yet. Each has a file of its own in the user's state folder until the painter
//! gives it one elsewhere.
//!
//! The newest [`MOST_SKETCHES`] stay, and of these as many as take [`MOST_BYTES`] together; the newest stays in any case. Those
//! beyond *leave*: they are removed when a rig starts, but only once the painter has been [notified](Sketches::notify). One
//! that is opened and painted on is the newest again, and one that is saved under a name is no sketch any more.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use maulstick_files::{COMPANIONS, Kind, companion, first_free, write_whole};

use crate::user_error::UserError;

/// Sketches that stay.
pub const MOST_SKETCHES: usize = 32;
/// Most bytes of all sketches together.
pub const MOST_BYTES: u64 = 4 << 30;

/// File ending of a painting.
const PAINTING: &str = "maul";
/// Names of the sketches of whose removal the painter was notified, a line each.
const TOLD: &str = "leaving.txt";

/// A sketch that is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sketch {
    /// Its file.
    pub path: PathBuf,
    /// When it was last changed.
    pub changed: SystemTime,
    /// Bytes of the file and its journal.
    pub bytes: u64,
}

/// The sketches of a user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sketches {
    folder: PathBuf,
}

impl Sketches {
    /// Those of this user: `sketches` in the state folder (`$XDG_STATE_HOME/maulstick`), or in the folder of data where
    /// the system has no such thing.
    ///
    /// # Errors
    /// A [`UserError`] where the system has no folder for it.
    pub fn of_user() -> Result<Self, UserError> {
        let folders = directories::ProjectDirs::from("", "", "maulstick").ok_or_else(|| {
            UserError::failure("there is no folder for the sketches of this user")
                .help("set HOME to a folder of your own")
        })?;
        let state = folders.state_dir().unwrap_or(folders.data_local_dir());
        Ok(Self::in_folder(&state.join("sketches")))
    }

    /// Those in a folder.
    #[must_use]
    pub fn in_folder(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// True if this is the file of a sketch.
    #[must_use]
    pub fn has(&self, path: &Path) -> bool {
        path.parent() == Some(&self.folder) && path.extension() == Some(OsStr::new(PAINTING))
    }

    /// All that are there, the newest first; none where there is no folder.
    #[must_use]
    pub fn all(&self) -> Vec<Sketch> {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten();
        let paths = entries.flatten().map(|entry| entry.path());
        let mut all: Vec<Sketch> = paths
            .filter(|path| self.has(path))
            .filter_map(|path| {
                let about = std::fs::metadata(&path).ok().filter(|a| a.is_file())?;
                let wal = std::fs::metadata(companion(&path, "-wal")).ok();
                let changed = [Some(&about), wal.as_ref()].into_iter().flatten();
                let changed = changed.filter_map(|about| about.modified().ok()).max()?;
                let bytes = about.len() + wal.map_or(0, |about| about.len());
                Some(Sketch {
                    path,
                    changed,
                    bytes,
                })
            })
            .collect();
        all.sort_by(|one, other| (other.changed, &other.path).cmp(&(one.changed, &one.path)));
        all
    }

    /// The file of a new one that was begun at a time, which is part of its name. The folder is made.
    ///
    /// # Errors
    /// A [`UserError`] where the folder cannot be made or written.
    pub fn fresh(&self, time: &str) -> Result<PathBuf, UserError> {
        use std::os::unix::fs::DirBuilderExt as _;
        let mut builder = std::fs::DirBuilder::new();
        builder
            .recursive(true)
            .mode(0o700)
            .create(&self.folder)
            .map_err(|error| UserError::writing(&self.folder, &error))?;
        let named = |number: u32| match number {
            1 => self.folder.join(format!("{time}.{PAINTING}")),
            number => self.folder.join(format!("{time} {number}.{PAINTING}")),
        };
        let path = first_free(1, named).1;
        maulstick_files::check_writable(&path, Kind::Own)
            .map_err(|error| UserError::writing(&path, &error))?;
        Ok(path)
    }

    /// Removes a sketch, with its journal.
    ///
    /// # Errors
    /// A [`UserError`] where the system refuses.
    pub fn remove(&self, path: &Path) -> Result<(), UserError> {
        std::fs::remove_file(path).map_err(|error| UserError::writing(path, &error))?;
        for suffix in COMPANIONS {
            std::fs::remove_file(companion(path, suffix)).ok();
        }
        Ok(())
    }

    /// Notes that the painter was notified of these removals: the next start carries out those that are still due. Earlier
    /// notes are discarded.
    ///
    /// # Errors
    /// A [`UserError`] where that cannot be written.
    pub fn notify(&self, leaving: &[Sketch]) -> Result<(), UserError> {
        let path = self.folder.join(TOLD);
        let names = leaving.iter().filter_map(|sketch| name(&sketch.path));
        let text: String = names.flat_map(|name| [name, "\n"]).collect();
        write_whole(&path, Kind::Own, |file| file.write_all(text.as_bytes()))
            .map_err(|error| UserError::writing(&path, &error))
    }

    /// Those that are due for removal, and of which the painter was notified.
    #[must_use]
    pub fn notified(&self) -> Vec<Sketch> {
        let text = std::fs::read_to_string(self.folder.join(TOLD)).unwrap_or_default();
        let told: BTreeSet<&str> = text.lines().collect();
        let all = self.all();
        let leaving = leaving(&all).iter();
        let is_told = |sketch: &&Sketch| name(&sketch.path).is_some_and(|name| told.contains(name));
        leaving.filter(is_told).cloned().collect()
    }
}

fn name(path: &Path) -> Option<&str> {
    path.file_name()?.to_str()
}

/// Those of all sketches, the newest first, that leave.
#[must_use]
pub fn leaving(all: &[Sketch]) -> &[Sketch] {
    let mut bytes = 0;
    let stay = all
        .iter()
        .take(MOST_SKETCHES)
        .enumerate()
        .take_while(|(place, one)| {
            bytes += one.bytes;
            *place == 0 || bytes <= MOST_BYTES
        });
    let stay = stay.count();
    all.get(stay..).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::time::Duration;

    use super::*;

    /// A folder with `count` sketches, a day between them, the oldest first.
    fn folder(count: usize) -> (tempfile::TempDir, Sketches, Vec<PathBuf>) {
        let folder = tempfile::tempdir().expect("a folder");
        let sketches = Sketches::in_folder(&folder.path().join("state/sketches"));
        let paths: Vec<PathBuf> = (0..count).map(|i| begun(&sketches, i)).collect();
        (folder, sketches, paths)
    }

    fn begun(sketches: &Sketches, day: usize) -> PathBuf {
        let path = sketches.fresh(&format!("day {day:03}")).expect("free");
        std::fs::write(&path, "paint").expect("written");
        touch(&path, day);
        path
    }

    fn touch(path: &Path, day: usize) {
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(86_400 * (day as u64 + 1));
        let file = File::options().append(true).open(path).expect("there");
        file.set_modified(time).expect("set");
    }

    #[test]
    fn each_sketch_has_a_file_of_its_own_and_other_files_are_none() {
        let (_folder, sketches, paths) = folder(1);
        let second = sketches.fresh("day 000").expect("another");
        assert_ne!(second, paths[0]);
        assert!(sketches.has(&paths[0]) && sketches.has(&second));
        for other in ["/tmp/day.maul", "day 000.maul-wal", "deep/day.maul"] {
            assert!(!sketches.has(&sketches.folder().join(other)), "{other}");
        }
        std::fs::write(companion(&paths[0], "-wal"), [0; 100]).expect("written");
        let all = sketches.all();
        assert_eq!((all.len(), all[0].bytes), (1, 105));
        sketches.remove(&paths[0]).expect("removed");
        assert_eq!(sketches.all(), []);
        assert!(!companion(&paths[0], "-wal").exists());
    }

    #[test]
    fn the_oldest_beyond_the_bound_leave_once_the_painter_was_told() {
        let (_folder, sketches, paths) = folder(MOST_SKETCHES + 2);
        let all = sketches.all();
        let oldest: Vec<_> = leaving(&all).iter().map(|one| one.path.clone()).collect();
        assert_eq!(oldest, [paths[1].clone(), paths[0].clone()]);
        assert_eq!(sketches.notified(), [], "nobody has seen them");
        sketches.notify(leaving(&all)).expect("told");
        let told: Vec<_> = sketches
            .notified()
            .into_iter()
            .map(|one| one.path)
            .collect();
        assert_eq!(told, oldest);
        // One is painted on, so another is the oldest, of which nobody was notified.
        touch(&paths[0], MOST_SKETCHES + 3);
        let told: Vec<_> = sketches
            .notified()
            .into_iter()
            .map(|one| one.path)
            .collect();
        assert_eq!(told, [paths[1].clone()]);
    }

    #[test]
    fn sketches_that_take_too_much_leave_but_never_the_newest() {
        let sketch = |bytes: u64| Sketch {
            path: PathBuf::new(),
            changed: SystemTime::UNIX_EPOCH,
            bytes,
        };
        let all = |sizes: &[u64]| sizes.iter().map(|bytes| sketch(*bytes)).collect::<Vec<_>>();
        let half = MOST_BYTES / 2;
        assert_eq!(leaving(&all(&[half, half, 1, 1])).len(), 2);
        assert_eq!(leaving(&all(&[MOST_BYTES + 1, 1])).len(), 1);
        assert_eq!(leaving(&[]).len(), 0);
    }
}
