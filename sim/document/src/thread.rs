//! The thread that owns a painting's file: it writes the data handed over and reads pages that left memory. Readers
//! that wait for a page come first.

mod file;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use maulstick_painting::sequencer::Record;

use crate::database::{Access, Database, is_new};
use crate::error::DocumentError;
use crate::journal;
use crate::moving::{self, Move};
use crate::queues::{End, Fetch, Life, Shared};
use crate::watch::{Found, Watch};
use crate::writing::{Moment, ShownTile, Writer};

/// Accepted things are in the file after this long.
const COMMIT: Duration = Duration::from_millis(100);
/// The first moment of a painting that was in memory alone is one transaction, if it does not take longer.
const FIRST: Duration = Duration::from_secs(3600);
/// Delay before a failed write is tried again.
const AGAIN: Duration = Duration::from_secs(1);
/// Tiles as they are shown that are written in one transaction, at most.
const SHOWN: usize = 128;
/// Accepted things of a row of the journal, at most: many wait where the disk was full.
const ROW: usize = 1024;

/// The document's thread.
pub(crate) struct Thread {
    shared: Arc<Shared>,
    database: Database,
    /// The painting's file.
    path: PathBuf,
    writes: bool,
    /// Nothing of the painting is in the file yet: its first moment goes there whole, or not at all.
    first: bool,
    /// True once the records accepted before a move was requested are in the file.
    committed_for_move: bool,
    watch: Watch,
    /// Number of the newest tile version of the moment that the file has.
    kept_versions: u64,
    last_commit: Instant,
    moment: Tries,
    journal: Tries,
    file: Tries,
}

/// State of failed writes.
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

/// Next work of the thread.
enum Work {
    Fetch,
    Keep(Box<Moment>),
    Show(Vec<ShownTile>),
    Commit(Vec<Record>),
    Move(Move),
    /// Nothing but to see that the file is there.
    Look,
    Close,
}

impl Thread {
    /// A thread for a file that has the tile versions up to `kept_versions`; without `writes` it only
    /// reads.
    pub(crate) fn new(
        shared: Arc<Shared>,
        (database, path): (Database, &Path),
        writes: bool,
        kept_versions: u64,
    ) -> Self {
        Self {
            shared,
            database,
            path: path.to_owned(),
            writes,
            first: false,
            committed_for_move: false,
            watch: Watch::new(path),
            kept_versions,
            last_commit: Instant::now(),
            moment: Tries::default(),
            journal: Tries::default(),
            file: Tries::default(),
        }
    }

    /// For a painting of which nothing is in the file yet.
    pub(crate) fn at_first(self) -> Self {
        Self {
            first: true,
            ..self
        }
    }

    /// Continues in another file.
    ///
    /// # Errors
    /// If the painting can go on in neither file.
    fn moved(mut self, order: Move) -> Result<Self, DocumentError> {
        self.committed_for_move = false;
        let open = |path: &Path| match is_new(path)? {
            // One that is begun in its place would be blank.
            true => Err(DocumentError::Missing),
            false => Database::open(path, Access::Paint, None).map(|(database, _)| database),
        };
        if let Found::Gone(_) = self.watch.look() {
            let rescued = moving::rescue(&self.database, &order.to, order.replace)
                .and_then(|()| self.go_to(&order.to));
            order.answer.send(rescued).ok();
            return Ok(self);
        }
        let moved = self.database.close().and_then(|()| {
            moving::put(&self.path, &order)?;
            open(&order.to).inspect_err(|_| moving::take_back(&self.path, &order))
        });
        let (opened, outcome) = match moved {
            Ok(database) => (Ok((database, order.to.clone())), Ok(())),
            Err(error) => (
                open(&self.path).map(|database| (database, self.path.clone())),
                Err(error),
            ),
        };
        match opened {
            Ok((database, path)) => {
                self.watch = Watch::new(&path);
                (self.database, self.path) = (database, path);
                if outcome.is_ok() {
                    self.settled();
                }
            }
            Err(error) => {
                let mut queues = self.shared.lock();
                queues.broken = true;
                (queues.fault, queues.help) = (error.to_string(), error.help());
                return Err(error);
            }
        }
        order.answer.send(outcome).ok();
        Ok(self)
    }

