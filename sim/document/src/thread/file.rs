//! The file of an open painting when it is removed, replaced, or given a second name.

use std::path::Path;
use std::time::Instant;

use super::{Part, Thread, Tries};
use crate::database::{Access, Database};
use crate::error::DocumentError;
use crate::moving;
use crate::watch::{Found, Watch};

/// Advice about a second name of the file.
const LINKED: &str = "remove that name: opened by it after a crash the painting would lack its journal, and be damaged";

impl Thread {
    /// Sees that what is committed is in files that have a name, and goes on in a new one where it is not.
    pub(super) fn see_to_the_file(&mut self, hurry: bool) {
        let gone = match self.watch.look() {
            Found::Gone(gone) => gone,
            found => return self.note_links(found == Found::Linked),
        };
        if !self.file.may(hurry) {
            return;
        }
        let to = moving::name_beside(&self.path);
        // The file may have another name now, or the journal alone be gone.
        self.database.fold();
        let rescued = moving::rescue(&self.database, &to, false);
        match rescued.and_then(|()| self.go_to(&to)) {
            Ok(()) => {
                let what = format!(
                    "{} was removed or replaced: the painting goes on in {}",
                    gone.display(),
                    to.display()
                );
                let help = "keep that file, or save it under a name of your own";
                tracing::error!("{what}; {help}");
                let mut queues = self.shared.lock();
                queues.went_to = Some(to);
                queues.notice = Some((what, help));
            }
            Err(error) => {
                let error = DocumentError::Vanished(format!(
                    "{} was removed or replaced, and {} cannot be made: {error}",
                    gone.display(),
                    to.display()
                ));
                let mut queues = self.shared.lock();
                if self.file.failed.is_none() {
                    tracing::error!("{error}; {}", error.help());
                }
                (queues.fault, queues.help) = (error.to_string(), error.help());
                drop(queues);
                self.file = Tries {
                    failed: Some(Instant::now()),
                    given_up: false,
                };
            }
        }
    }

    /// Goes on in a file that has all that the one before had, which has no name any more.
    pub(super) fn go_to(&mut self, path: &Path) -> Result<(), DocumentError> {
        let (database, _) = Database::open(path, Access::Paint, None)?;
        std::mem::replace(&mut self.database, database).abandon();
        self.watch.remove_journal();
        self.watch = Watch::new(path);
        path.clone_into(&mut self.path);
        self.settled();
        self.well(Part::File);
        Ok(())
    }

    /// Withdraws the notice about the previous file.
    pub(super) fn settled(&self) {
        let mut queues = self.shared.lock();
        (queues.notice, queues.went_to) = (None, None);
    }

    /// Tells of a second name of the file, for as long as it has one.
    fn note_links(&self, is_linked: bool) {
        let mut queues = self.shared.lock();
        let notice = queues.notice.as_ref();
        let told = notice.is_some_and(|(_, help)| *help == LINKED);
        if is_linked && notice.is_none() {
            let what = format!("{} has a second name, a hard link", self.path.display());
            tracing::warn!("{what}; {LINKED}");
            queues.notice = Some((what, LINKED));
        } else if !is_linked && told {
            queues.notice = None;
        }
    }
}
