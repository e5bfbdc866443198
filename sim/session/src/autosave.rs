//! A painting kept in its document: each accepted message at once, a checkpoint each second.

use maulstick_document::{Checkpoint, Document, DocumentError};
use maulstick_painting::Sequencer;

/// Time between two checkpoints, ns: as much is done again after a crash at most.
const PERIOD_NS: u64 = 1_000_000_000;

/// A painting's document, and what it knows of it.
#[derive(Debug)]
pub struct Autosave {
    document: Document,
    /// Number of the newest tile version that it was told of.
    since: u64,
    /// How many accepted things are in its newest checkpoint.
    serial: u64,
    saved_ns: u64,
}

impl Autosave {
    /// Keeps the painting of `sequencer` in `document`, where tiles up to the version `since` are.
    #[must_use]
    pub fn new(document: Document, sequencer: &mut Sequencer, since: u64) -> Self {
        sequencer.record();
        let mut autosave = Self {
            document,
            since,
            serial: 0,
            saved_ns: 0,
        };
        autosave.hand_over(sequencer);
        autosave
    }

    /// The document.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The document, to be asked what became of its move.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// Lets go of a document into which nothing could be written: the painting is in memory alone.
    pub fn abandon(self, sequencer: &mut Sequencer) {
        sequencer.stop_recording();
        if let Err(error) = self.document.close() {
            tracing::debug!("the document is given up: {error}");
        }
    }

    fn hand_over(&mut self, sequencer: &mut Sequencer) {
        let painting = sequencer.painting_mut();
        if self.document.wants_all() {
            painting.tell_all_again();
            self.since = 0;
        }
        if self.document.record_bytes() > painting.record_quota() {
            painting.break_record();
        }
        let checkpoint = Checkpoint::of(sequencer, self.since);
        (self.since, self.serial) = (
            checkpoint.painting.kept.versions,
            checkpoint.sequencer.serial,
        );
        self.document.write_checkpoint(checkpoint);
    }

    /// Hands over what was accepted since, and each second a checkpoint. The journal of the sequencer was
    /// taken before.
    pub fn turn(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        self.document.update_path();
        self.document.record(sequencer.take_records());
        let due = now_ns >= self.saved_ns + PERIOD_NS || now_ns < self.saved_ns;
        let is_new = sequencer.serial() != self.serial || self.document.wants_all();
        if due && is_new && self.document.is_ready() {
            self.saved_ns = now_ns;
            self.hand_over(sequencer);
        }
    }

    /// Waits until all that was done is in the file; false where it cannot be written.
    pub fn settle(&mut self, sequencer: &mut Sequencer) -> bool {
        self.document.record(sequencer.take_records());
        self.document.flush();
        if self.document.is_ready() {
            self.hand_over(sequencer);
            self.document.flush();
        }
        self.document.is_ready()
    }

    /// Writes all and closes the file.
    ///
    /// # Errors
    /// Why something could not be written.
    pub fn close(mut self, sequencer: &mut Sequencer) -> Result<(), DocumentError> {
        self.settle(sequencer);
        self.document.close()
    }
}
