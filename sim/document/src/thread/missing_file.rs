//! Response to a file that was removed, replaced or linked while its painting is open.

use std::path::Path;
use std::sync::atomic::Ordering::SeqCst;
use std::time::Instant;

use maulstick_types::command::advice::Advice;

use super::queues::NoticeKind;
use super::{Content, DocumentThread, Part, Retry};
use crate::error::DocumentError;
use crate::file::database::{Access, Database};
use crate::file::relocate;
use crate::file::watch::{FileState, FileWatch};

/// Advice about a hard link to the file.
const LINK_ADVICE: &str = "remove that name: opened by it after a crash the painting would lack its journal, and be damaged";

impl DocumentThread {
    /// Checks that the files are at their paths, and continues in a new file if they are not.
    pub(super) fn check_files(&mut self, hurry: bool) {
        let state = self.watch.check();
        let (lost, harm) = match &state {
            FileState::InPlace | FileState::Linked => {
                return self.note_links(state == FileState::Linked);
            }
            FileState::Gone(lost) => (lost, "removed or replaced"),
            FileState::Cut(lost) => (lost, "cut short"),
        };
        if !self.file.is_due(hurry) {
            return;
        }
        let to = relocate::free_name_beside(&self.path);
        let continued = match &state {
            FileState::Cut(_) => self.continue_whole_in(&to, false),
            _ => {
                // The file may have been renamed, or only the journal be gone.
                self.database.merge_journal();
                relocate::rescue(&self.database, &to, false).and_then(|()| self.continue_in(&to))
            }
        };
        match continued {
            Ok(()) => {
                let what = format!(
                    "{} was {harm}: the painting continues in {}",
                    lost.display(),
                    to.display()
                );
                let help = "keep that file, or save it under a name of your own";
                tracing::error!("{what}; {help}");
                let mut queues = self.shared.lock();
                queues.moved_to = Some(to);
                queues.notice = Some((NoticeKind::Moved, what, Advice::say(help)));
            }
            Err(error) => {
                let error = DocumentError::Vanished(format!(
                    "{} was {harm}, and {} cannot be made: {error}",
                    lost.display(),
                    to.display()
                ));
                self.shared.fails.store(true, SeqCst);
                let mut queues = self.shared.lock();
                if self.file.failed.is_none() {
                    tracing::error!("{error}; {}", error.advice());
                }
                queues.fault = Some((error.to_string(), error.advice()));
                drop(queues);
                self.file = Retry {
                    failed: Some(Instant::now()),
                    given_up: false,
                };
            }
        }
    }

    /// Continues in a file with the content of the previous one, which has no name any more.
    pub(super) fn continue_in(&mut self, path: &Path) -> Result<(), DocumentError> {
        let (database, _) = Database::open(path, Access::Paint, None)?;
        std::mem::replace(&mut self.database, database).abandon();
        self.watch.remove_journal();
        self.watch = FileWatch::new(path);
        path.clone_into(&mut self.path);
        self.clear_notice();
        if self.content == Content::Merged {
            self.content = Content::Unmerged;
        }
        self.note_written(Part::File);
        Ok(())
    }

    /// Continues in a file with the content of the last merge of the previous one, or a new one, and requests the whole
    /// painting: later records of the journal are in memory alone.
    pub(super) fn continue_whole_in(
        &mut self,
        path: &Path,
        replace: bool,
    ) -> Result<(), DocumentError> {
        if !relocate::copied_without_journal(&self.path, path, replace)? {
            tracing::warn!("{} is not whole any more", self.path.display());
        }
        self.continue_in(path)?;
        self.shared.lock().wants_all = true;
        // Stored pages are not in this file, and must not leave memory before they are.
        self.shared.fails.store(true, SeqCst);
        Ok(())
    }

    /// Clears the notice about the previous file.
    pub(super) fn clear_notice(&self) {
        let mut queues = self.shared.lock();
        (queues.notice, queues.moved_to) = (None, None);
    }

    /// Sets or clears the notice about a hard link to the file.
    fn note_links(&self, is_linked: bool) {
        let mut queues = self.shared.lock();
        let is_noted = matches!(queues.notice, Some((NoticeKind::Linked, ..)));
        if is_linked && queues.notice.is_none() {
            let what = format!("{} has a second name, a hard link", self.path.display());
            tracing::warn!("{what}; {LINK_ADVICE}");
            queues.notice = Some((NoticeKind::Linked, what, Advice::say(LINK_ADVICE)));
        } else if !is_linked && is_noted {
            queues.notice = None;
        }
    }
}
