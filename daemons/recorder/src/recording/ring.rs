//! The files of a recording that is divided: their names, and those that go for newer ones.

use std::collections::VecDeque;
use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;
use maulstick_rig::files::{create_private, first_free, open_private};

use super::settings::{Division, FILES};
use crate::error::RecorderError;

/// Form of the name of a recording that the rig keeps, behind the name of the rig.
const DATED: &str = "%Y-%m-%d %H.%M.%S";
/// File ending of a recording.
pub(super) const ENDING: &str = "mcap";

/// The files of a recording, the oldest first.
#[derive(Debug)]
pub struct Ring {
    first: PathBuf,
    /// Creates the first file.
    pub(super) create: fn(&Path) -> std::io::Result<File>,
    number: u32,
    /// Files of earlier runs, which go before those of this one.
    earlier: VecDeque<PathBuf>,
    kept: VecDeque<PathBuf>,
    /// Most files beside the one that is written.
    most_files: Option<usize>,
    /// Most bytes of all of them.
    most_bytes: Option<u64>,
}

impl Ring {
    /// A recording of which everything is kept, or five files and the newest, and so many bytes at most. Where the first
    /// file is there already, it is written anew.
    #[must_use]
    pub fn new(first: &Path, division: Division) -> Self {
        Self {
            first: first.to_owned(),
            create: begin_anew,
            number: 1,
            earlier: VecDeque::new(),
            kept: VecDeque::from([first.to_owned()]),
            most_files: division.last.map(|_| FILES as usize),
            most_bytes: division.quota_bytes,
        }
    }

    /// A recording of `rig` in a folder, named by the time, whose quota is that of all such recordings there.
    ///
    /// # Errors
    /// A [`RecorderError`] where the folder cannot be read.
    pub fn dated(
        folder: &Path,
        rig: &str,
        now: &jiff::Zoned,
        division: Division,
    ) -> Result<Self, RecorderError> {
        let reading = |error: std::io::Error| UserError::reading(folder, &error);
        let mut earlier: Vec<(String, PathBuf)> = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(reading)? {
            let path = entry.map_err(reading)?.path();
            earlier.extend(order(&path, rig).map(|order| (order, path)));
        }
        earlier.sort();
        let stem = format!("{rig} {}", now.strftime(DATED));
        let first = folder.join(format!("{stem}.{ENDING}"));
        let named = |number: u32| match number {
            1 => first.clone(),
            number => numbered(&first, number),
        };
        let (number, newest) = first_free(1, named);
        Ok(Self {
            number,
            create: create_private,
            kept: VecDeque::from([newest]),
            earlier: earlier.into_iter().map(|(_, path)| path).collect(),
            ..Self::new(&first, division)
        })
    }

    /// The file that is written.
    pub(super) fn newest(&self) -> &Path {
        self.kept.back().unwrap_or(&self.first)
    }

    /// The next file that is not there yet.
    pub(super) fn next(&mut self) -> &Path {
        let (number, path) = first_free(self.number + 1, |number| numbered(&self.first, number));
        self.number = number;
        self.kept.push_back(path);
        self.newest()
    }

    /// Removes the oldest files that are too many, but neither the one that is written nor the newest whole one.
    ///
    /// # Errors
    /// A [`RecorderError`] where one cannot be removed.
    pub(super) fn trim(&mut self) -> Result<(), RecorderError> {
        while !self.earlier.is_empty()
            && self.earlier.len() + self.kept.len() > 2
            && self.are_large()
        {
            self.earlier.pop_front().as_deref().map_or(Ok(()), remove)?;
        }
        while self.kept.len() > 2 && (self.are_many() || self.are_large()) {
            self.kept.pop_front().as_deref().map_or(Ok(()), remove)?;
        }
        Ok(())
    }

    fn are_many(&self) -> bool {
        self.most_files
            .is_some_and(|most| self.kept.len() > most + 1)
    }

    fn are_large(&self) -> bool {
        let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |data| data.len());
        let all = || self.earlier.iter().chain(&self.kept).map(size).sum::<u64>();
        self.most_bytes.is_some_and(|most| all() > most)
    }
}

/// Opens a file to be written anew, once no other program records into it.
fn begin_anew(path: &Path) -> std::io::Result<File> {
    let file = open_private(path)?;
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => {
            Error::new(ErrorKind::ResourceBusy, "another program records into it")
        }
        TryLockError::Error(error) => error,
    })?;
    file.set_len(0)?;
    Ok(file)
}

