//! Pages: paint that is in memory, in the painting's document, or in both.
//!
//! A page never changes. It stays in memory while it is only there; once its document has it, it may leave when memory
//! gets short, and is read back on demand. The last owner to drop a page lets the document delete it.

pub mod backing;

use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};

use backing::{Backing, Content, PageError};

/// Content that can leave memory.
pub(crate) trait Evict: Send + Sync {
    /// Leaves memory if possible, and returns the number of bytes freed; `None` if it must stay for now.
    fn evict(&self) -> Option<usize>;
}

/// Counts of paging.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PageCounts {
    /// Bytes of pages in memory.
    pub resident: usize,
    /// Limit on the bytes of pages in memory that can leave it.
    pub bound: usize,
    /// Number of pages read back.
    pub fetched: u64,
    /// Size of pages in the document, bytes.
    pub stored: u64,
}

impl PageCounts {
    /// Size of the painting in its storage, the document or memory, bytes.
    #[must_use]
    pub fn held(&self) -> u64 {
        match self.stored {
            0 => self.resident as u64,
            stored => stored,
        }
    }
}

/// Pager of one painting.
pub struct Pager {
    backing: OnceLock<Arc<dyn Backing>>,
    next: AtomicU64,
    bound: AtomicUsize,
    resident: AtomicUsize,
    stored: AtomicU64,
    fetched: AtomicU64,
    /// Number of pages to come before eviction is tried again.
    rest: AtomicUsize,
    ring: Mutex<VecDeque<Weak<dyn Evict>>>,
    dead: Mutex<Vec<u64>>,
    fault: OnceLock<String>,
}

impl Default for Pager {
    fn default() -> Self {
        Self {
            backing: OnceLock::new(),
            next: AtomicU64::new(1),
            bound: AtomicUsize::new(usize::MAX),
            resident: AtomicUsize::new(0),
            stored: AtomicU64::new(0),
            fetched: AtomicU64::new(0),
            rest: AtomicUsize::new(0),
            ring: Mutex::default(),
            dead: Mutex::default(),
            fault: OnceLock::new(),
        }
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Pager {
    /// Pager of a painting with a document: at most `bound` bytes of stored pages stay in memory, and new ones are
    /// numbered from `next` on.
    #[must_use]
    pub fn backed(backing: Arc<dyn Backing>, bound: usize, next: u64) -> Arc<Self> {
        let pager = Self {
            next: AtomicU64::new(next.max(1)),
            bound: AtomicUsize::new(bound),
            ..Self::default()
        };
        pager.backing.set(backing).ok();
        Arc::new(pager)
    }

    /// Lets later pages of a painting that was in memory alone leave it: at most
    /// `bound` bytes of stored ones stay. A painting gets a document once.
    pub fn back(&self, backing: Arc<dyn Backing>, bound: usize) {
        if self.backing.set(backing).is_ok() {
            self.bound.store(bound, Relaxed);
        }
    }

    /// Pages that belong to no painting.
    fn loose() -> &'static Arc<Self> {
        static LOOSE: OnceLock<Arc<Pager>> = OnceLock::new();
        LOOSE.get_or_init(Arc::default)
    }

    /// A new number, unique among the pages and dry layers of the painting.
    pub fn number(&self) -> u64 {
        self.next.fetch_add(1, Relaxed)
    }

    /// The number of the next page.
    #[must_use]
    pub fn next_number(&self) -> u64 {
        self.next.load(Relaxed)
    }

    /// Counts of paging so far.
    #[must_use]
    pub fn counts(&self) -> PageCounts {
        PageCounts {
            resident: self.resident.load(Relaxed),
            bound: self.bound.load(Relaxed),
            fetched: self.fetched.load(Relaxed),
            stored: self.stored.load(Relaxed),
        }
    }

    /// Stored pages and dry layers without references that were dropped since the last call.
    pub fn take_dead(&self) -> Vec<u64> {
        std::mem::take(&mut locked(&self.dead))
    }

    pub(crate) fn bury(&self, id: u64) {
        locked(&self.dead).push(id);
    }

    /// Error of the first unreadable page.
    #[must_use]
    pub fn fault(&self) -> Option<&str> {
        self.fault.get().map(String::as_str)
    }

    /// Counts content that came into memory and can leave it.
    pub(crate) fn enter(&self, bytes: usize, what: Weak<dyn Evict>) {
        self.resident.fetch_add(bytes, Relaxed);
        if self.bound.load(Relaxed) == usize::MAX {
            return;
        }
        let mut ring = locked(&self.ring);
        ring.push_back(what);
        while ring.front().is_some_and(|what| what.strong_count() == 0) {
            ring.pop_front();
        }
        if self
            .backing
            .get()
            .is_some_and(|backing| !backing.is_at_hand())
        {
            return;
        }
        // If no page could leave, the next attempt is after the document has stored another one, or after many new
        // pages.
        let rest = self.rest.load(Relaxed);
        if rest > 0 {
            self.rest.store(rest - 1, Relaxed);
            return;
        }
        // Each gets a second chance, so two rounds find all that can leave.
        let mut tries = 2 * ring.len();
        while self.resident.load(Relaxed) > self.bound.load(Relaxed) {
            if tries == 0 {
                self.rest.store(ring.len() / 2, Relaxed);
                break;
            }
            tries -= 1;
            let Some(oldest) = ring.pop_front() else {
                break;
            };
            if let Some(found) = oldest.upgrade() {
                match found.evict() {
                    Some(bytes) => self.left(bytes),
                    None => ring.push_back(oldest),
                }
            }
        }
    }

    pub(crate) fn left(&self, bytes: usize) {
        self.resident.fetch_sub(bytes, Relaxed);
    }
}

impl fmt::Debug for Pager {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Pager").field(&self.counts()).finish()
    }
}

