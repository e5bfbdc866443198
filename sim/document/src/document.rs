//! An open painting: the painter's thread only hands over accepted records and checkpoints.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::SeqCst;
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_canvas::page::Pager;
use maulstick_painting::sequencer::Record;
use maulstick_types::command::advice::Advice;

use crate::checkpoint::Checkpoint;
use crate::error::DocumentError;
use crate::file::database::{Access, Database};
use crate::file::relocate::{Relocate, RelocateRequest, Relocation, make_room};
use crate::opening::{Opened, has_state, next_page, opened};
use crate::record::{self, RecordRow};
use crate::thread::DocumentThread;
use crate::thread::queues::{CLOSED, DocumentBacking, Fetch, Life, PANICKED, Shared, TileCache};

/// Settings for opening a document.
#[derive(Clone, Debug)]
pub struct DocumentSettings {
    /// The file.
    pub path: PathBuf,
    /// Access: read only or read and write.
    pub access: Access,
    /// Limit on the pages in memory, bytes.
    pub memory: usize,
    /// Name of the SQLite VFS, if not the default.
    pub vfs: Option<String>,
}

impl DocumentSettings {
    /// Settings for a file, with 1 GiB of memory.
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
    /// Opens a painting, or creates its file: then there is no [`Opened`].
    ///
    /// # Errors
    /// Any [`DocumentError`]; the file is unchanged.
    pub fn open(settings: &DocumentSettings) -> Result<(Self, Option<Opened>), DocumentError> {
        let vfs = settings.vfs.as_deref();
        let (database, new) = Database::open(&settings.path, settings.access, vfs)?;
        let shared: Arc<Shared> = Arc::default();
        let backing = Arc::new(DocumentBacking(Arc::clone(&shared)));
        let (pager, found) = match content(&database, new, backing, settings.memory) {
            Ok(content) => content,
            Err(error) => {
                database.close_unchanged().ok();
                return Err(error);
            }
        };
        if let Some(found) = &found {
            shared.committed.store(found.next_index(), SeqCst);
            // Used only for the limit of the record.
            let bytes = record::bytes(&database).unwrap_or_default();
            shared.record_bytes.store(bytes, SeqCst);
        }
        let saved_version = found.as_ref().map_or(0, |found| found.snapshot().versions);
        let writes = settings.access == Access::Paint;
        let database = (database, &*settings.path);
        let thread = DocumentThread::new(Arc::clone(&shared), database, writes, saved_version);
        let pages = found.as_ref().filter(|_| writes).map(Opened::pages);
        let thread = thread.reading_ahead(pages.unwrap_or_default());
        let document = Self::run(thread, &settings.path, shared, pager)?;
        Ok((document, found))
    }

    fn run(
        thread: DocumentThread,
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

    /// Creates a document for a painting that was in memory alone. Its first checkpoint must contain the whole
    /// painting, and is written completely or not at all; after that [`limit_memory`](Self::limit_memory) lets pages
    /// leave memory.
    ///
    /// # Errors
    /// [`DocumentError::Taken`] if the file exists, or the reason why it cannot be created.
    pub fn begin(settings: &DocumentSettings, pager: &Arc<Pager>) -> Result<Self, DocumentError> {
        make_room(&settings.path, false)?;
        let vfs = settings.vfs.as_deref();
        let (database, _) = Database::open(&settings.path, Access::Paint, vfs)?;
        let shared: Arc<Shared> = Arc::default();
        let thread = DocumentThread::new(Arc::clone(&shared), (database, &settings.path), true, 0);
        Self::run(
            thread.for_first_checkpoint(),
            &settings.path,
            shared,
            Arc::clone(pager),
        )
    }

    /// Cancels a first checkpoint that could not be written; false while it is being written.
    #[must_use]
    pub fn cancel_checkpoint(&self) -> bool {
        let mut queues = self.shared.lock();
        queues.records.clear();
        queues.checkpoint.take().is_some()
    }

    /// Lets pages that are in the file leave memory, so that at most `memory` bytes stay.
    pub fn limit_memory(&self, memory: usize) {
        self.pager
            .back(Arc::new(DocumentBacking(Arc::clone(&self.shared))), memory);
    }

    /// Relocates the painting, with everything handed over until then, while painting continues.
    /// [`poll_relocation`](Self::poll_relocation) returns the result: [`DocumentError::Incomplete`] while its file
    /// [lacks parts](Self::wants_all) of it.
    pub fn relocate(&self, to: &Path, how: Relocate, replace: bool) -> Relocation {
        let (answer, outcome) = mpsc::channel();
        let mut queues = self.shared.lock();
        if queues.life != Life::Ended {
            queues.relocations.push(RelocateRequest {
                to: to.to_owned(),
                how,
                replace,
                answer,
            });
        }
        drop(queues);
        self.shared.wake.notify_all();
        Relocation {
            to: to.to_owned(),
            how,
            outcome,
        }
    }

    /// Result of a relocation; `None` while it runs. If it failed, the painting is still at its old path.
    pub fn poll_relocation(
        &mut self,
        relocation: &Relocation,
    ) -> Option<Result<(), DocumentError>> {
        match relocation.outcome.try_recv() {
            Ok(outcome) => Some(self.end_relocation(relocation, outcome)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(self.unwritten())),
        }
    }

    /// Waits for the end of a relocation.
    ///
    /// # Errors
    /// The reason why the painting is still at its old path.
    pub fn wait_for_relocation(&mut self, relocation: &Relocation) -> Result<(), DocumentError> {
        match relocation.outcome.recv() {
            Ok(outcome) => self.end_relocation(relocation, outcome),
            Err(mpsc::RecvError) => Err(self.unwritten()),
        }
    }

    fn end_relocation(
        &mut self,
        relocation: &Relocation,
        outcome: Result<(), DocumentError>,
    ) -> Result<(), DocumentError> {
        if outcome.is_ok() && relocation.how != Relocate::Leave {
            self.path.clone_from(&relocation.to);
        }
        outcome
    }

    fn unwritten(&self) -> DocumentError {
        DocumentError::Unwritten(self.shared.lock().fault_text())
    }

    /// Path of the file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Pager of the painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.pager
    }

