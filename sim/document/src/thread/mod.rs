//! Thread that owns a painting's file: it writes the data handed over and reads pages that left memory. Readers that
//! wait for a page come first.

mod missing_file;
pub(crate) mod queues;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use maulstick_painting::sequencer::Record;

use crate::checkpoint::Checkpoint;
use crate::error::DocumentError;
use crate::file::database::{Access, Database, is_new};
use crate::file::relocate::{self, Relocate, RelocateRequest};
use crate::file::watch::{FileState, FileWatch};
use crate::journal;
use crate::record;
use crate::writing::{ShownTile, Writer};
use queues::{EndGuard, Fetch, Life, Shared};

/// Longest time until an accepted record is in the file.
const COMMIT_PERIOD: Duration = Duration::from_millis(100);
/// Longest time for the first checkpoint of a painting that was in memory alone, which is one transaction.
const FIRST_CHECKPOINT: Duration = Duration::from_secs(3600);
/// Delay before a failed write is retried.
const RETRY_DELAY: Duration = Duration::from_secs(1);
/// Largest number of displayed tiles in one transaction.
const SHOWN_BATCH: usize = 128;

/// The document's thread.
pub(crate) struct DocumentThread {
    shared: Arc<Shared>,
    database: Database,
    /// The painting's file.
    path: PathBuf,
    writes: bool,
    /// True if nothing of the painting is in the file yet: its first checkpoint is written completely or not at all.
    is_first: bool,
    /// True once the records accepted before a relocation was requested are in the file.
    committed_for_relocation: bool,
    watch: FileWatch,
    /// Newest tile version of the checkpoint in the file.
    saved_version: u64,
    last_commit: Instant,
    checkpoint: Retry,
    journal: Retry,
    file: Retry,
}

/// Failure of the last write of one kind, and when to retry.
#[derive(Default)]
struct Retry {
    failed: Option<Instant>,
    /// True if it failed on closing, when nothing is retried.
    given_up: bool,
}

impl Retry {
    fn is_due(&self, hurry: bool) -> bool {
        let waits = self.failed.is_some_and(|when| when.elapsed() < RETRY_DELAY);
        !self.given_up && (hurry || !waits)
    }
}

/// Next work of the thread.
enum Work {
    Fetch,
    Checkpoint(Box<Checkpoint>),
    Shown(Vec<ShownTile>),
    Commit(Vec<Record>),
    Relocate(RelocateRequest),
    /// Check of the files alone.
    CheckFiles,
    Close,
}

impl DocumentThread {
    /// Thread for a file that has the tile versions up to `saved_version`; without `writes` it only reads.
    pub(crate) fn new(
        shared: Arc<Shared>,
        (database, path): (Database, &Path),
        writes: bool,
        saved_version: u64,
    ) -> Self {
        Self {
            shared,
            database,
            path: path.to_owned(),
            writes,
            is_first: false,
            committed_for_relocation: false,
            watch: FileWatch::new(path),
            saved_version,
            last_commit: Instant::now(),
            checkpoint: Retry::default(),
            journal: Retry::default(),
            file: Retry::default(),
        }
    }

    /// Thread for a painting of which nothing is in the file yet.
    pub(crate) fn for_first_checkpoint(self) -> Self {
        Self {
            is_first: true,
            ..self
        }
    }