struct Kept<T: Content> {
    id: u64,
    pager: Arc<Pager>,
    content: Mutex<Option<Arc<T>>>,
    used: AtomicBool,
    /// Size in the document, bytes; 0 while it is not there.
    stored: AtomicUsize,
    /// The page that this one is a later state of.
    base: Weak<Kept<T>>,
}

impl<T: Content> Evict for Kept<T> {
    fn evict(&self) -> Option<usize> {
        if self.stored.load(Relaxed) == 0 || self.used.swap(false, Relaxed) {
            return None;
        }
        let mut content = self.content.try_lock().ok()?;
        // A reader holds it in memory anyway.
        match content.as_ref() {
            Some(shared) if Arc::strong_count(shared) > 1 => None,
            _ => Some(content.take().map_or(0, |content| content.bytes())),
        }
    }
}

impl<T: Content> Drop for Kept<T> {
    fn drop(&mut self) {
        let content = self
            .content
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(content) = content {
            self.pager.left(content.bytes());
        }
        let stored = self.stored.load(Relaxed);
        if stored > 0 {
            self.pager.stored.fetch_sub(stored as u64, Relaxed);
            self.pager.bury(self.id);
        }
    }
}

/// A page; clones are the same page.
pub struct Page<T: Content>(Arc<Kept<T>>);

impl<T: Content> Clone for Page<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T: Content> Page<T> {
    fn make(pager: &Arc<Pager>, id: u64, content: Option<Arc<T>>, base: Weak<Kept<T>>) -> Self {
        let bytes = content.as_ref().map(|content| content.bytes());
        let kept = Arc::new(Kept {
            id,
            pager: Arc::clone(pager),
            content: Mutex::new(content),
            used: AtomicBool::new(true),
            stored: AtomicUsize::new(0),
            base,
        });
        if let Some(bytes) = bytes {
            let weak: Weak<Kept<T>> = Arc::downgrade(&kept);
            pager.enter(bytes, weak);
        }
        Self(kept)
    }

