//! A painting kept in its document: each accepted message at once, a checkpoint each second.

use maulstick_document::{Checkpoint, Document, DocumentError};
use maulstick_painting::Sequencer;

/// Time between two checkpoints, ns: the most that is repeated after a crash.
const PERIOD_NS: u64 = 1_000_000_000;

/// A painting's document, and its state.
#[derive(Debug)]
pub struct Autosave {
    document: Document,
    /// Number of the newest tile version that it received.
    since: u64,
    /// Accepted records in its newest checkpoint.
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
        autosave.save_to_document(sequencer);
        autosave
    }

    /// The document.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The document, for the result of its move.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// Closes a document that could not be written: the painting is in memory alone.
    pub fn abandon(self, sequencer: &mut Sequencer) {
        sequencer.stop_recording();
        if let Err(error) = self.document.close() {
            tracing::debug!("the document is given up: {error}");
        }
    }

    fn save_to_document(&mut self, sequencer: &mut Sequencer) {
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

    /// Hands over the records accepted since, and each second a checkpoint. The journal of the sequencer was taken
    /// before.
    pub fn turn(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        self.document.update_path();
        self.document.record(sequencer.take_records());
        let due = now_ns >= self.saved_ns + PERIOD_NS || now_ns < self.saved_ns;
        let is_new = sequencer.serial() != self.serial || self.document.wants_all();
        if due && is_new && self.document.is_ready() {
            self.saved_ns = now_ns;
            self.save_to_document(sequencer);
        }
    }

    /// Waits until all that was done is in the file; false where it cannot be written.
    pub fn settle(&mut self, sequencer: &mut Sequencer) -> bool {
        self.document.record(sequencer.take_records());
        self.document.flush();
        if self.document.is_ready() {
            self.save_to_document(sequencer);
            self.document.flush();
        }
        // The file may have turned out to lack a part of the painting: then it gets all of it.
        if self.document.wants_all() && self.document.is_ready() {
            self.save_to_document(sequencer);
            self.document.flush();
        }
        self.document.is_saved()
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use maulstick_document::{Access, DocumentSettings};
    use maulstick_optics::PaintLibrary;
    use maulstick_painting::{Painting, PaintingSetup};

    use super::*;

    /// A saved painting with a version, whose journal was cut short just now, and another version since.
    fn cut_short(path: &Path) -> (Autosave, Sequencer) {
        let settings = DocumentSettings::new(path, Access::Paint);
        let (document, _) = Document::open(&settings).expect("begun");
        let setup = PaintingSetup {
            cells: [128, 64],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let pager = document.pager().clone();
        let painting = Painting::paged(&setup, library, pager).expect("a painting");
        let mut sequencer = Sequencer::new(painting);
        let mut autosave = Autosave::new(document, &mut sequencer, 0);
        assert!(autosave.settle(&mut sequencer));
        sequencer.painting_mut().keep("before").expect("kept");
        assert!(autosave.settle(&mut sequencer));
        let journal = path.with_extension("maul-wal");
        let journal = std::fs::File::options().write(true).open(journal);
        journal.expect("it is there").set_len(0).expect("cut");
        sequencer.painting_mut().keep("after").expect("kept");
        (autosave, sequencer)
    }

    /// True if a closed painting has both versions.
    fn is_whole(path: &Path) -> bool {
        let settings = DocumentSettings::new(path, Access::Read);
        let (document, opened) = Document::open(&settings).expect("opened");
        let opened = opened.expect("a painting");
        let sequencer = opened.sequencer().expect("whole");
        let names: Vec<&str> = sequencer
            .painting()
            .named()
            .map(|version| &*version.name)
            .collect();
        let is_whole = names.contains(&"before") && names.contains(&"after");
        document.close().expect("closed");
        is_whole
    }

    #[test]
    fn a_file_that_lost_a_part_is_settled_with_all_of_the_painting() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut autosave, mut sequencer) = cut_short(&folder.path().join("sea.maul"));
        assert!(autosave.settle(&mut sequencer));
        assert!(!autosave.document().wants_all());
        autosave.close(&mut sequencer).expect("closed");
        assert!(is_whole(&folder.path().join("sea-kept.maul")));
    }

    #[test]
    fn a_file_that_lost_a_part_is_closed_with_all_of_the_painting() {
        let folder = tempfile::tempdir().expect("a folder");
        let (autosave, mut sequencer) = cut_short(&folder.path().join("sea.maul"));
        autosave.close(&mut sequencer).expect("closed");
        assert!(is_whole(&folder.path().join("sea-kept.maul")));
    }
}
