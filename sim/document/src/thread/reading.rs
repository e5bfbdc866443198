//! Reading of pages for waiting readers.

use std::sync::atomic::Ordering::SeqCst;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use maulstick_canvas::page::Page;
use maulstick_canvas::planes::Planes;

use super::DocumentThread;
use super::failures::Part;
use super::queues::{Fetch, Life, Shared};
use crate::error::DocumentError;
use crate::file::database::Database;
use crate::record;

/// Longest time of retrying a page that the disk cannot read: its reader stands still meanwhile.
const PATIENCE: Duration = Duration::from_secs(15);

/// Processor time of this thread.
fn thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    now.map_or(Duration::ZERO, Duration::from)
}

impl DocumentThread {
    /// Reads the pages that readers wait for, and reports a fault of the disk.
    pub(super) fn read_pages(&mut self) {
        let served = serve_fetches(&self.shared, &self.database);
        // Earlier failures may still wait while others are read.
        let is_done = self.shared.lock().failed_fetches.is_empty();
        match served {
            Ok(()) if is_done => self.note_written(Part::Reading),
            Ok(()) => {}
            Err(error) => self.note_failure(Part::Reading, &error),
        }
    }
}

impl DocumentThread {
    /// Reads a page without a waiting reader, while half of the memory is free. An error is left to its next reader.
    pub(super) fn read_ahead(&mut self, page: &Page<Planes>) {
        let counts = page.pager().counts();
        if counts.resident >= counts.bound / 2 {
            self.to_read_ahead.clear();
            return;
        }
        if page.peek().is_none()
            && let Ok(planes) = self.database.planes(page.id())
        {
            page.put_back(planes);
        }
    }
}

/// Records that the painting in memory is unreliable: a page is not intact, or the disk did not return it in time.
fn note_broken(shared: &Shared, error: &DocumentError) {
    let what = match error {
        DocumentError::Damaged(what) => what.clone(),
        error => error.to_string(),
    };
    shared.fails.store(true, SeqCst);
    let mut queues = shared.lock();
    queues.fault = Some((error.to_string(), error.advice()));
    queues.broken = Some(what);
}

/// Content of a page, or the error; `None` if it is to be retried.
fn answered<T>(
    shared: &Shared,
    read: Result<T, DocumentError>,
    until: Instant,
    answer: &Sender<Result<T, DocumentError>>,
    failure: &mut Option<DocumentError>,
) -> Option<()> {
    let waits = Instant::now() < until && shared.lock().life == Life::Open;
    let read = match read {
        Err(error) if waits && error.may_pass() => {
            *failure = Some(error);
            return None;
        }
        read => read.inspect_err(|error| note_broken(shared, error)),
    };
    // The reader may have given up.
    answer.send(read).ok();
    Some(())
}

/// The error, or the disk's where that is the cause of apparent damage. Once the painting is known to be broken, the
/// file, which may be long, is not read through again.
fn judged(shared: &Shared, database: &Database, error: DocumentError) -> DocumentError {
    let is_broken = shared.lock().broken.is_some();
    if is_broken {
        error
    } else {
        database.judged(error)
    }
}

/// Reads the pages that readers wait for. A page that the disk cannot read is kept for a retry.
///
/// # Errors
/// The fault of the disk.
fn serve_fetches(shared: &Shared, database: &Database) -> Result<(), DocumentError> {
    let now = Instant::now();
    let fetches = {
        let mut queues = shared.lock();
        let new = std::mem::take(&mut queues.fetches);
        let mut all = std::mem::take(&mut queues.retried);
        all.extend(new.into_iter().map(|fetch| (fetch, now)));
        all
    };
    if fetches.is_empty() {
        return Ok(());
    }
    let begun = thread_cpu();
    let mut failure = None;
    for (fetch, since) in fetches {
        let until = since + PATIENCE;
        let failed = &mut failure;
        let done = match &fetch {
            Fetch::Planes(id, answer) => {
                let read = database.planes(*id);
                let read = read.map_err(|error| judged(shared, database, error));
                answered(shared, read, until, answer, failed)
            }
            Fetch::Load(id, answer) => {
                let read = database.load(*id);
                let read = read.map_err(|error| judged(shared, database, error));
                answered(shared, read, until, answer, failed)
            }
            Fetch::Records(serial, answer) => {
                answer.send(record::row_from(database, *serial)).ok();
                Some(())
            }
            Fetch::Shown([place, version, look], answer) => {
                answer.send(database.shown(*place, *version, *look)).ok();
                Some(())
            }
        };
        if done.is_none() {
            shared.lock().failed_fetches.push((fetch, since));
        }
    }
    let spent = thread_cpu().saturating_sub(begun);
    shared.page_in_ns.fetch_add(spent.as_nanos() as u64, SeqCst);
    failure.map_or(Ok(()), Err)
}

/// Serves readers within a transaction, whose own reads detect a fault of the disk.
pub(super) fn yield_to_readers(shared: &Shared, database: &Database) {
    if let Err(error) = serve_fetches(shared, database) {
        tracing::debug!("a page is not read: {error}");
    }
}
