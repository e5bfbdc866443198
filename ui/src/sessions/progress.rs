//! A recording and a replay in progress.

use std::path::{Path, PathBuf};

use maulstick_recorder::{Position, ReplayReport};

/// A recording in progress.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordingProgress {
    pub file: PathBuf,
    /// Its beginning, rig clock, ns.
    pub begun_ns: u64,
}

/// A replay in progress.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ReplayProgress {
    pub recording: PathBuf,
    /// Position of the player; `None` until it has begun.
    pub position: Option<Position>,
    /// The painting in which a session is painted again; `None` if streams alone are sent.
    pub painting: Option<PathBuf>,
    /// True while the rig goes over to that painting: its nodes leave and come back.
    pub opens: bool,
}

impl ReplayProgress {
    /// Of a recording that is about to be played.
    #[must_use]
    pub(crate) fn new(recording: &Path) -> Self {
        Self {
            recording: recording.to_owned(),
            position: None,
            painting: None,
            opens: false,
        }
    }

    /// Takes a report of the player.
    pub(super) fn update(&mut self, report: ReplayReport) {
        match report {
            ReplayReport::Position(position) => self.position = Some(position),
            ReplayReport::Painting { painting } => {
                (self.painting, self.opens) = (Some(painting), false);
            }
            ReplayReport::Opening { painting } => {
                (self.painting, self.opens) = (Some(painting), true);
            }
            // The window guides no hand.
            ReplayReport::Guiding(_) => {}
        }
    }
}
