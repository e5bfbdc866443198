//! An open painting with the thread that owns its file.
//!
//! The painter's thread only hands over: what was accepted, and moments of the painting. Here they are
//! written, and pages that left memory are read; who waits for a page comes first.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, PoisonError, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use maulstick_paint::page::Pager;
use maulstick_paint::sequencer::Record;

use crate::database::{Access, Database};
use crate::error::DocumentError;
use crate::journal;
use crate::opening::{Opened, opened};
use crate::queues::{End, Fetch, Life, Pages, Shared, Shelf};
use crate::writing::{Moment, ShownTile, Writer};

/// Accepted things are in the file after this long.
const COMMIT: Duration = Duration::from_millis(100);
/// What could not be written is tried again after this long.
const AGAIN: Duration = Duration::from_secs(1);
/// Tiles as they are shown of a moment, at most.
const SHOWN: usize = 128;
/// Accepted things of a row of the journal, at most: many wait where the disk was full.
const ROW: usize = 1024;

/// How a document is opened.
#[derive(Clone, Debug)]
pub struct DocumentSettings {
    /// The file.
    pub path: PathBuf,
    /// What for.
    pub access: Access,
    /// Most bytes of pages in memory.
    pub memory: usize,
    /// Name of SQLite's way to the file, if not the usual one.
    pub vfs: Option<String>,
}

impl DocumentSettings {
    /// A file opened for this, with 1 GiB of memory.
    #[must_use]
    pub fn new(path: &Path, access: Access) -> Self {
        Self {
            path: path.to_owned(),
            access,
            memory: 1 << 30,
            vfs: None,
        }
    }
}

/// An open painting.
pub struct Document {
    path: PathBuf,
    shared: Arc<Shared>,
    pager: Arc<Pager>,
    thread: Option<JoinHandle<Result<(), DocumentError>>>,
}

impl Document {
    /// Opens a painting, or begins one: then there is nothing opened.
    ///
    /// # Errors
    /// Any [`DocumentError`]; the file is as it was.
    pub fn open(settings: &DocumentSettings) -> Result<(Self, Option<Opened>), DocumentError> {
        let vfs = settings.vfs.as_deref();
        let (database, new) = Database::open(&settings.path, settings.access, vfs)?;
        let shared: Arc<Shared> = Arc::default();
        let backing = Arc::new(Pages(Arc::clone(&shared)));
        let (pager, found) = match content(&database, new, backing, settings.memory) {
            Ok(content) => content,
            Err(error) => {
                database.leave().ok();
                return Err(error);
            }
        };
        if let Some(found) = &found {
            shared.committed.store(found.index(), SeqCst);
        }
        let thread = Thread {
            shared: Arc::clone(&shared),
            database,
            writes: settings.access == Access::Paint,
            last_commit: Instant::now(),
            moment: Tries::default(),
            journal: Tries::default(),
        };
        let thread = std::thread::Builder::new()
            .name("document".into())
            .spawn(move || thread.run())?;
        let document = Self {
            path: settings.path.clone(),
            shared,
            pager,
            thread: Some(thread),
        };
        Ok((document, found))
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The pages of the painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.pager
    }

    /// Tiles as they were shown.
    #[must_use]
    pub fn shelf(&self) -> Shelf {
        Shelf(Arc::clone(&self.shared))
    }

    /// Hands over what was accepted; it is in the file within a tenth of a second.
    pub fn record(&self, records: Vec<Record>) {
        if !records.is_empty() {
            self.shared.lock().records.extend(records);
            self.shared.bell.notify_all();
        }
    }

