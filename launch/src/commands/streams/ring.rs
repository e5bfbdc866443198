//! The files of a recording that is divided: their names, and those that go for newer ones.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;

/// Files into which the time that is kept is divided.
pub(super) const FILES: u32 = 5;

/// The files of a recording, the oldest first.
#[derive(Debug)]
pub(super) struct Ring {
    first: PathBuf,
    number: u32,
    kept: VecDeque<PathBuf>,
    /// Most files beside the one that is written.
    most_files: Option<usize>,
    /// Most bytes of all of them.
    most_bytes: Option<u64>,
}

impl Ring {
    /// A recording of which everything is kept, or [`FILES`] files, and so many bytes at most.
    pub(super) fn new(first: &Path, divides: bool, most_bytes: Option<u64>) -> Self {
        Self {
            first: first.to_owned(),
            number: 1,
            kept: VecDeque::from([first.to_owned()]),
            most_files: divides.then_some(FILES as usize),
            most_bytes,
        }
    }

    /// The next file that is not there yet.
    pub(super) fn next(&mut self) -> PathBuf {
        loop {
            self.number += 1;
            let path = numbered(&self.first, self.number);
            if !path.exists() {
                self.kept.push_back(path.clone());
                return path;
            }
        }
    }

    /// Removes the oldest files that are too many, but neither the one that is written nor the newest whole one.
    ///
    /// # Errors
    /// A [`UserError`] where one cannot be removed.
    pub(super) fn trim(&mut self) -> Result<(), UserError> {
        while self.kept.len() > 2 && (self.are_many() || self.are_large()) {
            let Some(oldest) = self.kept.pop_front() else {
                break;
            };
            match std::fs::remove_file(&oldest) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(UserError::writing(&oldest, &error));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn are_many(&self) -> bool {
        self.most_files
            .is_some_and(|most| self.kept.len() > most + 1)
    }

    fn are_large(&self) -> bool {
        let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |data| data.len());
        let all = || self.kept.iter().map(size).sum::<u64>();
        self.most_bytes.is_some_and(|most| all() > most)
    }
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
    use super::*;

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
        let mut ring = Ring::new(&first, true, None);
        for number in 2..12 {
            let path = ring.next();
            assert!(
                path.ends_with(format!("s-{number}.mcap")),
                "{}",
                path.display()
            );
            write(&path, 10);
            ring.trim().expect("removed");
            assert_eq!(count(), number.min(6));
        }
        let mut ring = Ring::new(&folder.path().join("s-11.mcap"), false, Some(25));
        for _ in 0..4 {
            write(&ring.next(), 10);
            ring.trim().expect("removed");
        }
        assert!(!folder.path().join("s-11.mcap").exists());
        assert_eq!(ring.kept.len(), 2);
        write(&ring.next(), 100);
        ring.trim().expect("removed");
        assert_eq!(
            ring.kept.len(),
            2,
            "the newest whole one stays, however large"
        );
    }
}
