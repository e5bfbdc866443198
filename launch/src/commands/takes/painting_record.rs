//! The record of a painting as a session: records accepted since its beginning, in working time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use maulstick_document::{Document, DocumentError, record};
use maulstick_painting::Sequencer;
use maulstick_recorder::session_file::Event;
use maulstick_rig::UserError;
use maulstick_session::{WorkClock, each_record};

use maulstick_painting_setup::document::{copy_closed, read, wrong};

use super::take_writer::TakeOrigin;
use crate::commands::painting::no_record;

/// A painting that has a record.
#[derive(Debug)]
pub(super) struct PaintingRecord {
    path: PathBuf,
    /// A copy of it.
    document: Document,
    /// Another copy, for the painting at the beginning.
    begin: PathBuf,
    _folder: tempfile::TempDir,
    /// Serial number of the first message.
    first: u64,
    /// Time of the wall clock at its beginning, ms since 1970.
    begun_ms: u64,
    brushes: Vec<String>,
    /// Working time of all of it, ns.
    length_ns: u64,
}

/// Reason to stop reading early.
enum Halt {
    /// The requested part was read.
    Done,
    Fault(UserError),
    Document(DocumentError),
}

impl From<DocumentError> for Halt {
    fn from(error: DocumentError) -> Self {
        Self::Document(error)
    }
}

impl PaintingRecord {
    /// Opens a painting that is open nowhere else.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, or has no record.
    pub(super) fn open(path: &Path) -> Result<Self, UserError> {
        // Fails where it is open in another program.
        let (document, opened) = read(path)?;
        drop(opened);
        document.close().map_err(|error| wrong(path, &error))?;
        let failed = |error: std::io::Error| UserError::failure(error.to_string());
        let folder = tempfile::tempdir().map_err(failed)?;
        let [record, begin] = ["record.maul", "begin.maul"].map(|name| folder.path().join(name));
        copy_closed(path, &record)?;
        copy_closed(path, &begin)?;
        let (document, opened) = read(&record)?;
        let beginning = opened.beginning().ok_or_else(|| no_record(path))?;
        let mut record = Self {
            path: path.to_owned(),
            document,
            begin,
            _folder: folder,
            first: beginning.sequencer.serial,
            begun_ms: beginning.time_ms,
            brushes: beginning.painting.brushes.keys().cloned().collect(),
            length_ns: 0,
        };
        drop(opened);
        let mut clock = WorkClock::default();
        let read = each_record(&record.document, record.first, |_, accepted| {
            record.length_ns = clock.pass(&accepted);
            Ok::<(), DocumentError>(())
        });
        read.map_err(|error| wrong(path, &error))?;
        Ok(record)
    }

    /// Working time of all of it, ns.
    pub(super) fn length_ns(&self) -> u64 {
        self.length_ns
    }

    /// Writes the painting at the beginning, once, to a new file.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read or written.
    pub(super) fn write_painting(&self, to: &Path) -> Result<(), UserError> {
        let failed = |error| wrong(&self.path, &error);
        if record::rewind(&self.begin).map_err(failed)? {
            std::fs::rename(&self.begin, to).map_err(|error| UserError::writing(to, &error))
        } else {
            Err(no_record(&self.path))
        }
    }

    /// Passes the records accepted after `sequencer` to `each`, up to a working time, with the time, ns.
    ///
    /// # Errors
    /// A [`UserError`] where the record is not intact; that of `each`.
    pub(super) fn follow(
        &self,
        sequencer: &mut Sequencer,
        to_ns: u64,
        each: &mut dyn FnMut(&mut Sequencer, u64, Event<'_>) -> Result<(), UserError>,
    ) -> Result<(), UserError> {
        let (mut clock, known) = (WorkClock::default(), sequencer.serial());
        let read = each_record(&self.document, self.first, |_, record| {
            let at_ns = clock.pass(&record);
            if at_ns > to_ns {
                return Err(Halt::Done);
            }
            if record.serial < known {
                return Ok(());
            }
            each(sequencer, at_ns, Event::Accepted(record)).map_err(Halt::Fault)
        });
        match read {
            Ok(()) | Err(Halt::Done) => Ok(()),
            Err(Halt::Fault(fault)) => Err(fault),
            Err(Halt::Document(error)) => Err(wrong(&self.path, &error)),
        }
    }

    /// Beginning of its take, without the painting.
    pub(super) fn origin(&self) -> TakeOrigin {
        let facts = [
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("unix_ns", (self.begun_ms * 1_000_000).to_string()),
            ("rig_ns", "0".to_owned()),
            ("clock", "work".to_owned()),
        ];
        let facts = facts.map(|(name, text)| (name.to_owned(), text));
        TakeOrigin {
            notes: BTreeMap::from([("recording".to_owned(), facts.into())]),
            files: BTreeMap::new(),
            brushes: self.brushes.clone(),
        }
    }
}