    /// Whether the last moment is written, so that the next one can be handed over.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        let queues = self.shared.lock();
        queues.moment.is_none() && !queues.writing
    }

    /// Hands a moment over. It has to hold all records that were handed over before, and the one
    /// before it has to be written ([`is_ready`](Self::is_ready)).
    pub fn keep(&self, moment: Moment) {
        self.shared.lock().moment = Some(moment);
        self.shared.bell.notify_all();
    }

    /// The journal entries below this index are in the file.
    #[must_use]
    pub fn committed(&self) -> u64 {
        self.shared.committed.load(SeqCst)
    }

    /// Time of the processor that was spent on reading pages.
    #[must_use]
    pub fn page_in_cpu(&self) -> Duration {
        Duration::from_nanos(self.shared.page_in_ns.load(SeqCst))
    }

    /// Why nothing is written at present, and what to do about it; none where all is well.
    #[must_use]
    pub fn fault(&self) -> Option<(String, &'static str)> {
        let queues = self.shared.lock();
        (!queues.fault.is_empty()).then(|| (queues.fault.clone(), queues.help))
    }

    /// Waits until all that was handed over is written, or could not be.
    pub fn flush(&self) {
        let (send, receive) = mpsc::channel();
        {
            let mut queues = self.shared.lock();
            if queues.life == Life::Ended {
                return;
            }
            queues.flushes.push(send);
        }
        self.shared.bell.notify_all();
        receive.recv().ok();
    }

    /// Writes what was handed over, folds the journal in and closes the file.
    ///
    /// # Errors
    /// Why something could not be written.
    pub fn close(mut self) -> Result<(), DocumentError> {
        self.end()
    }

    fn end(&mut self) -> Result<(), DocumentError> {
        {
            let mut queues = self.shared.lock();
            if queues.life == Life::Open {
                queues.life = Life::Closing;
            }
        }
        self.shared.bell.notify_all();
        match self.thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(ended)) => ended,
            Some(Err(_)) => Err(DocumentError::Other("its thread has fallen".to_owned())),
        }
    }
}

impl Drop for Document {
    fn drop(&mut self) {
        if let Err(error) = self.end() {
            tracing::error!("{}: {error}", self.path.display());
        }
    }
}

impl std::fmt::Debug for Document {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Document").field(&self.path).finish()
    }
}

/// The pages of a painting, and what it is; nothing where it is to be begun.
fn content(
    database: &Database,
    new: bool,
    backing: Arc<Pages>,
    memory: usize,
) -> Result<(Arc<Pager>, Option<Opened>), DocumentError> {
    // A painting that was begun, and not a second of it kept, begins anew.
    if new || !crate::opening::has_state(database)? {
        return Ok((Pager::backed(backing, memory, 1), None));
    }
    let pager = Pager::backed(backing, memory, crate::opening::next_page(database)?);
    let found = opened(database, &pager)?;
    Ok((pager, Some(found)))
}

/// The document's thread.
struct Thread {
    shared: Arc<Shared>,
    database: Database,
    writes: bool,
    last_commit: Instant,
    moment: Tries,
    journal: Tries,
}

/// How writing goes.
#[derive(Default)]
struct Tries {
    failed: Option<Instant>,
    /// On closing nothing is tried twice.
    given_up: bool,
}

impl Tries {
    fn may(&self, hurry: bool) -> bool {
        let rests = self.failed.is_some_and(|when| when.elapsed() < AGAIN);
        !self.given_up && (hurry || !rests)
    }
}

/// What the thread does next.
enum Work {
    Fetch,
    Keep(Box<Moment>, Vec<ShownTile>),
    Commit(Vec<Record>),
    Close,
}

impl Thread {
    fn run(mut self) -> Result<(), DocumentError> {
        let _end = End(Arc::clone(&self.shared));
        loop {
            match self.next() {
                Work::Fetch => serve(&self.shared, &self.database),
                Work::Keep(moment, shown) => self.keep(*moment, shown),
                Work::Commit(records) => self.commit(records),
                Work::Close => break,
            }
        }
        let (fault, left, broken) = {
            let queues = self.shared.lock();
            let left = queues.moment.is_some() || !queues.records.is_empty();
            (queues.fault.clone(), left, queues.broken)
        };
        if broken {
            // Its journal may hold what is to be recovered.
            self.database.leave()?;
            let what = fault.trim_start_matches("the painting is damaged: ");
            return match left {
                true => Err(DocumentError::Damaged(what.to_owned())),
                false => Ok(()),
            };
        }
        self.database.close()?;
        match left && !fault.is_empty() {
            true => Err(DocumentError::Unwritten(fault)),
            false => Ok(()),
        }
    }

