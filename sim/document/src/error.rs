//! Errors of a document, each with advice.

use std::path::PathBuf;

use maulstick_types::command::advice::Advice;
use rusqlite::ffi;

/// Errors of opening, reading and writing a document.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// The file is not a painting.
    #[error("this is not a Maulstick painting")]
    NoPainting,
    /// No file at the path.
    #[error("there is no such file")]
    Missing,
    /// A painting of a format that is no longer read.
    #[error("this painting has the format {0}, which this program does not read any more")]
    Older(i32),
    /// A painting of a newer program.
    #[error("this painting has the format {found}, but this program knows formats up to {known}")]
    Newer {
        /// Schema of the file.
        found: i32,
        /// Newest known schema.
        known: i32,
    },
    /// Another program has the file open.
    #[error("the painting is open in another program{}", holder.map_or(String::new(), |pid| format!(" (process {pid})")))]
    InUse {
        /// Its process, if the system reports it.
        holder: Option<i32>,
    },
    /// This program itself has it open, perhaps by another name.
    #[error("this painting is open here already")]
    OpenHere,
    /// A name that SQLite uses for the journal of another painting.
    #[error("a file with this extension may belong to another painting")]
    Companion,
    /// The file or its folder cannot be written to.
    #[error("the painting cannot be written to: {0}")]
    ReadOnly(String),
    /// The disk is full.
    #[error("the disk is full")]
    Full,
    /// The disk cannot be read or written.
    #[error("the disk fails: {0}")]
    Disk(String),
    /// The disk has no room for merging the journal of a painting that is to be closed.
    #[error("the disk has no room to close the painting {}", .0.display())]
    Unmerged(PathBuf),
    /// Tables changed by another program, or not a painting's.
    #[error("another program changed the painting's tables: {0}")]
    Altered(String),
    /// Rows or bytes that are not intact.
    #[error("the painting is damaged: {0}")]
    Damaged(String),
    /// Fewer rows than were written, or more.
    #[error("the painting is damaged: {found} of its {written} {rows} are there")]
    Rows {
        /// Their kind.
        rows: RowKind,
        /// Those that are there.
        found: u64,
        /// Those that were written.
        written: u64,
    },
    /// The latest strokes could not be written.
    #[error("the latest strokes are not in the file: {0}")]
    Unwritten(String),
    /// A file that lost a part of the painting, or replaces one that did, before that part was written again.
    #[error("{} lacks a part of the painting", .0.display())]
    Incomplete(PathBuf),
    /// The file of an open painting is gone, and no other could be created.
    #[error("{0}")]
    Vanished(String),
    /// A file exists at the path of a new one.
    #[error("a file of this name exists already")]
    Taken,
    /// Any other error of SQLite or the system.
    #[error("{0}")]
    Other(String),
}

/// Kind of counted rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// Tiles.
    Tiles,
    /// Steps of the history.
    Steps,
    /// Named versions.
    Versions,
}

impl std::fmt::Display for RowKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Tiles => "tiles",
            Self::Steps => "steps of its history",
            Self::Versions => "versions",
        })
    }
}

impl DocumentError {
    /// Remedy, for a person.
    #[must_use]
    pub fn advice(&self) -> Advice {
        let words = match self {
            Self::NoPainting => return Advice::NamePainting,
            Self::Missing => return Advice::BeginPainting,
            Self::Damaged(_) | Self::Rows { .. } | Self::Altered(_) => return Advice::Recover,
            Self::Older(_) => "open it with the Maulstick that made it; nothing was changed",
            Self::Newer { .. } => "open it with that newer Maulstick; nothing was changed",
            Self::InUse { .. } => {
                "close it there; if that program hangs, end it: what it had written is safe"
            }
            Self::ReadOnly(_) => "check the permissions of the file and its folder, or copy it",
            Self::Full | Self::Unmerged(_) => "free some space: nothing that was written is lost",
            Self::Disk(_) => {
                "nothing that was written before is lost: see what is wrong with it, or save the painting on another"
            }
            Self::Unwritten(_) => "nothing that was written before is lost",
            Self::Incomplete(_) => {
                "while it is open, ask again in a second; once it is closed, recover from the file before it what is whole"
            }
            Self::OpenHere | Self::Companion => "give another name",
            Self::Taken => "give another name: an existing file is never replaced",
            Self::Vanished(_) => "save it under another name now: until then it is in memory alone",
            Self::Other(_) => "check the path and the disk",
        };
        Advice::say(words)
    }

    /// True if it does not concern the bytes of the file: they may be intact, and readable later.
    pub(crate) fn may_pass(&self) -> bool {
        !matches!(
            self,
            Self::Damaged(_) | Self::Rows { .. } | Self::Altered(_) | Self::NoPainting
        )
    }
}

impl From<rusqlite::Error> for DocumentError {
    fn from(error: rusqlite::Error) -> Self {
        let rusqlite::Error::SqliteFailure(code, _) = &error else {
            return match error {
                rusqlite::Error::QueryReturnedNoRows => {
                    Self::Damaged("a row is missing".to_owned())
                }
                rusqlite::Error::FromSqlConversionFailure(..)
                | rusqlite::Error::InvalidColumnType(..)
                | rusqlite::Error::IntegralValueOutOfRange(..) => Self::Damaged(error.to_string()),
                other => Self::Other(other.to_string()),
            };
        };
        match code.extended_code & 0xff {
            ffi::SQLITE_BUSY | ffi::SQLITE_LOCKED => Self::InUse { holder: None },
            ffi::SQLITE_READONLY | ffi::SQLITE_CANTOPEN | ffi::SQLITE_PERM => {
                Self::ReadOnly(error.to_string())
            }
            ffi::SQLITE_FULL => Self::Full,
            ffi::SQLITE_IOERR => Self::Disk(error.to_string()),
            ffi::SQLITE_NOTADB => Self::NoPainting,
            ffi::SQLITE_CORRUPT => Self::Damaged(error.to_string()),
            _ => Self::Other(error.to_string()),
        }
    }
}

impl From<std::io::Error> for DocumentError {
    fn from(error: std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::StorageFull => Self::Full,
            std::io::ErrorKind::NotFound => Self::Missing,
            std::io::ErrorKind::AlreadyExists => Self::Taken,
            std::io::ErrorKind::ResourceBusy => Self::OpenHere,
            std::io::ErrorKind::PermissionDenied | std::io::ErrorKind::ReadOnlyFilesystem => {
                Self::ReadOnly(error.to_string())
            }
            _ => Self::Other(error.to_string()),
        }
    }
}

impl From<serde_json::Error> for DocumentError {
    fn from(error: serde_json::Error) -> Self {
        Self::Damaged(error.to_string())
    }
}
