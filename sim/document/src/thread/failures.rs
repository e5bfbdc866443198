//! Failures of the disk: painting continues in memory, the failure is reported, and the operation is repeated.

use std::sync::atomic::Ordering::SeqCst;
use std::time::{Duration, Instant};

use super::queues::Life;
use super::{DocumentThread, RETRY_DELAY};
use crate::error::DocumentError;

/// Last failed write of one kind, and the time to retry.
#[derive(Default)]
pub(super) struct Retry {
    pub(super) failed: Option<Instant>,
    /// True if closing failed, after which nothing is retried.
    pub(super) given_up: bool,
}

impl Retry {
    /// True if there was no failure within this time.
    pub(super) fn has_waited(&self, delay: Duration) -> bool {
        self.failed.is_none_or(|when| when.elapsed() >= delay)
    }

    /// True if it may be tried now.
    pub(super) fn is_due(&self, hurry: bool) -> bool {
        !self.given_up && (hurry || self.has_waited(RETRY_DELAY))
    }
}

/// Part of the work on the file that fails and is repeated as a whole.
#[derive(Clone, Copy)]
pub(super) enum Part {
    Checkpoint,
    Journal,
    File,
    Reading,
}

impl DocumentThread {
    /// Clears the failure of this part.
    pub(super) fn note_written(&mut self, part: Part) {
        let failed = self.retry(part).failed.take().is_some();
        let all = [&self.checkpoint, &self.journal, &self.file, &self.reading];
        if all.iter().any(|part| part.failed.is_some()) {
            return;
        }
        let mut queues = self.shared.lock();
        let is_sound = queues.broken.is_none() && !queues.wants_all;
        self.shared.fails.store(!is_sound, SeqCst);
        if failed {
            tracing::info!("the painting is read and written again");
            if queues.broken.is_none() {
                queues.fault = None;
            }
        }
    }

    /// Records and reports a failure; the operation is repeated.
    pub(super) fn note_failure(&mut self, part: Part, error: &DocumentError) {
        self.shared.fails.store(true, SeqCst);
        let mut queues = self.shared.lock();
        if queues.fault.is_none() {
            let what = match part {
                Part::Reading => "read",
                Part::Checkpoint | Part::Journal | Part::File => "written",
            };
            tracing::error!("the painting cannot be {what}: {error}; {}", error.advice());
        }
        queues.fault = Some((error.to_string(), error.advice()));
        let closing = queues.life == Life::Closing;
        // Threads that wait for a flush must not wait for a retry.
        queues.flushes.clear();
        let relocations = std::mem::take(&mut queues.relocations);
        drop(queues);
        self.committed_for_relocation = false;
        for request in relocations {
            let unwritten = DocumentError::Unwritten(error.to_string());
            request.answer.send(Err(unwritten)).ok();
        }
        *self.retry(part) = Retry {
            failed: Some(Instant::now()),
            given_up: closing,
        };
    }

    fn retry(&mut self, part: Part) -> &mut Retry {
        match part {
            Part::Checkpoint => &mut self.checkpoint,
            Part::Journal => &mut self.journal,
            Part::File => &mut self.file,
            Part::Reading => &mut self.reading,
        }
    }
}
