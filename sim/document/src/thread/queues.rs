//! Queues between the painter's threads and the document's: data to write, and pages to read.

use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::SeqCst};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::Instant;

use maulstick_canvas::page::backing::{Backing, PageError};
use maulstick_canvas::planes::Planes;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::sequencer::Record;
use maulstick_types::command::advice::Advice;

use crate::checkpoint::Checkpoint;
use crate::error::DocumentError;
use crate::file::relocate::RelocateRequest;
use crate::record::RecordRow;
use crate::writing::ShownTile;

/// Largest number of displayed tiles that wait to be written.
const SHOWN_MAX: usize = 4096;

/// Page that a reader waits for.
pub(crate) enum Fetch {
    Planes(u64, mpsc::Sender<Result<Planes, DocumentError>>),
    Load(u64, mpsc::Sender<Result<BrushLoad, DocumentError>>),
    Shown([i64; 3], mpsc::Sender<Option<Vec<u8>>>),
    /// Messages of the record from a serial number on.
    Records(u64, mpsc::Sender<Result<Option<RecordRow>, DocumentError>>),
}

/// State of the document's thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Life {
    #[default]
    Open,
    /// Writing the data handed over before it ends.
    Closing,
    /// Ended: requests are not answered any more.
    Ended,
}

/// Data to write and pages to read, and the state of the thread.
#[derive(Default)]
pub(crate) struct Queues {
    pub(crate) fetches: Vec<Fetch>,
    /// Pages that could not be read because of a temporary fault, with the time of the failure, to be retried.
    pub(crate) failed_fetches: Vec<(Fetch, Instant)>,
    /// Retries that are due.
    pub(crate) retried: Vec<(Fetch, Instant)>,
    pub(crate) records: Vec<Record>,
    pub(crate) checkpoint: Option<Checkpoint>,
    pub(crate) shown: BTreeMap<i64, ShownTile>,
    /// True while a checkpoint is written. If that fails, it is written again before any later one.
    pub(crate) writing: bool,
    /// True if the file lacks parts of the painting, as after its journal was cut short, and needs the whole painting.
    pub(crate) wants_all: bool,
    /// Threads that wait until everything handed over is written, or writing has failed.
    pub(crate) flushes: Vec<mpsc::Sender<()>>,
    /// Relocations to do once everything handed over is written.
    pub(crate) relocations: Vec<RelocateRequest>,
    pub(crate) life: Life,
    /// Error that makes the painting in memory unreliable: a page could not be read. Nothing is written any more.
    pub(crate) broken: Option<String>,
    /// The reason why nothing is written at present, with advice.
    pub(crate) fault: Option<(String, Advice)>,
    /// Notice about the file, with advice, while everything is written.
    pub(crate) notice: Option<(NoticeKind, String, Advice)>,
    /// File in which the painting continues after its own was removed.
    pub(crate) moved_to: Option<PathBuf>,
}

/// Subject of a notice about the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoticeKind {
    /// The painting continues in another file.
    Moved,
    /// The file has a second name, a hard link.
    Linked,
}

impl Queues {
    /// Text of the fault; empty without one.
    pub(crate) fn fault_text(&self) -> String {
        let fault = self.fault.as_ref();
        fault.map_or(String::new(), |(what, _)| what.clone())
    }
}

/// State shared by the painter's threads and the document's.
#[derive(Default)]
pub(crate) struct Shared {
    pub(crate) queues: Mutex<Queues>,
    pub(crate) wake: Condvar,
    pub(crate) committed: AtomicU64,
    /// True while stored pages may be unreadable, because the disk fails or the file lacks parts of the painting: then
    /// no page leaves memory.
    pub(crate) fails: AtomicBool,
    /// Bytes of the record.
    pub(crate) record_bytes: AtomicU64,
    /// Processor time spent on reading pages, ns.
    pub(crate) page_in_ns: AtomicU64,
}

impl Shared {
    pub(crate) fn lock(&self) -> MutexGuard<'_, Queues> {
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Requests a page and waits for it; `None` if the thread has ended.
    pub(crate) fn request<T>(&self, fetch: impl FnOnce(mpsc::Sender<T>) -> Fetch) -> Option<T> {
        let (send, receive) = mpsc::channel();
        {
            let mut queues = self.lock();
            if queues.life == Life::Ended {
                return None;
            }
            queues.fetches.push(fetch(send));
        }
        self.wake.notify_all();
        receive.recv().ok()
    }
}

/// Guard that releases all waiting threads when the document's thread ends, even by a panic.
pub(crate) struct EndGuard(pub(crate) Arc<Shared>);

impl Drop for EndGuard {
    fn drop(&mut self) {
        self.0.fails.store(true, SeqCst);
        let mut queues = self.0.lock();
        queues.life = Life::Ended;
        if std::thread::panicking() {
            queues.broken = Some(PANICKED.to_owned());
            let help = "start the rig again: what was committed is in the file";
            queues.fault = Some((PANICKED.to_owned(), Advice::say(help)));
        }
        queues.fetches.clear();
        queues.failed_fetches.clear();
        queues.retried.clear();
        queues.flushes.clear();
        queues.relocations.clear();
    }
}

/// Backing of pages by the document's thread.
pub(crate) struct DocumentBacking(pub(crate) Arc<Shared>);

/// Error of a request after the end of the thread.
pub(crate) const CLOSED: &str = "the document was closed";
/// Error of a document whose thread panicked.
pub(crate) const PANICKED: &str = "internal error: the document's thread panicked";

impl Backing for DocumentBacking {
    fn read(&self, id: u64, kind: TypeId) -> Result<Box<dyn Any>, PageError> {
        if kind == TypeId::of::<Planes>() {
            return self.page(|answer| Fetch::Planes(id, answer));
        }
        if kind == TypeId::of::<BrushLoad>() {
            return self.page(|answer| Fetch::Load(id, answer));
        }
        Err(PageError::Kind(id))
    }

    fn is_at_hand(&self) -> bool {
        !self.0.fails.load(SeqCst)
    }
}

impl DocumentBacking {
    fn page<T: 'static>(
        &self,
        fetch: impl FnOnce(mpsc::Sender<Result<T, DocumentError>>) -> Fetch,
    ) -> Result<Box<dyn Any>, PageError> {
        let read = self.0.request(fetch);
        let read = read.unwrap_or_else(|| Err(DocumentError::Other(CLOSED.to_owned())));
        match read {
            Ok(content) => Ok(Box::new(content)),
            // The page's own error suffices.
            Err(DocumentError::Damaged(what)) => Err(PageError::Storage(what.into())),
            Err(error) => Err(PageError::Storage(error.into())),
        }
    }
}

/// Cache of displayed tiles in the document.
#[derive(Clone)]
pub struct TileCache(pub(crate) Arc<Shared>);

impl TileCache {
    /// Planes of a tile displayed under a look, if the document has them.
    #[must_use]
    pub fn get(&self, place: i64, version: u64, look: i64) -> Option<Vec<u8>> {
        let bytes = self
            .0
            .request(|answer| Fetch::Shown([place, version as i64, look], answer))??;
        zstd::bulk::decompress(&bytes, 1 << 20).ok()
    }

    /// Queues a tile, to be written after the checkpoint that contains it.
    pub fn put(&self, tile: ShownTile) {
        let mut queues = self.0.lock();
        if queues.shown.len() < SHOWN_MAX && queues.life == Life::Open {
            queues.shown.insert(tile.place, tile);
        }
    }
}

impl std::fmt::Debug for TileCache {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("TileCache")
    }
}
