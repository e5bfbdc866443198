//! Relocation of a painting: its file is copied or renamed, and painting continues at the new path.

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::mpsc;

use maulstick_files::{FileId, companion, first_free};

use crate::error::DocumentError;
use crate::file::database::{Access, Database, is_new, merged};
use crate::file::path::resolved;
use crate::opening;

/// Way to relocate a painting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relocate {
    /// The old file stays unchanged; painting continues in the copy.
    Copy,
    /// The file gets the new name.
    Rename,
    /// A copy is written; painting continues in the old file.
    Leave,
}

/// Request to relocate a painting.
#[derive(Clone, Debug)]
pub(crate) struct RelocateRequest {
    pub(crate) to: PathBuf,
    pub(crate) how: Relocate,
    /// True if an existing painting may be replaced.
    pub(crate) replace: bool,
    pub(crate) answer: mpsc::Sender<Result<(), DocumentError>>,
}

/// Relocation of a painting that is in progress.
#[derive(Debug)]
pub struct Relocation {
    pub(crate) to: PathBuf,
    pub(crate) how: Relocate,
    pub(crate) outcome: mpsc::Receiver<Result<(), DocumentError>>,
}

/// Checks that a painting can be written at `path`. The journal of a painting that is to be replaced is merged into its
/// file first, so that none of it remains beside the new one.
///
/// # Errors
/// [`DocumentError::Taken`] if the file exists and `replace` is false. Any other error of a file that cannot be opened:
/// a file that is not a painting, is open or damaged, or whose journal does not fit on the disk is never replaced.
pub fn make_room(path: &Path, replace: bool) -> Result<(), DocumentError> {
    if is_new(path)? {
        return merged(path).map_err(|_| {
            DocumentError::Other("the journal of another painting lies beside that name".to_owned())
        });
    }
    if !replace {
        return Err(DocumentError::Taken);
    }
    let (database, _) = Database::open(path, Access::Paint, None)?;
    database.close()?;
    merged(path)
}

/// Temporary name of a painting until it is complete, beside the file that a link leads to.
#[must_use]
pub fn unfinished(path: &Path) -> PathBuf {
    companion(&resolved(path), &format!(".{}.tmp", std::process::id()))
}

/// Copies or renames a closed painting, completely or not at all.
///
/// # Errors
/// As [`make_room`]; [`DocumentError::Unmerged`] if a part of it is still in its journal; errors of the file system. On
/// an error both files are unchanged.
pub(crate) fn relocate(from: &Path, request: &RelocateRequest) -> Result<(), DocumentError> {
    merged(from)?;
    // By another of its names it would replace itself.
    if FileId::of(&request.to).is_ok_and(|there| FileId::of(from).is_ok_and(|own| own == there)) {
        return Err(DocumentError::OpenHere);
    }
    make_room(&request.to, request.replace)?;
    let to = &resolved(&request.to);
    // An existing file may be replaced, but not one that appears meanwhile.
    let replace = to.symlink_metadata().is_ok();
    let part = unfinished(to);
    let copied = || {
        std::fs::copy(from, &part)
            .and_then(|_| File::open(&part)?.sync_all())
            .and_then(|()| rename(&part, to, replace))
            .inspect_err(|_| {
                std::fs::remove_file(&part).ok();
            })
    };
    match request.how {
        Relocate::Copy | Relocate::Leave => copied()?,
        Relocate::Rename => match rename(from, to, replace) {
            Err(error) if error.kind() == ErrorKind::CrossesDevices => {
                copied()?;
                std::fs::remove_file(from).ok();
            }
            renamed => renamed?,
        },
    }
    sync_folder(to)
}

/// Writes a painting whose file was removed to a new file, completely or not at all.
///
/// # Errors
/// As [`make_room`], or the error of SQLite or the file system.
pub(crate) fn rescue(database: &Database, to: &Path, replace: bool) -> Result<(), DocumentError> {
    make_room(to, replace)?;
    let to = &resolved(to);
    let replace = to.symlink_metadata().is_ok();
    let part = unfinished(to);
    // Left by a rescue that was interrupted.
    std::fs::remove_file(&part).ok();
    let copied = database.copy_to(&part).and_then(|()| {
        File::open(&part)?.sync_all()?;
        Ok(rename(&part, to, replace)?)
    });
    copied.inspect_err(|_| {
        std::fs::remove_file(&part).ok();
    })?;
    sync_folder(to)
}

/// Copies the file of a painting whose journal is unreadable, in the state of the last merge; false, without a file at
/// `to`, if that is not a whole painting.
///
/// # Errors
/// As [`make_room`], or the error of the file system.
pub(crate) fn copied_without_journal(
    from: &Path,
    to: &Path,
    replace: bool,
) -> Result<bool, DocumentError> {
    make_room(to, replace)?;
    let part = unfinished(to);
    // Left by a rescue that was interrupted.
    std::fs::remove_file(&part).ok();
    std::fs::copy(from, &part)?;
    File::open(&part)?.sync_all()?;
    let checked = Database::open(&part, Access::Read, None).and_then(|(database, _)| {
        let is_whole = opening::next_page(&database).is_ok();
        database.close()?;
        Ok(is_whole)
    });
    let is_whole = checked.unwrap_or(false);
    if is_whole {
        rename(&part, to, replace)?
    } else {
        std::fs::remove_file(&part)?;
        // A new journal there must not be mixed with the file that it replaces.
        if replace && to.exists() {
            std::fs::remove_file(to)?;
        }
    }
    sync_folder(to)?;
    Ok(is_whole)
}

/// Free name beside a painting: `sea-kept.maul` for `sea.maul`, or `sea-kept-2.maul`.
pub(crate) fn free_name_beside(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let named = |number: u32| {
        let number = match number {
            1 => String::new(),
            number => format!("-{number}"),
        };
        path.with_file_name(format!("{stem}-kept{number}.{ending}"))
    };
    first_free(1, named).1
}

/// Reverts [`relocate`] at the old path.
pub(crate) fn revert(from: &Path, request: &RelocateRequest) {
    if request.how == Relocate::Rename {
        let to = resolved(&request.to);
        std::fs::rename(&to, from)
            .or_else(|_| std::fs::copy(&to, from).map(drop))
            .ok();
    }
}

/// Renames a file; without `replace`, only to an unused name.
fn rename(part: &Path, to: &Path, replace: bool) -> std::io::Result<()> {
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

/// Syncs the folder of a file, so that its name outlives a power cut.
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
    fn a_file_that_appeared_meanwhile_is_not_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let [part, to] = ["part", "to"].map(|name| folder.path().join(name));
        std::fs::write(&part, "new").expect("written");
        std::fs::write(&to, "another's").expect("written");
        let taken = rename(&part, &to, false).map_err(DocumentError::from);
        assert!(matches!(taken, Err(DocumentError::Taken)), "{taken:?}");
        assert_eq!(std::fs::read(&to).expect("there"), b"another's");
        rename(&part, &to, true).expect("it may go");
        assert_eq!(std::fs::read(&to).expect("there"), b"new");
        assert!(!part.exists());
        let other = folder.path().join("other");
        rename(&to, &other, false).expect("nothing is there");
        assert!(!to.exists() && other.exists());
    }
}