    /// Cache of displayed tiles.
    #[must_use]
    pub fn tile_cache(&self) -> TileCache {
        TileCache(Arc::clone(&self.shared))
    }

    /// Hands over accepted records, which are written to the file within a tenth of a second.
    pub fn record(&self, records: Vec<Record>) {
        if !records.is_empty() {
            self.shared.lock().records.extend(records);
            self.shared.wake.notify_all();
        }
    }

    /// True if the last checkpoint is written, so that the next one may be handed over.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        let queues = self.shared.lock();
        queues.checkpoint.is_none() && !queues.writing
    }

    /// True if its file lacks parts of the painting, as after its journal was cut short: the next checkpoint must
    /// contain all of it ([`Painting::tell_all_again`](maulstick_painting::Painting::tell_all_again), from the version
    /// 0 on), and nothing is written before.
    #[must_use]
    pub fn wants_all(&self) -> bool {
        self.shared.lock().wants_all
    }

    /// True if everything handed over is written, and the file is complete.
    #[must_use]
    pub fn is_saved(&self) -> bool {
        let queues = self.shared.lock();
        let idle = queues.checkpoint.is_none() && queues.records.is_empty();
        idle && !queues.writing && !queues.wants_all && queues.fault.is_none()
    }

    /// Hands over a checkpoint. It must include all records handed over before, and the previous one must be written
    /// ([`is_ready`](Self::is_ready)).
    pub fn write_checkpoint(&self, checkpoint: Checkpoint) {
        self.shared.lock().checkpoint = Some(checkpoint);
        self.shared.wake.notify_all();
    }

    /// Index of the first journal entry that is not in the file.
    #[must_use]
    pub fn committed(&self) -> u64 {
        self.shared.committed.load(SeqCst)
    }

    /// Size of the record in the file at the last checkpoint, bytes.
    #[must_use]
    pub fn record_bytes(&self) -> u64 {
        self.shared.record_bytes.load(SeqCst)
    }

    /// Records from a serial number on, as many as a row of the file has; `None` at the end. Records that are handed
    /// over but not written are left out.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if it is not intact, or the reason why it cannot be read.
    pub fn record_row(&self, serial: u64) -> Result<Option<RecordRow>, DocumentError> {
        let row = self.shared.request(|answer| Fetch::Records(serial, answer));
        row.unwrap_or_else(|| Err(DocumentError::Other(CLOSED.to_owned())))
    }

    /// Processor time spent on reading pages.
    #[must_use]
    pub fn page_in_cpu(&self) -> Duration {
        Duration::from_nanos(self.shared.page_in_ns.load(SeqCst))
    }

    /// The reason why nothing is written at present, or a notice about the file, with advice; `None` without either.
    #[must_use]
    pub fn fault(&self) -> Option<(String, Advice)> {
        let queues = self.shared.lock();
        let notice = queues.notice.clone();
        let notice = notice.map(|(_, what, advice)| (what, advice));
        queues.fault.clone().or(notice)
    }

    /// Updates the path after the file was removed and the painting continued in another one.
    pub fn update_path(&mut self) {
        if let Some(path) = self.shared.lock().moved_to.take() {
            self.path = path;
        }
    }

    /// Waits until everything handed over is written, or writing has failed.
    pub fn flush(&self) {
        let (send, receive) = mpsc::channel();
        {
            let mut queues = self.shared.lock();
            if queues.life == Life::Ended {
                return;
            }
            queues.flushes.push(send);
        }
        self.shared.wake.notify_all();
        receive.recv().ok();
    }

    /// Writes everything handed over, merges the journal and closes the file.
    ///
    /// # Errors
    /// The reason why data could not be written; [`DocumentError::Incomplete`] if the file still
    /// [lacks parts](Self::wants_all) of the painting.
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
        self.shared.wake.notify_all();
        match self.thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(ended)) => ended,
            Some(Err(_)) => Err(DocumentError::Other(PANICKED.to_owned())),
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

/// Pager of a painting and its content; no content if it is to be created.
fn content(
    database: &Database,
    new: bool,
    backing: Arc<DocumentBacking>,
    memory: usize,
) -> Result<(Arc<Pager>, Option<Opened>), DocumentError> {
    // A file without its first checkpoint counts as new.
    if new || !has_state(database)? {
        return Ok((Pager::backed(backing, memory, 1), None));
    }
    let pager = Pager::backed(backing, memory, next_page(database)?);
    let found = opened(database, &pager)?;
    Ok((pager, Some(found)))
}
