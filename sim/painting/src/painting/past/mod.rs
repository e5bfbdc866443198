//! The past of a painting: its steps, its versions, and where its record begins.

pub(crate) mod record;
pub(crate) mod versions;

use record::RecordState;
use versions::Versions;

use super::surfaces::Surfaces;
use crate::history::History;

/// What is kept of a painting's past.
#[derive(Default)]
pub(crate) struct Past {
    pub(crate) history: History,
    pub(crate) versions: Versions,
    pub(crate) record: RecordState,
}

impl Past {
    /// Merges the oldest steps until the history keeps to its quota, or only the newest are apart.
    pub(crate) fn keep_to_quota(&mut self, surfaces: &Surfaces) {
        let (versions, record) = (&self.versions, &self.record);
        let besides = || surfaces.held_bytes(versions.tiles().chain(record.tiles()));
        self.history.keep_to_quota(&surfaces.pager, besides);
    }

    /// Makes the next checkpoint hold the whole history and all versions.
    pub(crate) fn touch_all(&mut self) {
        self.history.touch_all();
        self.versions.touch_all();
        self.record.is_broken = true;
    }
}