    fn next(&mut self) -> Work {
        let mut queues = self.shared.lock();
        loop {
            if !queues.fetches.is_empty() {
                return Work::Fetch;
            }
            let may_write = self.writes && !queues.broken;
            let closing = queues.life == Life::Closing;
            let hurry = closing || !queues.flushes.is_empty();
            let due = hurry || self.last_commit.elapsed() >= COMMIT;
            let commits = may_write && due && self.journal.may(hurry) && !queues.records.is_empty();
            // A moment holds what was accepted, but may find no room where that still has some.
            if commits && self.moment.failed.is_some() {
                return Work::Commit(std::mem::take(&mut queues.records));
            }
            if may_write
                && self.moment.may(hurry)
                && let Some(moment) = queues.moment.take()
            {
                queues.writing = true;
                // What shows a later moment waits for that.
                let newest = moment.painting.kept.versions;
                let ready = queues
                    .shown
                    .extract_if(.., |_, tile| tile.version <= newest);
                let shown = ready.take(SHOWN).map(|(_, tile)| tile).collect();
                return Work::Keep(Box::new(moment), shown);
            }
            if commits {
                return Work::Commit(std::mem::take(&mut queues.records));
            }
            for waits in queues.flushes.drain(..) {
                // Who waited may have given up.
                waits.send(()).ok();
            }
            if closing {
                return Work::Close;
            }
            let waits = may_write && self.journal.may(false) && !queues.records.is_empty();
            let wait = match waits {
                true => COMMIT.saturating_sub(self.last_commit.elapsed()),
                false => AGAIN,
            };
            let waited = self
                .shared
                .bell
                .wait_timeout(queues, wait.max(Duration::from_millis(1)));
            (queues, _) = waited.unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Runs `write` in a transaction; nothing of it stays where it fails.
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

    fn keep(&mut self, moment: Moment, shown: Vec<ShownTile>) {
        let shared = Arc::clone(&self.shared);
        let written = loop {
            let until = Instant::now() + COMMIT;
            let written = self.transaction(|database| {
                let mut breathe = |database: &Database| serve(&shared, database);
                Writer::new(database, &mut breathe).moment(&moment, &shown, until)
            });
            match written {
                // What is accepted meanwhile does not wait for the rest.
                Ok((stored, false)) => {
                    stored.note();
                    let records = std::mem::take(&mut self.shared.lock().records);
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
                stored.note();
                let serial = moment.sequencer.serial;
                queues.records.retain(|record| record.serial >= serial);
                self.shared
                    .committed
                    .fetch_max(moment.sequencer.next, SeqCst);
                drop(queues);
                self.well(Part::Moment);
            }
            Err(error) => {
                queues.moment = Some(moment);
                drop(queues);
                self.ill(Part::Moment, &error);
            }
        }
    }

    fn commit(&mut self, records: Vec<Record>) {
        let Some(last) = records.last() else {
            return;
        };
        let written = self.transaction(|database| {
            records
                .chunks(ROW)
                .try_for_each(|row| journal::put(database, row))
        });
        self.last_commit = Instant::now();
        match written {
            Ok(()) => {
                self.shared.committed.fetch_max(last.next(), SeqCst);
                self.well(Part::Journal);
            }
            Err(error) => {
                let mut queues = self.shared.lock();
                let later = std::mem::replace(&mut queues.records, records);
                queues.records.extend(later);
                drop(queues);
                self.ill(Part::Journal, &error);
            }
        }
    }

    fn well(&mut self, part: Part) {
        let failed = self.tries(part).failed.take().is_some();
        if failed && self.moment.failed.is_none() && self.journal.failed.is_none() {
            tracing::info!("the painting is written again");
            let mut queues = self.shared.lock();
            if !queues.broken {
                queues.fault.clear();
            }
        }
    }

    fn ill(&mut self, part: Part, error: &DocumentError) {
        let mut queues = self.shared.lock();
        if queues.fault.is_empty() {
            tracing::error!("the painting cannot be written: {error}; {}", error.help());
        }
        (queues.fault, queues.help) = (error.to_string(), error.help());
        let closing = queues.life == Life::Closing;
        // Who waits would wait for ever.
        queues.flushes.clear();
        drop(queues);
        *self.tries(part) = Tries {
            failed: Some(Instant::now()),
            given_up: closing,
        };
    }

    fn tries(&mut self, part: Part) -> &mut Tries {
        match part {
            Part::Moment => &mut self.moment,
            Part::Journal => &mut self.journal,
        }
    }
}

/// What is written.
#[derive(Clone, Copy)]
enum Part {
    Moment,
    Journal,
}

/// Time of the processor that this thread has had.
fn thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    now.map_or(Duration::ZERO, Duration::from)
}

/// Reads what is waited for.
fn serve(shared: &Shared, database: &Database) {
    let fetches = std::mem::take(&mut shared.lock().fetches);
    if fetches.is_empty() {
        return;
    }
    let begun = thread_cpu();
    let broken = |error: DocumentError| {
        let mut queues = shared.lock();
        queues.broken = true;
        (queues.fault, queues.help) = (error.to_string(), error.help());
        match error {
            DocumentError::Damaged(what) => what,
            error => error.to_string(),
        }
    };
    for fetch in fetches {
        match fetch {
            Fetch::Planes(id, answer) => answer
                .send(database.planes(id).map_err(broken))
                .unwrap_or(()),
            Fetch::Load(id, answer) => answer.send(database.load(id).map_err(broken)).unwrap_or(()),
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
