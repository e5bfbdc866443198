//! The painting's part of its record.

use std::sync::Arc;

use maulstick_canvas::tile::Tile;

use crate::beginning::{Beginning, RecordChange};
use crate::history::Step;
use crate::snapshot::RECORD_QUOTA;

/// Record of a painting: where it begins, and its limit.
#[derive(Clone, Debug)]
pub(crate) struct RecordState {
    /// Most bytes of it; 0 keeps none.
    pub(crate) quota: u64,
    /// Its beginning, if the document has it.
    beginning: Option<Arc<Beginning>>,
    /// True if something happened that cannot be executed again from its beginning.
    pub(crate) is_broken: bool,
}

impl RecordState {
    /// The record of a document.
    pub(crate) fn restored(quota: u64, beginning: Option<Arc<Beginning>>) -> Self {
        Self {
            quota,
            beginning,
            is_broken: false,
        }
    }

    /// Tiles of its beginning.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = &Arc<Tile>> {
        let named = self.beginning.iter().flat_map(|begun| &begun.named);
        let named = named.flat_map(|version| version.tiles.values());
        let own = self.beginning.iter().flat_map(|begun| begun.tiles.values());
        own.chain(named).flatten()
    }

    /// Handles a step that was undone or redone. A step from before the beginning does not exist in a replay, nor does
    /// one that was merged because of the quota.
    pub(crate) fn move_to(&mut self, step: &Step) {
        self.is_broken |= step.operations > 1 && self.beginning.is_some();
        self.go_to(step.id);
    }

    /// Change of the record at a checkpoint; `begin` makes the beginning of another one.
    pub(crate) fn advance(&mut self, begin: impl FnOnce() -> Beginning) -> RecordChange {
        let is_broken = std::mem::take(&mut self.is_broken);
        if self.quota == 0 {
            self.beginning = None;
            return RecordChange::Ends;
        }
        if self.beginning.is_some() && !is_broken {
            return RecordChange::Continues;
        }
        let beginning = Arc::new(begin());
        self.beginning = Some(Arc::clone(&beginning));
        RecordChange::Begins(beginning)
    }

    /// Notes that a step was gone to.
    pub(crate) fn go_to(&mut self, step: u64) {
        let begun = self.beginning.as_ref();
        self.is_broken |= begun.is_some_and(|begun| step <= begun.painting.step);
    }
}

impl Default for RecordState {
    fn default() -> Self {
        Self::restored(RECORD_QUOTA, None)
    }
}
