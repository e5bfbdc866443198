//! The painting's document: autosave, and moves to another file while the painting is painted on.
//!
//! A painting in a file: the document's thread copies it between two commits and goes on in the copy. One
//! in memory alone gets a document beside the file's name, which takes that name once it is whole.

use std::path::{Path, PathBuf};

use maulstick_document::{
    Access, Document, DocumentError, DocumentSettings, Relocate, Relocation, make_room, unfinished,
};
use maulstick_files::{COMPANIONS, companion, is_same};
use maulstick_painting::Sequencer;
use maulstick_session::Autosave;
use maulstick_types::command::advice::Advice;
use maulstick_types::command::{Outcome, SaveAs};

use crate::exporter::Asker;
use crate::refusal::Refusal;

/// A move of a painting to another file in progress.
#[derive(Debug)]
struct Saving {
    asker: Asker,
    to: PathBuf,
    replace: bool,
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    /// It was in memory alone, and is written.
    Written,
    /// It is there, or was in another file: the document moves.
    Moved(Relocation),
}

/// A copy that is being written.
#[derive(Debug)]
struct Copying {
    asker: Asker,
    to: PathBuf,
    written: Relocation,
}

/// State of the document, for the status.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    /// Path of the painting; empty until it has its name.
    pub(crate) path: String,
    /// Journal entries that are committed.
    pub(crate) committed: u64,
    /// Time of the newest commit, ns.
    pub(crate) committed_ns: u64,
    /// True if everything is in the painting's file.
    pub(crate) is_complete: bool,
    /// Fault of the document with advice, or nothing.
    pub(crate) fault: String,
}

/// The painting's document, if it has one, and its moves.
#[derive(Debug)]
pub(crate) struct DocumentHome {
    autosave: Option<Autosave>,
    /// True while the document does not have the name that the painter gave it.
    is_unnamed: bool,
    saving: Option<Saving>,
    copying: Option<Copying>,
    /// Most bytes of pages in memory, where the painting has a document.
    memory: usize,
    /// Commit counter at the newest commit seen, and its time, ns.
    committed: (u64, u64),
}

impl Default for DocumentHome {
    fn default() -> Self {
        Self {
            autosave: None,
            is_unnamed: false,
            saving: None,
            copying: None,
            memory: 1 << 30,
            committed: (0, 0),
        }
    }
}

fn refused(path: &Path, error: &DocumentError) -> Refusal {
    let advice = match error {
        DocumentError::Taken => Advice::Replace,
        error => error.advice(),
    };
    Refusal::new(format!("{}: {error}", path.display()), advice)
}

impl DocumentHome {
    /// Keeps the painting in a document, where its tiles up to the version `since` are.
    pub(crate) fn keep(&mut self, document: Document, since: u64, sequencer: &mut Sequencer) {
        self.autosave = Some(Autosave::new(document, sequencer, since));
    }

    /// Limits the bytes of pages in memory once the painting gets a document.
    pub(crate) fn limit_memory(&mut self, bytes: usize) {
        self.memory = bytes;
    }

    /// The document.
    pub(crate) fn document(&self) -> Option<&Document> {
        self.autosave.as_ref().map(Autosave::document)
    }

    /// True while the painting moves to another file.
    #[cfg(test)]
    pub(crate) fn is_moving(&self) -> bool {
        self.saving.is_some()
    }

    /// Saves what is new, at its periods.
    pub(crate) fn save(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        if let Some(autosave) = &mut self.autosave {
            autosave.turn(sequencer, now_ns);
        }
    }

    /// State of the document, where the journal has so many entries.
    pub(crate) fn kept(&mut self, journal: u64, now_ns: u64) -> Kept {
        let committed = self.document().map_or(0, Document::committed);
        if committed > self.committed.0 {
            self.committed = (committed, now_ns);
        }
        let committed_ns = self.committed.1;
        let Some(document) = self.document() else {
            return Kept {
                committed_ns,
                ..Kept::default()
            };
        };
        let fault = document.fault();
        let is_named = !self.is_unnamed;
        Kept {
            path: if is_named {
                document.path().display().to_string()
            } else {
                String::new()
            },
            committed,
            committed_ns,
            is_complete: committed >= journal && is_named && document.is_saved(),
            fault: fault.map_or(String::new(), |(what, help)| format!("{what}: {help}")),
        }
    }

    /// Begins to move the painting to another file.
    ///
    /// # Errors
    /// [`Refusal`] if it cannot be created there, or a move is in progress.
    pub(crate) fn save_as(
        &mut self,
        asker: Asker,
        asked: &SaveAs,
        sequencer: &mut Sequencer,
    ) -> Result<Outcome, Refusal> {
        let (to, replace) = (Path::new(asked.path.as_str()), asked.replace);
        if let Some(saving) = &self.saving {
            return Err(Refusal::say(
                format!("the painting is on its way to {}", saving.to.display()),
                "wait until it is there, and ask again",
            ));
        }
        let relocated =
            |document: &Document, how| Stage::Moved(document.relocate(to, how, replace));
        let stage = match self.document() {
            Some(document) if self.is_unnamed => relocated(document, Relocate::Rename),
            Some(document) if is_same(document.path(), to) => return Ok(there(to)),
            Some(document) => relocated(document, Relocate::Copy),
            None => {
                self.begin_document(to, replace, sequencer)
                    .map_err(|error| refused(to, &error))?;
                Stage::Written
            }
        };
        self.saving = Some(Saving {
            asker,
            to: to.to_owned(),
            replace,
            stage,
        });
        Ok(Outcome::Waiting)
    }

