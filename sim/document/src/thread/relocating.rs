//! Relocation of the file of an open painting.

use std::path::Path;

use super::DocumentThread;
use crate::error::DocumentError;
use crate::file::database::{Access, Database, is_new};
use crate::file::relocate::{self, Relocate, RelocateRequest};
use crate::file::watch::{FileState, FileWatch};

/// The file at a path; SQLite would create a blank one where it is absent.
fn open(path: &Path) -> Result<Database, DocumentError> {
    if is_new(path)? {
        return Err(DocumentError::Missing);
    }
    Database::open(path, Access::Paint, None).map(|(database, _)| database)
}

impl DocumentThread {
    /// Relocates the painting and continues there, or at its old path if that fails.
    ///
    /// # Errors
    /// If the painting cannot continue in either file.
    pub(super) fn relocate(mut self, request: RelocateRequest) -> Result<Self, DocumentError> {
        self.committed_for_relocation = false;
        let state = self.watch.check();
        if let Some(answer) = self.answer_of_a_part(&state, &request) {
            request.answer.send(Err(answer)).ok();
            return Ok(self);
        }
        if request.how == Relocate::Leave {
            let copied = relocate::rescue(&self.database, &request.to, request.replace);
            request.answer.send(copied).ok();
            return Ok(self);
        }
        if let FileState::Gone(_) = state {
            let rescued = relocate::rescue(&self.database, &request.to, request.replace)
                .and_then(|()| self.continue_in(&request.to));
            request.answer.send(rescued).ok();
            return Ok(self);
        }
        // An error now would appear when it is closed, and then it could not be opened again.
        match self.database.try_merge_journal() {
            // It is then closed with its journal, and refused.
            Ok(()) | Err(DocumentError::Full) => {}
            Err(error) => {
                let error = self.database.judged(error);
                request.answer.send(Err(error)).ok();
                return Ok(self);
            }
        }
        self.watch.note_merged();
        let relocated = self.database.close().and_then(|()| {
            relocate::relocate(&self.path, &request)?;
            open(&request.to).inspect_err(|_| relocate::revert(&self.path, &request))
        });
        let (opened, outcome) = match relocated {
            Ok(database) => (Ok((database, request.to.clone())), Ok(())),
            Err(error) => (
                open(&self.path).map(|database| (database, self.path.clone())),
                Err(error),
            ),
        };
        match opened {
            Ok((database, path)) => {
                self.watch = FileWatch::new(&path);
                (self.database, self.path) = (database, path);
                if outcome.is_ok() {
                    self.clear_notice();
                }
            }
            Err(error) => {
                let mut queues = self.shared.lock();
                queues.broken = Some(error.to_string());
                queues.fault = Some((error.to_string(), error.advice()));
                return Err(error);
            }
        }
        request.answer.send(outcome).ok();
        Ok(self)
    }

    /// The answer for a file that lacks a part of the painting; `None` if it is complete. Such a painting is not
    /// relocated. But one that was cut short, without another file beside it, continues at the new path, and requests
    /// the whole painting there.
    fn answer_of_a_part(
        &mut self,
        state: &FileState,
        request: &RelocateRequest,
    ) -> Option<DocumentError> {
        let is_cut = matches!(state, FileState::Cut(_));
        if is_cut && request.how != Relocate::Leave {
            if let Err(error) = self.continue_whole_in(&request.to, request.replace) {
                return Some(error);
            }
            self.shared.lock().moved_to = Some(request.to.clone());
            return Some(DocumentError::Incomplete(request.to.clone()));
        }
        let lacks = is_cut || self.shared.lock().wants_all;
        lacks.then(|| DocumentError::Incomplete(self.path.clone()))
    }
}
