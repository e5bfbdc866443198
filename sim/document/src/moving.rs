//! A painting's file under another name: a copy of it, or itself.

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::mpsc;

use crate::database::{Access, Database, beside, folded, is_new, resolved};
use crate::error::DocumentError;
use maulstick_files::FileId;

/// Fate of the file that a painting leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// It stays as it is at that moment.
    Stays,
    /// It is the one that gets the other name.
    Goes,
}

/// Move of a painting to another file.
#[derive(Clone, Debug)]
pub(crate) struct Move {
    pub(crate) to: PathBuf,
    pub(crate) left: Left,
    /// True if an existing painting may be replaced.
    pub(crate) replace: bool,
    pub(crate) answer: mpsc::Sender<Result<(), DocumentError>>,
}

/// A move of a painting to another file in progress.
#[derive(Debug)]
pub struct Moving {
    pub(crate) to: PathBuf,
    pub(crate) outcome: mpsc::Receiver<Result<(), DocumentError>>,
}

/// Sees that a painting can be put there. One that is there already, and may go, is made whole first:
/// nothing of it is left beside the file that takes its place.
///
/// # Errors
/// [`DocumentError::Taken`] where one is there and has to stay, and any other of what cannot be opened:
/// what is no painting, is open or damaged is never written over, nor is one for whose journal the disk
/// has no room.
pub fn make_room(path: &Path, replace: bool) -> Result<(), DocumentError> {
    if is_new(path)? {
        return folded(path).map_err(|_| {
            DocumentError::Other("the journal of another painting lies beside that name".to_owned())
        });
    }
    if !replace {
        return Err(DocumentError::Taken);
    }
    let (database, _) = Database::open(path, Access::Paint, None)?;
    database.close()?;
    folded(path)
}

/// The name that a painting has until it is whole, beside the file that a link leads to.
#[must_use]
pub fn unfinished(path: &Path) -> PathBuf {
    beside(&resolved(path), &format!(".{}.tmp", std::process::id()))
}

/// Gives a closed painting another name, whole or not at all.
///
/// # Errors
/// As [`make_room`], [`DocumentError::Unfolded`] where a part of it is in its journal still, and what the
/// file system says; then both are as they were.
pub(crate) fn put(from: &Path, order: &Move) -> Result<(), DocumentError> {
    folded(from)?;
    // Under another of its names it would take its own place.
    if FileId::of(&order.to).is_ok_and(|there| FileId::of(from).is_ok_and(|own| own == there)) {
        return Err(DocumentError::OpenHere);
    }
    make_room(&order.to, order.replace)?;
    let to = &resolved(&order.to);
    // An existing file may be replaced, but not one that appears meanwhile.
    let replace = to.symlink_metadata().is_ok();
    let part = unfinished(to);
    let copied = || {
        std::fs::copy(from, &part)
            .and_then(|_| File::open(&part)?.sync_all())
            .and_then(|()| name(&part, to, replace))
            .inspect_err(|_| {
                std::fs::remove_file(&part).ok();
            })
    };
    match order.left {
        Left::Stays => copied()?,
        Left::Goes => match name(from, to, replace) {
            Err(error) if error.kind() == ErrorKind::CrossesDevices => {
                copied()?;
                std::fs::remove_file(from).ok();
            }
            named => named?,
        },
    }
    sync_folder(to)
}

/// Writes a painting whose own file is gone to a new one, whole or not at all.
///
/// # Errors
/// As [`make_room`], and what SQLite or the file system says.
pub(crate) fn rescue(database: &Database, to: &Path, replace: bool) -> Result<(), DocumentError> {
    make_room(to, replace)?;
    let to = &resolved(to);
    let replace = to.symlink_metadata().is_ok();
    let part = unfinished(to);
    // One of a rescue that was cut short.
    std::fs::remove_file(&part).ok();
    let copied = database.copy_to(&part).and_then(|()| {
        File::open(&part)?.sync_all()?;
        Ok(name(&part, to, replace)?)
    });
    copied.inspect_err(|_| {
        std::fs::remove_file(&part).ok();
    })?;
    sync_folder(to)
}

/// A free name beside a painting: `sea.maul` goes on in `sea-kept.maul`, or `sea-kept-2.maul`.
pub(crate) fn name_beside(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let named = |number: u32| {
        let number = match number {
            1 => String::new(),
            number => format!("-{number}"),
        };
        path.with_file_name(format!("{stem}-kept{number}.{ending}"))
    };
    let is_free = |path: &PathBuf| {
        let names = ["", "-wal", "-journal"].map(|suffix| beside(path, suffix));
        names.iter().all(|name| name.symlink_metadata().is_err())
    };
    (1..u32::MAX)
        .map(named)
        .find(is_free)
        .unwrap_or_else(|| named(1))
}

/// Takes back what [`put`] did to the file that a painting left.
pub(crate) fn take_back(from: &Path, order: &Move) {
    if order.left == Left::Goes {
        let to = resolved(&order.to);
        std::fs::rename(&to, from)
            .or_else(|_| std::fs::copy(&to, from).map(drop))
            .ok();
    }
}

/// Gives a file another name, which belongs to no other file where that may not be replaced.
fn name(part: &Path, to: &Path, replace: bool) -> std::io::Result<()> {
    if replace {
        return std::fs::rename(part, to);
    }
    match std::fs::hard_link(part, to) {
        Ok(()) => {
            std::fs::remove_file(part).ok();
            Ok(())
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
        // Some file systems have no links.
        Err(_) => std::fs::rename(part, to),
    }
}

/// A name is there after a power cut once its folder is written.
fn sync_folder(path: &Path) -> Result<(), DocumentError> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => Ok(File::open(folder)?.sync_all()?),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_came_meanwhile_is_not_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let [part, to] = ["part", "to"].map(|name| folder.path().join(name));
        std::fs::write(&part, "new").expect("written");
        std::fs::write(&to, "another's").expect("written");
        let taken = name(&part, &to, false).map_err(DocumentError::from);
        assert!(matches!(taken, Err(DocumentError::Taken)), "{taken:?}");
        assert_eq!(std::fs::read(&to).expect("there"), b"another's");
        name(&part, &to, true).expect("it may go");
        assert_eq!(std::fs::read(&to).expect("there"), b"new");
        assert!(!part.exists());
        let other = folder.path().join("other");
        name(&to, &other, false).expect("nothing is there");
        assert!(!to.exists() && other.exists());
    }
}
