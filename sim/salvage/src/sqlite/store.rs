//! Pages of the main file or the WAL, and records across overflow pages.

use std::io::{self, Read, Seek, SeekFrom};

use super::io::read_at;
use super::leaf::{Cell, be32};
use super::page_size::{PageSize, reserved, usable};
use super::wal::{Frames, Header, WalState};

/// Copy of a page that a row was read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// The database itself, not its journal.
    Main,
    /// A committed frame of the WAL, without damage before it.
    Wal,
    /// A frame of the WAL with a damaged one before it or in its transaction. Its own checksum matches, but SQLite would
    /// not read it, and its transaction may never have been acknowledged.
    WalPastDamage,
}

/// Copy of a page, to be read.
#[derive(Debug, Clone, Copy)]
pub(super) struct PageCopy {
    pub(super) page: u32,
    pub(super) origin: Origin,
    pub(super) current: bool,
}

/// Pages of a database.
pub(super) struct Store<F> {
    main: F,
    main_bytes: u64,
    wal: Option<F>,
    wal_bytes: u64,
    frames: Frames,
    page_size: PageSize,
    usable: usize,
    reads_failed: u64,
}

impl<F: Read + Seek> Store<F> {
    pub(super) fn new(mut main: F, mut wal: Option<F>) -> io::Result<Self> {
        let main_bytes = main.seek(SeekFrom::End(0))?;
        let wal_bytes = match &mut wal {
            Some(wal) => wal.seek(SeekFrom::End(0))?,
            None => 0,
        };
        let header = read_at(&mut main, 0, 100).unwrap_or_default();
        let wal_header = wal.as_mut().and_then(Header::read);
        let wal_page_size = wal_header.as_ref().map(|header| header.page_size);
        let page_size = PageSize::find(&mut main, main_bytes, &header, wal_page_size);
        let wal_header = wal_header.filter(|header| header.page_size == page_size.bytes);
        let frames = match &mut wal {
            Some(wal) => Frames::read(wal, wal_bytes, wal_header.as_ref(), page_size.bytes),
            None => Frames::default(),
        };
        let mut store = Self {
            main,
            main_bytes,
            wal,
            wal_bytes,
            frames,
            page_size,
            usable: page_size.bytes,
            reads_failed: 0,
        };
        let header = store.page(1, Origin::Wal).unwrap_or_default();
        let reserved = reserved(&header);
        store.usable = usable(&mut store.main, main_bytes, page_size.bytes, reserved);
        Ok(store)
    }

    pub(super) fn page_size(&self) -> PageSize {
        self.page_size
    }

    pub(super) fn wal_state(&self) -> WalState {
        self.frames.state
    }

    pub(super) fn reads_failed(&self) -> u64 {
        self.reads_failed
    }

    /// Bytes of a page that rows may use.
    pub(super) fn usable(&self) -> usize {
        self.usable
    }

    /// Bytes of both files: no record can be longer.
    pub(super) fn len(&self) -> u64 {
        self.main_bytes.saturating_add(self.wal_bytes)
    }

    /// Pages of the main file, the last of which may be cut.
    pub(super) fn main_pages(&self) -> u32 {
        let pages = self.main_bytes.div_ceil(self.page_size.bytes as u64);
        u32::try_from(pages).unwrap_or(u32::MAX)
    }

    /// True if a page is beyond the end that the latest commit gave the database.
    pub(super) fn is_beyond(&self, page: u32) -> bool {
        let pages = self.frames.database_pages;
        pages > 0 && page > pages
    }

    /// Copy of a page that SQLite would read.
    pub(super) fn current_origin(&self, page: u32) -> Origin {
        if self.frames.good.contains_key(&page) {
            Origin::Wal
        } else {
            Origin::Main
        }
    }