    /// A new page; `base` is its earlier state.
    #[must_use]
    pub fn new(pager: &Arc<Pager>, content: Arc<T>, base: Option<&Self>) -> Self {
        // An unstored page may never be stored: then this is a later state of the base's own base.
        let base = base.map_or_else(Weak::new, |base| match base.stored_bytes() {
            0 => base.0.base.clone(),
            _ => Arc::downgrade(&base.0),
        });
        Self::make(pager, pager.number(), Some(content), base)
    }

    /// A page that belongs to no painting.
    #[must_use]
    pub fn loose(content: T) -> Self {
        Self::new(Pager::loose(), Arc::new(content), None)
    }

    /// A page in the document, of `stored` bytes.
    #[must_use]
    pub fn stored(pager: &Arc<Pager>, id: u64, stored: usize) -> Self {
        let page = Self::make(pager, id, None, Weak::new());
        page.note_stored(stored);
        page
    }

    /// Number of the page.
    #[must_use]
    pub fn id(&self) -> u64 {
        self.0.id
    }

    /// Pager of its painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.0.pager
    }

    /// True if both are the same page.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Its earlier state, if that is still referenced.
    #[must_use]
    pub fn base(&self) -> Option<Self> {
        self.0.base.upgrade().map(Self)
    }

    /// Size in the document, bytes; 0 while it is not there.
    #[must_use]
    pub fn stored_bytes(&self) -> usize {
        self.0.stored.load(Relaxed)
    }

    /// Size in its storage, the document or memory, bytes.
    #[must_use]
    pub fn held_bytes(&self) -> usize {
        match self.stored_bytes() {
            0 => self.resident_bytes(),
            stored => stored,
        }
    }

    /// Size in memory now, bytes.
    #[must_use]
    pub(crate) fn resident_bytes(&self) -> usize {
        locked(&self.0.content)
            .as_ref()
            .map_or(0, |content| content.bytes())
    }

    /// Its content, if it is in memory.
    #[must_use]
    pub fn peek(&self) -> Option<Arc<T>> {
        locked(&self.0.content).clone()
    }

    /// Marks it as stored in the document, so that it may leave memory.
    pub fn note_stored(&self, bytes: usize) {
        let bytes = bytes.max(1);
        let before = self.0.stored.swap(bytes, Relaxed);
        let stored = &self.0.pager.stored;
        stored.fetch_add(bytes as u64, Relaxed);
        stored.fetch_sub(before as u64, Relaxed);
        self.0.pager.rest.store(0, Relaxed);
    }

    /// Its content, read from the document if it is not in memory. An unreadable page is empty, and [`Pager::fault`]
    /// has the reason.
    #[must_use]
    pub fn get(&self) -> Arc<T> {
        self.0.used.store(true, Relaxed);
        if let Some(content) = self.peek() {
            return content;
        }
        // Unlocked, because the document's thread, which reads here, may look at this page meanwhile.
        let pager = &self.0.pager;
        let read = match pager.backing.get() {
            Some(backing) => backing.fetch(self.0.id),
            None => Err(PageError::Unbacked(self.0.id)),
        };
        pager.fetched.fetch_add(1, Relaxed);
        let read = Arc::new(read.unwrap_or_else(|error| {
            pager.fault.set(error.to_string()).ok();
            T::nothing()
        }));
        self.keep(read)
    }

    /// Restores its content from its document, before its first read.
    pub fn put_back(&self, content: T) {
        self.keep(Arc::new(content));
    }

    fn keep(&self, read: Arc<T>) -> Arc<T> {
        let mut content = locked(&self.0.content);
        if let Some(content) = &*content {
            return Arc::clone(content);
        }
        *content = Some(Arc::clone(&read));
        drop(content);
        let weak: Weak<Kept<T>> = Arc::downgrade(&self.0);
        self.0.pager.enter(read.bytes(), weak);
        read
    }
}

impl<T: Content> fmt::Debug for Page<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Page").field(&self.0.id).finish()
    }
}

impl<T: Content + PartialEq> PartialEq for Page<T> {
    fn eq(&self, other: &Self) -> bool {
        self.is(other) || self.get() == other.get()
    }
}

#[cfg(test)]
mod tests;
