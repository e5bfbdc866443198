//! The painting's part of its record.

use std::sync::Arc;

use maulstick_canvas::tile::Tile;

use super::{Checkpoint, Painting};
use crate::beginning::{Beginning, RECORD_QUOTA, RecordChange};
use crate::history::Step;
use crate::snapshot::SequencerSnapshot;

/// Record of a painting: where it begins, and its limit.
#[derive(Clone, Debug)]
pub(crate) struct RecordState {
    /// Most bytes of it; 0 keeps none.
    pub(crate) quota: u64,
    /// Its beginning, if the document has it.
    beginning: Option<Arc<Beginning>>,
    /// True if something happened that cannot be executed again from its beginning.
    is_broken: bool,
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

    /// Handles a move to a step.
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

impl Painting {
    /// Limit of the record, bytes; above it a new record begins at the next checkpoint. 0 keeps none.
    pub fn set_record_quota(&mut self, bytes: u64) {
        self.record.quota = bytes;
    }

    /// Limit of the record, bytes.
    #[must_use]
    pub fn record_quota(&self) -> u64 {
        self.record.quota
    }

    /// Starts a new record at the next checkpoint, as after a change that no accepted message describes.
    pub fn break_record(&mut self) {
        self.record.is_broken = true;
    }

    /// Change of the record at a checkpoint that was just made of this painting and its sequencer, at a wall-clock
    /// time, ms since 1970.
    pub fn advance_record(
        &mut self,
        checkpoint: &Checkpoint,
        sequencer: &SequencerSnapshot,
        time_ms: u64,
    ) -> RecordChange {
        let record = &mut self.record;
        let is_broken = std::mem::take(&mut record.is_broken);
        if record.quota == 0 {
            record.beginning = None;
            return RecordChange::Ends;
        }
        if record.beginning.is_some() && !is_broken {
            return RecordChange::Continues;
        }
        let is_open = |step: &&Step| {
            let mut open = checkpoint.kept.open_steps.iter();
            open.any(|open| open.step == step.id)
        };
        let beginning = Arc::new(Beginning {
            time_ms,
            painting: checkpoint.kept.clone(),
            sequencer: sequencer.clone(),
            tiles: self.surfaces.painted(),
            loads: checkpoint.loads.clone(),
            open: checkpoint.steps.iter().filter(is_open).cloned().collect(),
            named: self.versions.iter().cloned().collect(),
        });
        self.record.beginning = Some(Arc::clone(&beginning));
        RecordChange::Begins(beginning)
    }
}
