//! Checkpoints from a painter's thread.

use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use maulstick_painting::sequencer::Record;
use maulstick_painting::snapshot::SequencerSnapshot;
use maulstick_painting::{RecordChange, Sequencer};

/// Time of the wall clock, ms since 1970.
pub(crate) fn wall_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_millis() as u64)
}

/// Checkpoint of a painting, with its place in the journal and its files.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// The painting.
    pub painting: maulstick_painting::Checkpoint,
    /// State of the sequencer.
    pub sequencer: SequencerSnapshot,
    /// Pictures and spectra of grounds and teeth, by their hash.
    pub pictures: Vec<(String, Arc<[u8]>)>,
    /// Change of the record since the last checkpoint.
    pub record: RecordChange,
    /// True if it contains the whole painting, not only the changes.
    pub is_whole: bool,
    /// Accepted records that were not handed over before.
    pub records: Vec<Record>,
}

impl Checkpoint {
    /// Checkpoint of a painting, with the tiles newer than the version `since`; all of them for 0.
    pub fn of(sequencer: &mut Sequencer, since: u64) -> Self {
        let snapshot = sequencer.kept();
        let records = sequencer.take_records();
        let is_unrecorded = sequencer.take_unrecorded();
        let embedded = sequencer.painting().embedded().iter();
        let pictures = embedded.map(|(hash, bytes)| (hash.to_owned(), Arc::clone(bytes)));
        let pictures = pictures.collect();
        let painting = sequencer.painting_mut();
        if is_unrecorded {
            painting.break_record();
        }
        let checkpoint = painting.checkpoint(since);
        Self {
            record: painting.advance_record(&checkpoint, &snapshot, wall_ms()),
            painting: checkpoint,
            sequencer: snapshot,
            pictures,
            is_whole: since == 0,
            records,
        }
    }
}