/// Removes a file; one that is gone already is no fault.
fn remove(path: &Path) -> Result<(), RecorderError> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(UserError::writing(path, &error).into())
        }
        _ => Ok(()),
    }
}

/// Where a file stands among the recordings of a rig; `None` of a file that has another name.
fn order(path: &Path, rig: &str) -> Option<String> {
    let stem = path.file_name()?.to_str()?.strip_suffix(".mcap")?;
    let dated = stem.strip_prefix(rig)?.strip_prefix(' ')?;
    let time = dated.get(..19)?;
    jiff::civil::DateTime::strptime(DATED, time).ok()?;
    let number = match &dated[19..] {
        "" => 1,
        rest => rest.strip_prefix('-')?.parse::<u32>().ok()?,
    };
    Some(format!("{time}-{number:010}"))
}

/// The name of a further file.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = match path.extension() {
        Some(ending) => format!("{stem}-{number}.{}", ending.to_string_lossy()),
        None => format!("{stem}-{number}"),
    };
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn quota(bytes: u64) -> Division {
        Division {
            quota_bytes: Some(bytes),
            ..Division::default()
        }
    }

    #[test]
    fn further_files_are_numbered_before_their_ending() {
        let named = |path: &str| numbered(Path::new(path), 2);
        assert_eq!(
            named("/a/b.c/session.mcap"),
            Path::new("/a/b.c/session-2.mcap")
        );
        assert_eq!(named("session"), Path::new("session-2"));
    }

    #[test]
    fn the_oldest_files_go_and_no_name_comes_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = folder.path().join("s.mcap");
        let write =
            |path: &Path, bytes: usize| std::fs::write(path, vec![0; bytes]).expect("written");
        let count = || std::fs::read_dir(folder.path()).expect("a folder").count();
        write(&first, 10);
        let last = Division {
            last: Some(Duration::from_secs(50)),
            ..Division::default()
        };
        let mut ring = Ring::new(&first, last);
        for number in 2..12 {
            let path = ring.next();
            assert!(
                path.ends_with(format!("s-{number}.mcap")),
                "{}",
                path.display()
            );
            write(path, 10);
            ring.trim().expect("removed");
            assert_eq!(count(), number.min(6));
        }
        let mut ring = Ring::new(&folder.path().join("s-11.mcap"), quota(25));
        for _ in 0..4 {
            write(ring.next(), 10);
            ring.trim().expect("removed");
        }
        assert!(!folder.path().join("s-11.mcap").exists());
        assert_eq!(ring.kept.len(), 2);
        write(ring.next(), 100);
        ring.trim().expect("removed");
        assert_eq!(
            ring.kept.len(),
            2,
            "the newest whole one stays, however large"
        );
    }
    #[test]
    fn the_quota_of_a_folder_is_that_of_all_recordings_of_the_rig_and_other_files_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let write =
            |name: &str| std::fs::write(folder.path().join(name), [0; 10]).expect("written");
        let others = [
            "studio 2026-01-01 10.00.00.txt",
            "studio my best 19 letter.mcap",
            "other 2020-01-01 10.00.00.mcap",
            "studio 2026-13-01 10.00.00.mcap",
        ];
        let earlier = [
            "studio 2026-01-01 10.00.00.mcap",
            "studio 2026-01-01 10.00.00-2.mcap",
            "studio 2026-01-01 10.00.00-10.mcap",
            "studio 2026-01-02 09.00.00.mcap",
        ];
        others.iter().chain(&earlier).copied().for_each(write);
        let now = "2026-01-02T09:00:00[UTC]".parse().expect("a time");
        let mut ring = Ring::dated(folder.path(), "studio", &now, quota(30)).expect("read");
        let newest = ring.newest().to_owned();
        assert_eq!(
            newest,
            folder.path().join("studio 2026-01-02 09.00.00-2.mcap")
        );
        std::fs::write(&newest, [0; 10]).expect("written");
        ring.trim().expect("removed");
        let is_there = |name: &&str| folder.path().join(name).exists();
        assert!(others.iter().all(is_there));
        assert_eq!(
            earlier.map(|name| is_there(&name)),
            [false, false, true, true]
        );
        write("studio 2026-01-02 09.00.00-3.mcap");
        let next = folder.path().join("studio 2026-01-02 09.00.00-4.mcap");
        assert_eq!(ring.next(), next);
    }
}
