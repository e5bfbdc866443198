//! The painting goes on in another file, while it is painted on.
//!
//! A painting in a file: the document's thread copies it between two commits and goes on in the copy. One
//! in memory alone gets a document beside the file's name, which takes that name once it is whole.

use std::path::{Path, PathBuf};

use maulstick_document::{
    Access, Document, DocumentError, DocumentSettings, Relocate, Relocation, make_room, unfinished,
};
use maulstick_files::{COMPANIONS, companion};
use maulstick_types::command::Outcome;
use maulstick_types::command::advice::Advice;

use super::PaintNode;
use crate::exporter::Asker;
use crate::refusal::Refusal;
use maulstick_session::Autosave;

/// A move of a painting to another file in progress.
#[derive(Debug)]
pub(super) struct Saving {
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

fn refused(path: &Path, error: &DocumentError) -> Refusal {
    let advice = match error {
        DocumentError::Taken => Advice::Replace,
        error => error.advice(),
    };
    Refusal::new(format!("{}: {error}", path.display()), advice)
}

/// True if two names lead to the same file.
fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    one == other || real(one).is_some_and(|path| real(other) == Some(path))
}

impl PaintNode {
    /// Begins to move the painting to another file.
    ///
    /// # Errors
    /// [`Refusal`] if it cannot be created there, or a move is in progress.
    pub(super) fn save_as(
        &mut self,
        asker: Asker,
        to: &Path,
        replace: bool,
    ) -> Result<Outcome, Refusal> {
        if let Some(saving) = &self.saving {
            return Err(Refusal::say(
                format!("the painting is on its way to {}", saving.to.display()),
                "wait until it is there, and ask again",
            ));
        }
        let stage = match &self.autosave {
            Some(autosave) if self.unnamed => {
                Stage::Moved(autosave.document().relocate(to, Relocate::Rename, replace))
            }
            Some(autosave) if is_same(autosave.document().path(), to) => return Ok(there(to)),
            Some(autosave) => {
                Stage::Moved(autosave.document().relocate(to, Relocate::Copy, replace))
            }
            None => {
                self.begin_document(to, replace)
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
    pub(super) fn copy(&mut self, asker: Asker, to: &Path) -> Result<Outcome, Refusal> {
        if self.copying.is_some() {
            return Err(Refusal::say(
                "a copy of the painting is being written",
                "wait until it is there, and ask again",
            ));
        }
        let Some(autosave) = self.autosave.as_ref().filter(|_| !self.unnamed) else {
            return Err(Refusal::say(
                "a painting in memory only cannot be copied",
                "save it in a file first",
            ));
        };
        let written = autosave.document().relocate(to, Relocate::Leave, false);
        self.copying = Some((asker, to.to_owned(), written));
        Ok(Outcome::Waiting)
    }

    /// Answers once a copy is there.
    pub(super) fn go_on_copying(&mut self) {
        let (Some((_, to, written)), Some(autosave)) = (&self.copying, &mut self.autosave) else {
            return;
        };
        let Some(written) = autosave.document_mut().poll_relocation(written) else {
            return;
        };
        let outcome = match written {
            Ok(()) => there(to),
            Err(error) => refused(to, &error).into(),
        };
        if let Some(((client, number), ..)) = self.copying.take() {
            self.replies.keep(client, number, outcome);
        }
    }

    /// Gives a painting in memory alone a document beside the name that it is to have.
    fn begin_document(&mut self, to: &Path, replace: bool) -> Result<(), DocumentError> {
        make_room(to, replace)?;
        let settings = DocumentSettings::new(&unfinished(to), Access::Paint);
        let pager = self.sequencer.painting().pager().clone();
        let document = Document::begin(&settings, &pager)?;
        self.sequencer.painting_mut().tell_all_again();
        self.autosave = Some(Autosave::new(document, &mut self.sequencer, 0));
        self.unnamed = true;
        Ok(())
    }

    /// Goes on with it, as far as that is possible now.
    pub(super) fn go_on_saving(&mut self, now_ns: u64) {
        let (Some(saving), Some(autosave)) = (&mut self.saving, &mut self.autosave) else {
            return;
        };
        let outcome = match &saving.stage {
            Stage::Written => {
                let fault = autosave.document().fault();
                if let Some((what, help)) =
                    fault.filter(|_| autosave.document().cancel_checkpoint())
                {
                    // A painting in memory stays there, and leaves no part of it elsewhere.
                    let what = format!("{}: {what}", saving.to.display());
                    let refusal = Refusal::new(what, help);
                    self.give_document_up();
                    Some(Err(refusal))
                } else {
                    if autosave.document().is_ready() {
                        autosave.document().limit_memory(self.memory);
                        let moving = autosave.document().relocate(
                            &saving.to,
                            Relocate::Rename,
                            saving.replace,
                        );
                        saving.stage = Stage::Moved(moving);
                    }
                    None
                }
            }
            Stage::Moved(moving) => autosave
                .document_mut()
                .poll_relocation(moving)
                .map(|arrived| arrived.map_err(|error| refused(&saving.to, &error))),
        };
        let Some(outcome) = outcome else {
            return;
        };
        let Some(saving) = self.saving.take() else {
            return;
        };
        let outcome = match outcome {
            Ok(()) => {
                self.committed.1 = now_ns;
                self.unnamed = false;
                there(&saving.to)
            }
            Err(refusal) => refusal.into(),
        };
        self.status_ns = 0;
        let (client, number) = saving.asker;
        self.replies.keep(client, number, outcome);
    }

    /// Waits until the painting has its name, if it is moving to its first one.
    ///
    /// # Errors
    /// The reason why it does not get that; if anything of it was written, it is kept beside that name.
    pub(super) fn arrive(&mut self) -> Result<(), DocumentError> {
        let Some(autosave) = self.autosave.as_mut().filter(|_| self.unnamed) else {
            return Ok(());
        };
        let Some(Saving {
            to, replace, stage, ..
        }) = self.saving.take()
        else {
            // It was refused a name, and asked for no other.
            tell_where(autosave.document());
            return Ok(());
        };
        let moving = match stage {
            Stage::Moved(moving) => moving,
            Stage::Written => {
                let is_written = autosave.settle(&mut self.sequencer);
                if !is_written && autosave.document().committed() == 0 {
                    let fault = autosave.document().fault();
                    if autosave.document().cancel_checkpoint() {
                        self.give_document_up();
                    }
                    let what = fault.map_or(String::new(), |(what, _)| what);
                    return Err(DocumentError::Unwritten(what));
                }
                autosave.document().relocate(&to, Relocate::Rename, replace)
            }
        };
        let arrived = autosave.document_mut().wait_for_relocation(&moving);
        if arrived.is_err() {
            tell_where(autosave.document());
        }
        arrived
    }

    /// Lets go of a document of which nothing could be written.
    fn give_document_up(&mut self) {
        let Some(autosave) = self.autosave.take() else {
            return;
        };
        self.unnamed = false;
        let path = autosave.document().path().to_owned();
        autosave.abandon(&mut self.sequencer);
        for ending in std::iter::once("").chain(COMPANIONS) {
            std::fs::remove_file(companion(&path, ending)).ok();
        }
    }
}

/// Says under which name a painting is that did not get its own.
fn tell_where(document: &Document) {
    let path = document.path().display();
    tracing::warn!("the painting is kept in {path}: give that file a name of your own");
}

fn there(path: &Path) -> Outcome {
    Outcome::done(path.display().to_string())
}
