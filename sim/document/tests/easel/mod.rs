//! A painting in a document, handled like in the paint node.

#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use maulstick_painting::edits::Undo;
use std::sync::Arc;

use maulstick_document::{Checkpoint, Document, DocumentSettings};
use maulstick_painting::Sequencer;

use crate::studio::{Act, Painter, equip, sequencer};

pub struct Easel {
    pub document: Document,
    pub sequencer: Sequencer,
    since: u64,
}

impl Easel {
    /// Begins a painting with two brushes.
    pub fn begin(settings: &DocumentSettings) -> Self {
        let (document, opened) = Document::open(settings).expect("begun");
        assert!(opened.is_none(), "it is new");
        let mut kept = sequencer(Arc::clone(document.pager()));
        kept.record();
        let mut easel = Self {
            document,
            sequencer: kept,
            since: 0,
        };
        easel.save_to_document();
        equip(&mut easel.sequencer);
        easel.record();
        easel
    }

    /// Continues a painting.
    ///
    /// # Errors
    /// The fault of the file.
    pub fn open(settings: &DocumentSettings) -> Result<Self, String> {
        let (document, opened) = Document::open(settings).map_err(|error| error.to_string())?;
        let opened = opened.ok_or("there is no painting in it")?;
        let since = opened.snapshot().versions;
        let mut kept = opened.sequencer().map_err(|refusal| refusal.to_string())?;
        kept.record();
        match document.pager().fault() {
            Some(fault) => Err(fault.to_owned()),
            None => Ok(Self {
                document,
                sequencer: kept,
                since,
            }),
        }
    }

    fn record(&mut self) {
        self.document.record(self.sequencer.take_records());
    }

    fn save_to_document(&mut self) {
        if self.document.wants_all() {
            self.sequencer.painting_mut().tell_all_again();
            self.since = 0;
        }
        let checkpoint = Checkpoint::of(&mut self.sequencer, self.since);
        self.since = checkpoint.painting.kept.versions;
        self.document.write_checkpoint(checkpoint);
    }

    pub fn act(&mut self, painter: &mut Painter, act: &Act) {
        painter.act(&mut self.sequencer, act);
        self.record();
    }

    /// Hands a checkpoint over, if the last one is written.
    pub fn checkpoint(&mut self) {
        if self.document.is_ready() {
            self.save_to_document();
        }
    }

    pub fn flush(&self) {
        self.document.flush();
        assert_eq!(self.document.fault(), None);
    }

    /// Undoes all possible steps; returns their number.
    pub fn undo_all(&mut self) -> usize {
        let mut steps = 0;
        while self.sequencer.edit(Undo { brush: None }).is_ok() {
            steps += 1;
        }
        self.record();
        steps
    }

    /// Writes all as a checkpoint and closes the file.
    pub fn close(self) {
        self.try_close().expect("closed");
    }

    /// Writes all as a checkpoint and closes the file; returns the fault of an unwritable one.
    pub fn try_close(mut self) -> Result<(), String> {
        self.document.flush();
        self.save_to_document();
        self.document.flush();
        match self.document.fault() {
            Some((what, _)) => Err(what),
            None => self.document.close().map_err(|error| error.to_string()),
        }
    }
}
