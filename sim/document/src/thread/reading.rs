//! Reading of pages that somebody waits for.

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

/// Longest time for which a page is tried again that the disk does not give: who waits for it stands still meanwhile.
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
        // Those that failed before may still wait while others are read.
        let is_done = self.shared.lock().failed_fetches.is_empty();
        match served {
            Ok(()) if is_done => self.note_written(Part::Reading),
            Ok(()) => {}
            Err(error) => self.note_failure(Part::Reading, &error),
        }
    }
}

impl DocumentThread {
    /// Reads a page that nobody waits for, as long as half of the memory is free. An error is left to the reader that needs the page.
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

/// Notes that the painting in memory is unreliable: a page of it is not intact, or the disk did not give it in time.
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

/// Content of a page, or an answer that says why there is none; `None` where it is to be tried again.
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

/// The error of the disk, where that is why something is said to be damaged. Once the painting is known to be broken, nothing
/// depends on it any more, and the file, which may be long, is not read through again.
fn judged(shared: &Shared, database: &Database, error: DocumentError) -> DocumentError {
    let is_broken = shared.lock().broken.is_some();
    if is_broken {
        error
    } else {
        database.judged(error)
    }
}

/// Reads the pages that readers wait for. One that the disk does not give is kept to be tried again.
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

/// The same in the midst of a transaction, whose own reads tell a fault of the disk.
pub(super) fn yield_to_readers(shared: &Shared, database: &Database) {
    if let Err(error) = serve_fetches(shared, database) {
        tracing::debug!("a page is not read: {error}");
    }
}
