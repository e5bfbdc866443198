//! An open painting: the painter's thread only hands over accepted records and checkpoints.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_canvas::page::Pager;
use maulstick_painting::sequencer::Record;

use crate::database::{Access, Database};
use crate::error::DocumentError;
use crate::moving::{Left, Move, Moving};
use crate::opening::{Opened, opened};
use crate::queues::{Life, Pages, Shared, Shelf};
use crate::thread::Thread;
use crate::writing::Moment;

/// Settings for opening a document.
#[derive(Clone, Debug)]
pub struct DocumentSettings {
    /// The file.
    pub path: PathBuf,
    /// Purpose.
    pub access: Access,
    /// Most bytes of pages in memory.
    pub memory: usize,
    /// Name of the SQLite VFS, if not the usual one.
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
        let kept_versions = found.as_ref().map_or(0, |found| found.kept().versions);
        let writes = settings.access == Access::Paint;
        let database = (database, &*settings.path);
        let thread = Thread::new(Arc::clone(&shared), database, writes, kept_versions);
        let document = Self::run(thread, &settings.path, shared, pager)?;
        Ok((document, found))
    }

    fn run(
        thread: Thread,
        path: &Path,
        shared: Arc<Shared>,
        pager: Arc<Pager>,
    ) -> Result<Self, DocumentError> {
        let thread = std::thread::Builder::new()
            .name("document".into())
            .spawn(move || thread.run())?;
        Ok(Self {
            path: path.to_owned(),
            shared,
            pager,
            thread: Some(thread),
        })
    }

    /// A document for a painting that was in memory alone, in a file that is not there yet. Its first
    /// moment, which has to hold the whole painting, is written whole or not at all; once it is,
    /// [`take_over`](Self::take_over) lets pages leave memory.
    ///
    /// # Errors
    /// [`DocumentError::Taken`] where a file is there, or why it cannot be made.
    pub fn begin(settings: &DocumentSettings, pager: &Arc<Pager>) -> Result<Self, DocumentError> {
        crate::moving::make_room(&settings.path, false)?;
        let vfs = settings.vfs.as_deref();
        let (database, _) = Database::open(&settings.path, Access::Paint, vfs)?;
        let shared: Arc<Shared> = Arc::default();
        let thread = Thread::new(Arc::clone(&shared), (database, &settings.path), true, 0);
        Self::run(thread.at_first(), &settings.path, shared, Arc::clone(pager))
    }

    /// Takes a first moment back that could not be written; false where it is being tried just now.
    #[must_use]
    pub fn take_back(&self) -> bool {
        let mut queues = self.shared.lock();
        queues.records.clear();
        queues.moment.take().is_some()
    }

    /// Has pages that are in the file leave memory: at most `memory` bytes stay.
    pub fn take_over(&self, memory: usize) {
        self.pager
            .back(Arc::new(Pages(Arc::clone(&self.shared))), memory);
    }

    /// Moves the painting to another file, with everything handed over until then; painting goes on meanwhile.
    /// [`arrived`](Self::arrived) returns the result.
    pub fn move_to(&self, to: &Path, left: Left, replace: bool) -> Moving {
        let (answer, outcome) = mpsc::channel();
        let mut queues = self.shared.lock();
        if queues.life != Life::Ended {
            queues.moves.push(Move {
                to: to.to_owned(),
                left,
                replace,
                answer,
            });
        }
        drop(queues);
        self.shared.bell.notify_all();
        Moving {
            to: to.to_owned(),
            outcome,
        }
    }

    /// Result of a move; `None` while it runs. If it failed, the painting is still at its old path.
    pub fn arrived(&mut self, moving: &Moving) -> Option<Result<(), DocumentError>> {
        match moving.outcome.try_recv() {
            Ok(outcome) => Some(self.come_to(moving, outcome)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(self.unwritten())),
        }
    }

    /// Waits for the end of a move.
    ///
    /// # Errors
    /// Why the painting is where it was.
    pub fn wait_for(&mut self, moving: &Moving) -> Result<(), DocumentError> {
        match moving.outcome.recv() {
            Ok(outcome) => self.come_to(moving, outcome),
            Err(mpsc::RecvError) => Err(self.unwritten()),
        }
    }

    fn come_to(
        &mut self,
        moving: &Moving,
        outcome: Result<(), DocumentError>,
    ) -> Result<(), DocumentError> {
        if outcome.is_ok() {
            self.path.clone_from(&moving.to);
        }
        outcome
    }

    fn unwritten(&self) -> DocumentError {
        DocumentError::Unwritten(self.shared.lock().fault.clone())
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

    /// True if the last checkpoint is written, so that the next one can be handed over.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        let queues = self.shared.lock();
        queues.moment.is_none() && !queues.writing
    }

    /// True if everything that was handed over is written.
    #[must_use]
    pub fn has_all(&self) -> bool {
        let queues = self.shared.lock();
        let idle = queues.moment.is_none() && queues.records.is_empty();
        idle && !queues.writing && queues.fault.is_empty()
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

    /// The reason why nothing is written at present, or the state of the file, with advice; `None` if all is well.
    #[must_use]
    pub fn fault(&self) -> Option<(String, &'static str)> {
        let queues = self.shared.lock();
        let fault = (!queues.fault.is_empty()).then(|| (queues.fault.clone(), queues.help));
        fault.or_else(|| queues.notice.clone())
    }

    /// Takes in that the painting went on in another file because its own was gone.
    pub fn follow(&mut self) {
        if let Some(path) = self.shared.lock().went_to.take() {
            self.path = path;
        }
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