    /// Relocates the painting and continues there, or at its old path if that fails.
    ///
    /// # Errors
    /// If the painting cannot continue in either file.
    fn relocate(mut self, request: RelocateRequest) -> Result<Self, DocumentError> {
        self.committed_for_relocation = false;
        if request.how == Relocate::Leave {
            let copied = relocate::rescue(&self.database, &request.to, request.replace);
            request.answer.send(copied).ok();
            return Ok(self);
        }
        let open = |path: &Path| match is_new(path)? {
            // SQLite would create a blank one.
            true => Err(DocumentError::Missing),
            false => Database::open(path, Access::Paint, None).map(|(database, _)| database),
        };
        if let FileState::Gone(_) = self.watch.check() {
            let rescued = relocate::rescue(&self.database, &request.to, request.replace)
                .and_then(|()| self.continue_in(&request.to));
            request.answer.send(rescued).ok();
            return Ok(self);
        }
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

    /// Serves until the document is closed.
    ///
    /// # Errors
    /// The reason why data could not be written.
    pub(crate) fn run(mut self) -> Result<(), DocumentError> {
        let _guard = EndGuard(Arc::clone(&self.shared));
        loop {
            let work = self.next();
            if self.writes && !matches!(work, Work::Fetch) {
                let hurry = matches!(work, Work::Close);
                self.check_files(hurry);
            }
            match work {
                Work::CheckFiles => {}
                Work::Fetch => serve_fetches(&self.shared, &self.database),
                Work::Checkpoint(checkpoint) => self.write_checkpoint(*checkpoint),
                Work::Shown(tiles) => self.write_shown(&tiles),
                Work::Commit(records) => self.commit(records),
                Work::Relocate(request) => self = self.relocate(request)?,
                Work::Close => break,
            }
        }
        let (fault, left, broken) = {
            let queues = self.shared.lock();
            let left = queues.checkpoint.is_some() || !queues.records.is_empty();
            (queues.fault_text(), left, queues.broken.clone())
        };
        if self.file.failed.is_some() {
            self.database.abandon();
            return Err(DocumentError::Unwritten(fault));
        }
        if broken.is_some() || !self.writes {
            // A reader changes nothing, and the journal of a damaged file may hold rows to recover.
            self.database.close_unchanged()?;
            return match left {
                true => Err(DocumentError::Damaged(broken.unwrap_or(fault))),
                false => Ok(()),
            };
        }
        self.database.close()?;
        match left && !fault.is_empty() {
            true => Err(DocumentError::Unwritten(fault)),
            false => Ok(()),
        }
    }

    /// Waits for the most urgent work.
    fn next(&mut self) -> Work {
        let mut queues = self.shared.lock();
        loop {
            if !queues.fetches.is_empty() {
                return Work::Fetch;
            }
            let may_write = self.writes && queues.broken.is_none();
            let closing = queues.life == Life::Closing;
            let hurry = closing || !queues.flushes.is_empty() || !queues.relocations.is_empty();
            let due = hurry || self.last_commit.elapsed() >= COMMIT_PERIOD;
            let commits =
                may_write && due && self.journal.is_due(hurry) && !queues.records.is_empty();
            // A checkpoint includes the records, but needs more room on the disk than they do.
            if commits && self.checkpoint.failed.is_some() {
                return Work::Commit(std::mem::take(&mut queues.records));
            }
            if may_write
                && self.checkpoint.is_due(hurry)
                && let Some(checkpoint) = queues.checkpoint.take()
            {
                queues.writing = true;
                return Work::Checkpoint(Box::new(checkpoint));
            }
            // New records come all the time while somebody paints: one commit is enough.
            if may_write
                && (queues.records.is_empty() || self.committed_for_relocation)
                && let Some(request) = queues.relocations.pop()
            {
                return Work::Relocate(request);
            }
            if commits {
                self.committed_for_relocation = !queues.relocations.is_empty();
                return Work::Commit(std::mem::take(&mut queues.records));
            }
            if may_write && self.checkpoint.failed.is_none() {
                // Displayed tiles of a later checkpoint wait for that.
                let saved = self.saved_version;
                let ready = queues.shown.extract_if(.., |_, tile| tile.version <= saved);
                let tiles: Vec<ShownTile> = ready.take(SHOWN_BATCH).map(|(_, tile)| tile).collect();
                if !tiles.is_empty() {
                    return Work::Shown(tiles);
                }
            }
            // A painting that is only read is not relocated.
            queues.relocations.clear();
            for waits in queues.flushes.drain(..) {
                // The waiting thread may have given up.
                waits.send(()).ok();
            }
            if closing {
                return Work::Close;
            }
            let waits = may_write && self.journal.is_due(false) && !queues.records.is_empty();
            let wait = match waits {
                true => COMMIT_PERIOD.saturating_sub(self.last_commit.elapsed()),
                false => RETRY_DELAY,
            };
            let waited = self
                .shared
                .wake
                .wait_timeout(queues, wait.max(Duration::from_millis(1)));
            let timed_out;
            (queues, timed_out) = waited.unwrap_or_else(PoisonError::into_inner);
            if self.writes && timed_out.timed_out() {
                return Work::CheckFiles;
            }
        }
    }

    /// Runs `write` in a transaction, which is rolled back if it fails.
    fn transaction<T>(
        &self,
        write: impl FnOnce(&Database) -> Result<T, DocumentError>,
    ) -> Result<T, DocumentError> {
        let connection = &self.database.connection;
        connection.execute_batch("BEGIN IMMEDIATE")?;
        let written = write(&self.database).and_then(|written| {
            connection.execute_batch("COMMIT")?;
            Ok(written)
        });
        if written.is_err() && !connection.is_autocommit() {
            connection.execute_batch("ROLLBACK").ok();
        }
        written
    }

    /// Writes displayed tiles. Those that cannot be written are drawn again on demand.
    fn write_shown(&self, tiles: &[ShownTile]) {
        let shared = Arc::clone(&self.shared);
        let written = self.transaction(|database| {
            let mut yield_hook = |database: &Database| serve_fetches(&shared, database);
            Writer::new(database, &mut yield_hook).write_shown(tiles)
        });
        if let Err(error) = written {
            tracing::warn!("displayed tiles are not saved: {error}");
        }
    }

    fn write_checkpoint(&mut self, mut checkpoint: Checkpoint) {
        let shared = Arc::clone(&self.shared);
        let serial = checkpoint.sequencer.serial;
        let mut overtaken = Vec::new();
        let written = loop {
            let mut queues = shared.lock();
            let before = queues.records.iter();
            let before = before.take_while(|record| record.serial < serial).count();
            overtaken.extend(queues.records.drain(..before));
            drop(queues);
            overtaken.append(&mut checkpoint.records);
            let longest = if self.is_first {
                FIRST_CHECKPOINT
            } else {
                COMMIT_PERIOD
            };
            let until = Instant::now() + longest;
            let written = self.transaction(|database| {
                let mut yield_hook = |database: &Database| serve_fetches(&shared, database);
                Writer::new(database, &mut yield_hook).checkpoint(&checkpoint, &overtaken, until)
            });
            match written {
                // Records accepted meanwhile do not wait for the remaining pages.
                Ok((stored, false)) => {
                    stored.mark();
                    let mut records = std::mem::take(&mut overtaken);
                    records.append(&mut self.shared.lock().records);
                    self.commit(records);
                }
                Ok((stored, true)) => break Ok(stored),
                Err(error) => break Err(error),
            }
        };
        let mut queues = self.shared.lock();
        queues.writing = false;
        match written {
            Ok(stored) => {
                stored.mark();
                self.is_first = false;
                self.saved_version = checkpoint.painting.kept.versions;
                // The next look is at the next checkpoint.
                self.shared.record_bytes.store(
                    record::bytes_after(&self.database, &checkpoint.record),
                    SeqCst,
                );
                self.shared
                    .committed
                    .fetch_max(checkpoint.sequencer.next, SeqCst);
                drop(queues);
                self.note_written(Part::Checkpoint);
            }
            Err(error) => {
                overtaken.append(&mut queues.records);
                queues.records = overtaken;
                queues.checkpoint = Some(checkpoint);
                drop(queues);
                self.note_failure(Part::Checkpoint, &error);
            }
        }
    }

    fn commit(&mut self, records: Vec<Record>) {
        let Some(last) = records.last() else {
            return;
        };
        let written = self.transaction(|database| {
            records
                .chunks(journal::ROW_RECORDS)
                .try_for_each(|row| journal::put(database, row))
        });
        self.last_commit = Instant::now();
        match written {
            Ok(()) => {
                self.shared.committed.fetch_max(last.next(), SeqCst);
                self.note_written(Part::Journal);
            }
            Err(error) => {
                let mut queues = self.shared.lock();
                let later = std::mem::replace(&mut queues.records, records);
                queues.records.extend(later);
                drop(queues);
                self.note_failure(Part::Journal, &error);
            }
        }
    }

    fn note_written(&mut self, part: Part) {
        let failed = self.retry(part).failed.take().is_some();
        let all = [&self.checkpoint, &self.journal, &self.file];
        if failed && all.iter().all(|part| part.failed.is_none()) {
            tracing::info!("the painting is written again");
            let mut queues = self.shared.lock();
            if queues.broken.is_none() {
                queues.fault = None;
            }
        }
    }

    fn note_failure(&mut self, part: Part, error: &DocumentError) {
        let mut queues = self.shared.lock();
        if queues.fault.is_none() {
            tracing::error!(
                "the painting cannot be written: {error}; {}",
                error.advice()
            );
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
        }
    }
}

/// Part of the file whose writes fail and are retried together.
#[derive(Clone, Copy)]
enum Part {
    Checkpoint,
    Journal,
    File,
}

/// Processor time of this thread.
fn thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    now.map_or(Duration::ZERO, Duration::from)
}

/// Reads the pages that readers wait for.
fn serve_fetches(shared: &Shared, database: &Database) {
    let fetches = std::mem::take(&mut shared.lock().fetches);
    if fetches.is_empty() {
        return;
    }
    let begun = thread_cpu();
    let broken = |error: DocumentError| {
        let mut queues = shared.lock();
        queues.fault = Some((error.to_string(), error.advice()));
        let what = match error {
            DocumentError::Damaged(what) => what,
            error => error.to_string(),
        };
        queues.broken = Some(what.clone());
        what
    };
    for fetch in fetches {
        match fetch {
            Fetch::Planes(id, answer) => answer
                .send(database.planes(id).map_err(broken))
                .unwrap_or(()),
            Fetch::Load(id, answer) => answer.send(database.load(id).map_err(broken)).unwrap_or(()),
            Fetch::Records(serial, answer) => {
                answer
                    .send(record::row_from(database, serial))
                    .unwrap_or(());
            }
            Fetch::Shown([place, version, look], answer) => {
                answer
                    .send(database.shown(place, version, look))
                    .unwrap_or(());
            }
        }
    }
    let spent = thread_cpu().saturating_sub(begun);
    shared.page_in_ns.fetch_add(spent.as_nanos() as u64, SeqCst);
}
