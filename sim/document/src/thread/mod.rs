//! Thread that owns a painting's file: it writes the data handed over and reads pages that left memory. Readers that
//! wait for a page come first.

mod failures;
mod missing_file;
pub(crate) mod queues;
mod reading;
mod relocating;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use maulstick_canvas::page::Page;
use maulstick_canvas::planes::Planes;
use maulstick_painting::sequencer::Record;

use failures::{Part, Retry};
use queues::{EndGuard, Life, Queues, Shared};
use reading::yield_to_readers;

use crate::checkpoint::Checkpoint;
use crate::error::DocumentError;
use crate::file::database::Database;
use crate::file::relocate::RelocateRequest;
use crate::file::watch::FileWatch;
use crate::journal;
use crate::record;
use crate::writing::{ShownTile, Stored, Trust, Writer};

/// Longest time until an accepted record is in the file.
const COMMIT_PERIOD: Duration = Duration::from_millis(100);
/// Longest duration of the first checkpoint of a painting that was in memory alone, which is one transaction.
const FIRST_CHECKPOINT: Duration = Duration::from_secs(3600);
/// Delay before a failed write is retried.
const RETRY_DELAY: Duration = Duration::from_secs(1);
/// Delay before a failed read is retried.
const REREAD_DELAY: Duration = Duration::from_millis(100);
/// Largest number of displayed tiles in one transaction.
const SHOWN_BATCH: usize = 128;

/// The document's thread.
pub(crate) struct DocumentThread {
    shared: Arc<Shared>,
    database: Database,
    path: PathBuf,
    writes: bool,
    content: Content,
    /// True once the records accepted before a relocation was requested are in the file.
    committed_for_relocation: bool,
    watch: FileWatch,
    /// Newest tile version of the checkpoint in the file.
    saved_version: u64,
    last_commit: Instant,
    checkpoint: Retry,
    journal: Retry,
    file: Retry,
    reading: Retry,
    /// Unread pages of the current painting, which are read in idle time, so that painting can continue on a disk that
    /// fails later.
    to_read_ahead: Vec<Page<Planes>>,
}

/// Content of the file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Content {
    /// None of the painting: its first checkpoint is written completely or not at all.
    Nothing,
    /// Checkpoints, some of which are in SQLite's journal beside the file.
    Unmerged,
    /// A checkpoint that can be read without the journal.
    Merged,
}

/// Next work of the thread.
enum Work {
    Fetch,
    Checkpoint(Box<Checkpoint>),
    Shown(Vec<ShownTile>),
    Commit(Vec<Record>),
    Relocate(RelocateRequest),
    /// Page without a waiting reader.
    Read(Page<Planes>),
    /// Check of the files alone.
    CheckFiles,
    Close,
}

/// Rows that the writer of a checkpoint assumes to be in the file; `None` if the checkpoint is superfluous.
fn trust_for(checkpoint: &Checkpoint, queues: &mut Queues) -> Option<Trust> {
    if !queues.wants_all {
        Some(Trust::Stored)
    } else if checkpoint.is_whole {
        Some(Trust::Nothing)
    } else {
        // It was handed over before: its contents are in the whole one, which comes next.
        queues.writing = false;
        None
    }
}