    /// Copies of pages outside the trees of the main file's current pages.
    pub(super) fn other_copies(&self) -> Vec<PageCopy> {
        let pages = self.main_pages();
        let beyond = pages.saturating_add(1)..;
        let grown = self.frames.good.range(beyond).map(|(&page, _)| PageCopy {
            page,
            origin: Origin::Wal,
            current: true,
        });
        let past = self.frames.past_damage.keys().map(|&page| PageCopy {
            page,
            origin: Origin::WalPastDamage,
            current: false,
        });
        let under = self.frames.good.range(..=pages).map(|(&page, _)| PageCopy {
            page,
            origin: Origin::Main,
            current: false,
        });
        grown.chain(past).chain(under).collect()
    }

    /// Page as a writer to `origin` saw it: its copy there, or else the one below. Short at the end of a cut file; `None`
    /// beyond the end, or if the disk cannot read it.
    pub(super) fn page(&mut self, page: u32, origin: Origin) -> Option<Vec<u8>> {
        let size = self.page_size.bytes;
        let past = match origin {
            Origin::WalPastDamage => self.frames.past_damage.get(&page),
            Origin::Wal | Origin::Main => None,
        };
        let frame = match origin {
            Origin::WalPastDamage | Origin::Wal => past.or_else(|| self.frames.good.get(&page)),
            Origin::Main => None,
        };
        let read = match (frame, &mut self.wal) {
            (Some(&offset), Some(wal)) => read_at(wal, offset, size),
            _ => {
                let offset = u64::from(page.checked_sub(1)?) * size as u64;
                if offset >= self.main_bytes {
                    return None;
                }
                read_at(&mut self.main, offset, size)
            }
        };
        if read.is_err() {
            self.reads_failed += 1;
        }
        read.ok()
    }
}

/// Bytes of a record, from the leaf along its overflow pages.
pub(super) struct Payload<'a, F> {
    store: &'a mut Store<F>,
    origin: Origin,
    local: &'a [u8],
    page: Vec<u8>,
    at: usize,
    next: u32,
    beyond: u64,
}

impl<'a, F: Read + Seek> Payload<'a, F> {
    /// Record that starts with `local`, on pages as a writer to `origin` saw them.
    pub(super) fn new(
        store: &'a mut Store<F>,
        origin: Origin,
        local: &'a [u8],
        cell: &Cell,
    ) -> Self {
        Self {
            store,
            origin,
            local,
            page: Vec::new(),
            at: 0,
            next: cell.overflow,
            beyond: cell.payload.saturating_sub(local.len() as u64),
        }
    }

    /// Next `bytes` bytes, at most those of the record; `None` if the chain of overflow pages breaks.
    pub(super) fn take(&mut self, bytes: usize) -> Option<Vec<u8>> {
        let mut taken = Vec::new();
        taken.try_reserve_exact(bytes).ok()?;
        while taken.len() < bytes {
            if self.local.is_empty() && self.at == self.page.len() {
                self.next_page()?;
            }
            let wanted = bytes - taken.len();
            if self.local.is_empty() {
                let run = wanted.min(self.page.len() - self.at);
                taken.extend_from_slice(self.page.get(self.at..self.at + run)?);
                self.at += run;
            } else {
                let (run, rest) = self.local.split_at(wanted.min(self.local.len()));
                taken.extend_from_slice(run);
                self.local = rest;
            }
        }
        Some(taken)
    }

    /// Moves to the next overflow page. A chain has exactly the pages that its record needs, and the link of the last
    /// one is 0: so a chain with a loop is rejected, and none is followed beyond the length of the record.
    fn next_page(&mut self) -> Option<()> {
        if self.next < 2 || self.beyond == 0 {
            return None;
        }
        let mut page = self.store.page(self.next, self.origin)?;
        page.truncate(self.store.usable);
        self.next = be32(&page, 0)?;
        let run = self.beyond.min(self.store.usable as u64 - 4);
        self.beyond -= run;
        if (self.beyond == 0) != (self.next == 0) {
            return None;
        }
        page.truncate(4 + run as usize);
        self.page = page;
        self.at = 4;
        (self.page.len() as u64 == 4 + run).then_some(())
    }
}
