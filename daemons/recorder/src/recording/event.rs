//! Events of a recording.

use std::path::PathBuf;

use crate::error::RecorderError;

/// Event of a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum RecorderEvent {
    /// The recording begins.
    Begun {
        /// The first file.
        file: PathBuf,
    },
    /// It goes on in another file.
    Continued {
        /// The file.
        file: PathBuf,
        /// The reason for another one.
        cause: Continuation,
    },
    /// The painting as it was at a file's beginning is in that file.
    PaintingAttached {
        /// The file.
        file: PathBuf,
    },
    /// The painting cannot be copied at present; once a recording.
    PaintingUnavailable(CopyTrouble),
    /// A file has ended.
    FileEnded(FileSummary),
}

/// Reason why a recording goes on in another file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuation {
    /// The file has its size, or its length.
    Full,
    /// The journal of the painting broke off: the paint node began anew, or messages were lost.
    JournalBroke,
}

/// Reason why the painting is not in a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum CopyTrouble {
    /// It is in memory only.
    InMemory,
    /// The paint node refused the copy, or it could not be written.
    Failed(RecorderError),
}

/// Contents of a file that has ended.
#[derive(Clone, Debug, PartialEq)]
pub struct FileSummary {
    /// The file.
    pub file: PathBuf,
    /// Number of its messages.
    pub messages: u64,
    /// Its length, s.
    pub seconds: f64,
    /// Its size, bytes.
    pub bytes: u64,
    /// Messages that were lost on the way.
    pub lost: u64,
    /// Messages that the recorder was too slow for.
    pub dropped: u64,
    /// True if it has the journal of a painting, but not the painting.
    pub lacks_painting: bool,
}