    /// Serves until the document is closed.
    ///
    /// # Errors
    /// Why something could not be written.
    pub(crate) fn run(mut self) -> Result<(), DocumentError> {
        let _end = End(Arc::clone(&self.shared));
        loop {
            let work = self.next();
            if self.writes && !matches!(work, Work::Fetch) {
                let hurry = matches!(work, Work::Close);
                self.see_to_the_file(hurry);
            }
            match work {
                Work::Look => {}
                Work::Fetch => serve(&self.shared, &self.database),
                Work::Keep(moment) => self.keep(*moment),
                Work::Show(tiles) => self.show(&tiles),
                Work::Commit(records) => self.commit(records),
                Work::Move(order) => self = self.moved(order)?,
                Work::Close => break,
            }
        }
        let (fault, left, broken) = {
            let queues = self.shared.lock();
            let left = queues.moment.is_some() || !queues.records.is_empty();
            (queues.fault.clone(), left, queues.broken)
        };
        if self.file.failed.is_some() {
            self.database.abandon();
            return Err(DocumentError::Unwritten(fault));
        }
        if broken || !self.writes {
            // A reader changes nothing, and the journal of a damaged file may hold rows to recover.
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
            let hurry = closing || !queues.flushes.is_empty() || !queues.moves.is_empty();
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
                return Work::Keep(Box::new(moment));
            }
            // While somebody paints there is always more to commit: once is enough.
            if may_write
                && (queues.records.is_empty() || self.committed_for_move)
                && let Some(order) = queues.moves.pop()
            {
                return Work::Move(order);
            }
            if commits {
                self.committed_for_move = !queues.moves.is_empty();
                return Work::Commit(std::mem::take(&mut queues.records));
            }
            if may_write && self.moment.failed.is_none() {
                // Tiles shown for a later checkpoint wait for that.
                let kept = self.kept_versions;
                let ready = queues.shown.extract_if(.., |_, tile| tile.version <= kept);
                let tiles: Vec<ShownTile> = ready.take(SHOWN).map(|(_, tile)| tile).collect();
                if !tiles.is_empty() {
                    return Work::Show(tiles);
                }
            }
            // A reader is never moved.
            queues.moves.clear();
            for waits in queues.flushes.drain(..) {
                // The waiting thread may have given up.
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
            let timed_out;
            (queues, timed_out) = waited.unwrap_or_else(PoisonError::into_inner);
            if self.writes && timed_out.timed_out() {
                return Work::Look;
            }
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

    /// Writes tiles as they are shown: those that cannot be written are made again when they are asked
    /// for.
    fn show(&self, tiles: &[ShownTile]) {
        let shared = Arc::clone(&self.shared);
        let written = self.transaction(|database| {
            let mut breathe = |database: &Database| serve(&shared, database);
            Writer::new(database, &mut breathe).shown(tiles)
        });
        if let Err(error) = written {
            tracing::warn!("tiles as they are shown are not kept: {error}");
        }
    }

    fn keep(&mut self, moment: Moment) {
        let shared = Arc::clone(&self.shared);
        let written = loop {
            let longest = if self.first { FIRST } else { COMMIT };
            let until = Instant::now() + longest;
            let written = self.transaction(|database| {
                let mut breathe = |database: &Database| serve(&shared, database);
                Writer::new(database, &mut breathe).moment(&moment, until)
            });
            match written {
                // Records accepted meanwhile do not wait for the rest.
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
                self.first = false;
                self.kept_versions = moment.painting.kept.versions;
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
        let all = [&self.moment, &self.journal, &self.file];
        if failed && all.iter().all(|part| part.failed.is_none()) {
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
        // The waiting threads would wait for ever.
        queues.flushes.clear();
        let moves = std::mem::take(&mut queues.moves);
        drop(queues);
        self.committed_for_move = false;
        for order in moves {
            let unwritten = DocumentError::Unwritten(error.to_string());
            order.answer.send(Err(unwritten)).ok();
        }
        *self.tries(part) = Tries {
            failed: Some(Instant::now()),
            given_up: closing,
        };
    }

    fn tries(&mut self, part: Part) -> &mut Tries {
        match part {
            Part::Moment => &mut self.moment,
            Part::Journal => &mut self.journal,
            Part::File => &mut self.file,
        }
    }
}

/// Part that is written.
#[derive(Clone, Copy)]
enum Part {
    Moment,
    Journal,
    File,
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
