//! Queues between the painter's threads and the document's: data that wait to be written, and readers that wait for a
//! page.

use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};

use maulstick_canvas::page::backing::Backing;
use maulstick_canvas::planes::Planes;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::sequencer::Record;

use crate::moving::Move;
use crate::writing::{Moment, ShownTile};

/// Tiles as they are shown that wait to be written, at most.
const SHOWN_MAX: usize = 4096;

/// A page that somebody waits for.
pub(crate) enum Fetch {
    Planes(u64, mpsc::Sender<Result<Planes, String>>),
    Load(u64, mpsc::Sender<Result<BrushLoad, String>>),
    Shown([i64; 3], mpsc::Sender<Option<Vec<u8>>>),
}

/// State of the document's thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Life {
    /// It does.
    #[default]
    Open,
    /// It writes what was handed over, and ends.
    Closing,
    /// It is gone: nobody answers any more.
    Ended,
}

#[derive(Default)]
pub(crate) struct Queues {
    pub(crate) fetches: Vec<Fetch>,
    pub(crate) records: Vec<Record>,
    pub(crate) moment: Option<Moment>,
    pub(crate) shown: BTreeMap<i64, ShownTile>,
    /// A moment is being written: if that fails it is to be written again, before any later one.
    pub(crate) writing: bool,
    /// Threads that wait until everything handed over is written, or could not be.
    pub(crate) flushes: Vec<mpsc::Sender<()>>,
    /// Files to move the painting to, once everything handed over is written.
    pub(crate) moves: Vec<Move>,
    pub(crate) life: Life,
    /// A page could not be read: what was painted since may rest on its absence.
    pub(crate) broken: bool,
    pub(crate) fault: String,
    pub(crate) help: &'static str,
    /// Notice about the file although all is written, with advice.
    pub(crate) notice: Option<(String, &'static str)>,
    /// File in which the painting continued when its own was gone.
    pub(crate) went_to: Option<PathBuf>,
}

/// State shared by the painter's threads and the document's.
#[derive(Default)]
pub(crate) struct Shared {
    pub(crate) queues: Mutex<Queues>,
    pub(crate) bell: Condvar,
    pub(crate) committed: AtomicU64,
    /// Time of the processor that was spent on reading pages, ns.
    pub(crate) page_in_ns: AtomicU64,
}

impl Shared {
    pub(crate) fn lock(&self) -> MutexGuard<'_, Queues> {
        self.queues.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn ask<T>(&self, fetch: impl FnOnce(mpsc::Sender<T>) -> Fetch) -> Option<T> {
        let (send, receive) = mpsc::channel();
        {
            let mut queues = self.lock();
            if queues.life == Life::Ended {
                return None;
            }
            queues.fetches.push(fetch(send));
        }
        self.bell.notify_all();
        receive.recv().ok()
    }
}

/// Frees those who wait for the thread, however it ends.
pub(crate) struct End(pub(crate) Arc<Shared>);

impl Drop for End {
    fn drop(&mut self) {
        let mut queues = self.0.lock();
        queues.life = Life::Ended;
        if std::thread::panicking() {
            queues.broken = true;
            queues.fault = "its thread has fallen".to_owned();
            queues.help = "start the rig again: what was committed is in the file";
        }
        queues.fetches.clear();
        queues.flushes.clear();
        queues.moves.clear();
    }
}

/// Pages from the document's thread.
pub(crate) struct Pages(pub(crate) Arc<Shared>);

const GONE: &str = "the document was closed";

impl Backing for Pages {
    fn read(&self, id: u64, kind: TypeId) -> Result<Box<dyn Any>, String> {
        if kind == TypeId::of::<Planes>() {
            return self.page(|answer| Fetch::Planes(id, answer));
        }
        if kind == TypeId::of::<BrushLoad>() {
            return self.page(|answer| Fetch::Load(id, answer));
        }
        Err(format!("page {id} is of a kind that no document holds"))
    }
}

impl Pages {
    fn page<T: 'static>(
        &self,
        fetch: impl FnOnce(mpsc::Sender<Result<T, String>>) -> Fetch,
    ) -> Result<Box<dyn Any>, String> {
        let read = self.0.ask(fetch).unwrap_or_else(|| Err(GONE.to_owned()))?;
        Ok(Box::new(read))
    }
}

/// Tiles as they were shown, for the thread that shows them.
#[derive(Clone)]
pub struct Shelf(pub(crate) Arc<Shared>);

impl Shelf {
    /// The planes of a tile as it was shown under a look, if they are in the document.
    #[must_use]
    pub fn get(&self, place: i64, version: u64, look: i64) -> Option<Vec<u8>> {
        let bytes = self
            .0
            .ask(|answer| Fetch::Shown([place, version as i64, look], answer))??;
        zstd::bulk::decompress(&bytes, 1 << 20).ok()
    }

    /// Puts a tile aside, to be written with the next moment that holds it.
    pub fn put(&self, tile: ShownTile) {
        let mut queues = self.0.lock();
        if queues.shown.len() < SHOWN_MAX && queues.life == Life::Open {
            queues.shown.insert(tile.place, tile);
        }
    }
}

impl std::fmt::Debug for Shelf {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Shelf")
    }
}