    /// Begins to write a copy of the painting, which has a file.
    ///
    /// # Errors
    /// [`Refusal`] if it is in memory alone, or a copy is being written.
    pub(crate) fn copy(&mut self, asker: Asker, to: &Path) -> Result<Outcome, Refusal> {
        if self.copying.is_some() {
            return Err(Refusal::say(
                "a copy of the painting is being written",
                "wait until it is there, and ask again",
            ));
        }
        let Some(document) = self.document().filter(|_| !self.is_unnamed) else {
            return Err(Refusal::say(
                "a painting in memory only cannot be copied",
                "save it in a file first",
            ));
        };
        self.copying = Some(Copying {
            asker,
            to: to.to_owned(),
            written: document.relocate(to, Relocate::Leave, false),
        });
        Ok(Outcome::Waiting)
    }

    /// Outcome of the copy, once it is there.
    pub(crate) fn poll_copy(&mut self) -> Option<(Asker, Outcome)> {
        let (copying, autosave) = (self.copying.as_ref()?, self.autosave.as_mut()?);
        let written = autosave.document_mut().poll_relocation(&copying.written)?;
        let outcome = match written {
            Ok(()) => there(&copying.to),
            Err(error) => refused(&copying.to, &error).into(),
        };
        let copying = self.copying.take()?;
        Some((copying.asker, outcome))
    }

    /// Gives a painting in memory alone a document beside the name that it is to have.
    fn begin_document(
        &mut self,
        to: &Path,
        replace: bool,
        sequencer: &mut Sequencer,
    ) -> Result<(), DocumentError> {
        make_room(to, replace)?;
        let settings = DocumentSettings::new(&unfinished(to), Access::Paint);
        let pager = sequencer.painting().pager().clone();
        let document = Document::begin(&settings, &pager)?;
        sequencer.painting_mut().tell_all_again();
        self.keep(document, 0, sequencer);
        self.is_unnamed = true;
        Ok(())
    }

    /// Outcome of the move to another file, once it is there or has failed.
    pub(crate) fn poll_move(
        &mut self,
        sequencer: &mut Sequencer,
        now_ns: u64,
    ) -> Option<(Asker, Outcome)> {
        let (saving, autosave) = (self.saving.as_mut()?, self.autosave.as_mut()?);
        let to = &saving.to;
        let result = match &saving.stage {
            Stage::Moved(moving) => {
                let arrived = autosave.document_mut().poll_relocation(moving)?;
                arrived.map_err(|error| refused(to, &error))
            }
            Stage::Written => {
                let document = autosave.document();
                let fault = document.fault();
                if let Some((what, help)) = fault.filter(|_| document.cancel_checkpoint()) {
                    // A painting in memory stays there, and leaves no part of it elsewhere.
                    let what = format!("{}: {what}", to.display());
                    self.give_document_up(sequencer);
                    Err(Refusal::new(what, help))
                } else {
                    if document.is_ready() {
                        document.limit_memory(self.memory);
                        let moving = document.relocate(to, Relocate::Rename, saving.replace);
                        saving.stage = Stage::Moved(moving);
                    }
                    return None;
                }
            }
        };
        let saving = self.saving.take()?;
        let outcome = match result {
            Ok(()) => {
                self.committed.1 = now_ns;
                self.is_unnamed = false;
                there(&saving.to)
            }
            Err(refusal) => refusal.into(),
        };
        Some((saving.asker, outcome))
    }

    /// Writes everything pending and closes the document, under its new name if a move is in progress.
    ///
    /// # Errors
    /// The reason why something could not be written, or not under that name.
    pub(crate) fn close(&mut self, sequencer: &mut Sequencer) -> Result<(), DocumentError> {
        let arrived = self.arrive(sequencer);
        let closed = match self.autosave.take() {
            Some(autosave) => autosave.close(sequencer),
            None => Ok(()),
        };
        arrived.and(closed)
    }

    /// Waits until the painting has its name, if it is moving to its first one.
    ///
    /// # Errors
    /// The reason why it does not get that; if anything of it was written, it is kept beside that name.
    fn arrive(&mut self, sequencer: &mut Sequencer) -> Result<(), DocumentError> {
        let Some(autosave) = self.autosave.as_mut().filter(|_| self.is_unnamed) else {
            return Ok(());
        };
        let Some(Saving {
            to, replace, stage, ..
        }) = self.saving.take()
        else {
            // It was refused a name, and asked for no other.
            warn_of_name(autosave.document());
            return Ok(());
        };
        let moving = match stage {
            Stage::Moved(moving) => moving,
            Stage::Written => {
                let is_written = autosave.settle(sequencer);
                if !is_written && autosave.document().committed() == 0 {
                    let fault = autosave.document().fault();
                    if autosave.document().cancel_checkpoint() {
                        self.give_document_up(sequencer);
                    }
                    let what = fault.map_or(String::new(), |(what, _)| what);
                    return Err(DocumentError::Unwritten(what));
                }
                autosave.document().relocate(&to, Relocate::Rename, replace)
            }
        };
        let arrived = autosave.document_mut().wait_for_relocation(&moving);
        if arrived.is_err() {
            warn_of_name(autosave.document());
        }
        arrived
    }

    /// Lets go of a document of which nothing could be written.
    fn give_document_up(&mut self, sequencer: &mut Sequencer) {
        let Some(autosave) = self.autosave.take() else {
            return;
        };
        self.is_unnamed = false;
        let path = autosave.document().path().to_owned();
        autosave.abandon(sequencer);
        for ending in std::iter::once("").chain(COMPANIONS) {
            std::fs::remove_file(companion(&path, ending)).ok();
        }
    }
}

/// Logs under which name a painting is that did not get its own.
fn warn_of_name(document: &Document) {
    let path = document.path().display();
    tracing::warn!("the painting is kept in {path}: give that file a name of your own");
}

fn there(path: &Path) -> Outcome {
    Outcome::done(path.display().to_string())
}