impl DocumentThread {
    /// Thread for a file with the tile versions up to `saved_version`; without `writes` it only reads.
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
            content: Content::Unmerged,
            committed_for_relocation: false,
            watch: FileWatch::new(path),
            saved_version,
            last_commit: Instant::now(),
            checkpoint: Retry::default(),
            journal: Retry::default(),
            file: Retry::default(),
            reading: Retry::default(),
            to_read_ahead: Vec::new(),
        }
    }

    /// Reads these pages in idle time.
    pub(crate) fn reading_ahead(self, to_read_ahead: Vec<Page<Planes>>) -> Self {
        Self {
            to_read_ahead,
            ..self
        }
    }

    /// Thread for a painting that is not in the file yet.
    pub(crate) fn for_first_checkpoint(self) -> Self {
        Self {
            content: Content::Nothing,
            ..self
        }
    }

    /// Serves until the document is closed.
    ///
    /// # Errors
    /// The reason why data could not be written.
    pub(crate) fn run(mut self) -> Result<(), DocumentError> {
        let _guard = EndGuard(Arc::clone(&self.shared));
        loop {
            let work = self.next();
            if self.writes && !matches!(work, Work::Fetch | Work::Read(_)) {
                let hurry = matches!(work, Work::Close);
                self.check_files(hurry);
            }
            match work {
                Work::CheckFiles => {}
                Work::Fetch => self.read_pages(),
                Work::Read(page) => self.read_ahead(&page),
                Work::Checkpoint(checkpoint) => self.write_checkpoint(*checkpoint),
                Work::Shown(tiles) => self.write_shown(&tiles),
                Work::Commit(records) => self.commit(records),
                Work::Relocate(request) => self = self.relocate(request)?,
                Work::Close => break,
            }
            self.watch.note_sizes();
        }
        let (fault, left, broken, wants_all) = {
            let queues = self.shared.lock();
            let left = queues.checkpoint.is_some() || !queues.records.is_empty();
            let (broken, wants_all) = (queues.broken.clone(), queues.wants_all);
            (queues.fault_text(), left || wants_all, broken, wants_all)
        };
        if self.file.failed.is_some() {
            self.database.abandon();
            return Err(DocumentError::Unwritten(fault));
        }
        if broken.is_some() || !self.writes {
            // A reader changes nothing, and the journal of a damaged file may hold rows to recover.
            self.database.close_unchanged()?;
            return if left {
                Err(DocumentError::Damaged(broken.unwrap_or(fault)))
            } else {
                Ok(())
            };
        }
        self.database.close()?;
        if left && !fault.is_empty() {
            Err(DocumentError::Unwritten(fault))
        } else if wants_all {
            // The missing parts were in memory alone.
            Err(DocumentError::Incomplete(self.path))
        } else {
            Ok(())
        }
    }

    /// Waits for the most urgent work.
    fn next(&mut self) -> Work {
        let shared = Arc::clone(&self.shared);
        let mut queues = shared.lock();
        loop {
            let closing = queues.life == Life::Closing;
            let may_retry = closing || self.reading.has_waited(REREAD_DELAY);
            if !queues.failed_fetches.is_empty() && may_retry {
                let mut failed = std::mem::take(&mut queues.failed_fetches);
                queues.retried.append(&mut failed);
            }
            if !(queues.fetches.is_empty() && queues.retried.is_empty()) {
                return Work::Fetch;
            }
            let may_write = self.writes && queues.broken.is_none();
            if may_write && let Some(work) = self.next_write(&mut queues, closing) {
                return work;
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
            if self.reading.failed.is_none()
                && queues.broken.is_none()
                && let Some(page) = self.to_read_ahead.pop()
            {
                return Work::Read(page);
            }
            let waits = may_write
                && !queues.wants_all
                && self.journal.is_due(false)
                && !queues.records.is_empty();
            let wait = if waits {
                COMMIT_PERIOD.saturating_sub(self.last_commit.elapsed())
            } else if queues.failed_fetches.is_empty() {
                RETRY_DELAY
            } else {
                REREAD_DELAY
            };
            let waited = shared
                .wake
                .wait_timeout(queues, wait.max(Duration::from_millis(1)));
            let timed_out;
            (queues, timed_out) = waited.unwrap_or_else(PoisonError::into_inner);
            if self.writes && timed_out.timed_out() {
                return Work::CheckFiles;
            }
        }
    }

    /// The most urgent write that is due.
    fn next_write(&mut self, queues: &mut Queues, closing: bool) -> Option<Work> {
        let hurry = closing || !queues.flushes.is_empty() || !queues.relocations.is_empty();
        let due = hurry || self.last_commit.elapsed() >= COMMIT_PERIOD;
        // A file that lacks a part of the painting first gets all of it.
        let is_whole = !queues.wants_all;
        let commits = is_whole && due && self.journal.is_due(hurry) && !queues.records.is_empty();
        // A checkpoint includes the records, but needs more room on the disk than they do.
        if commits && self.checkpoint.failed.is_some() {
            return Some(Work::Commit(std::mem::take(&mut queues.records)));
        }
        if self.checkpoint.is_due(hurry)
            && let Some(checkpoint) = queues.checkpoint.take()
        {
            queues.writing = true;
            return Some(Work::Checkpoint(Box::new(checkpoint)));
        }
        // New records arrive all the time during painting, so one commit suffices. A file that lacks a part of the
        // painting takes none, and is not relocated, which is answered at once.
        if (queues.records.is_empty() || self.committed_for_relocation || !is_whole)
            && let Some(request) = queues.relocations.pop()
        {
            return Some(Work::Relocate(request));
        }
        if commits {
            self.committed_for_relocation = !queues.relocations.is_empty();
            return Some(Work::Commit(std::mem::take(&mut queues.records)));
        }
        if !is_whole || self.checkpoint.failed.is_some() {
            return None;
        }
        // Displayed tiles of a later checkpoint wait for that.
        let saved = self.saved_version;
        let ready = queues.shown.extract_if(.., |_, tile| tile.version <= saved);
        let tiles: Vec<ShownTile> = ready.take(SHOWN_BATCH).map(|(_, tile)| tile).collect();
        (!tiles.is_empty()).then_some(Work::Shown(tiles))
    }

    /// Runs `write` in a transaction, which is rolled back if it fails.
    fn transaction<T>(
        &self,
        write: impl FnOnce(&Database) -> Result<T, DocumentError>,
    ) -> Result<T, DocumentError> {
        let connection = &self.database.connection;
        let begun = connection.execute_batch("BEGIN IMMEDIATE");
        let written = begun.map_err(DocumentError::from).and_then(|()| {
            let written = write(&self.database)?;
            connection.execute_batch("COMMIT")?;
            Ok(written)
        });
        if written.is_err() && !connection.is_autocommit() {
            connection.execute_batch("ROLLBACK").ok();
        }
        written.map_err(|error| self.database.judged(error))
    }

    /// Writes displayed tiles. Those that cannot be written are drawn again on demand.
    fn write_shown(&self, tiles: &[ShownTile]) {
        let shared = Arc::clone(&self.shared);
        let written = self.transaction(|database| {
            let mut yield_hook = |database: &Database| yield_to_readers(&shared, database);
            Writer::new(database, &mut yield_hook).write_shown(tiles)
        });
        if let Err(error) = written {
            tracing::warn!("displayed tiles are not saved: {error}");
        }
    }

    fn write_checkpoint(&mut self, mut checkpoint: Checkpoint) {
        let shared = Arc::clone(&self.shared);
        let Some(trust) = trust_for(&checkpoint, &mut shared.lock()) else {
            return;
        };
        let serial = checkpoint.sequencer.serial;
        let mut overtaken = Vec::new();
        let written = loop {
            overtaken.extend(self.take_records_before(serial));
            overtaken.append(&mut checkpoint.records);
            let longest = if self.content == Content::Nothing || trust == Trust::Nothing {
                FIRST_CHECKPOINT
            } else {
                COMMIT_PERIOD
            };
            let until = Instant::now() + longest;
            match self.write_pages(&checkpoint, trust, &overtaken, until) {
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
                queues.wants_all = false;
                stored.mark();
                self.saved_version = checkpoint.painting.kept.versions;
                // It is read again at the next checkpoint.
                self.shared.record_bytes.store(
                    record::bytes_after(&self.database, &checkpoint.record),
                    SeqCst,
                );
                self.shared
                    .committed
                    .fetch_max(checkpoint.sequencer.next, SeqCst);
                drop((queues, checkpoint));
                if std::mem::replace(&mut self.content, Content::Merged) != Content::Merged {
                    self.database.merge_journal();
                    self.watch.note_merged();
                }
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

    /// Takes the records that were accepted before a number.
    fn take_records_before(&self, serial: u64) -> Vec<Record> {
        let mut queues = self.shared.lock();
        let before = queues.records.iter();
        let before = before.take_while(|record| record.serial < serial).count();
        queues.records.drain(..before).collect()
    }

    /// Writes a checkpoint, with `records` that were accepted before it, in a transaction. If its pages take longer than
    /// `until`, only some of them are written, and false is returned.
    fn write_pages(
        &self,
        checkpoint: &Checkpoint,
        trust: Trust,
        records: &[Record],
        until: Instant,
    ) -> Result<(Stored, bool), DocumentError> {
        let shared = Arc::clone(&self.shared);
        self.transaction(|database| {
            let mut yield_hook = |database: &Database| yield_to_readers(&shared, database);
            let mut writer = Writer::new(database, &mut yield_hook).trusting(trust);
            let is_whole = writer.checkpoint(checkpoint, until)?;
            if is_whole {
                record::advance(&mut writer, checkpoint, records)?;
            }
            Ok((writer.stored(), is_whole))
        })
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
}
