//! Rows of a damaged SQLite file, read without SQLite.
//!
//! Every leaf page of a table gives its rows, whatever the state of the pages above it: neither the header nor the
//! schema nor an interior page is needed. A row does not name its table, so the caller distinguishes rows by their
//! values. Rows of freed pages, which the database had already deleted, are read as well, and perhaps older copies of a
//! row.
//!
//! Values are as SQLite stores them: an `INTEGER PRIMARY KEY` is NULL among the values and is the rowid; a whole number in
//! a REAL column may be an integer; columns that were added later are missing at the end. Text has to be UTF-8. Tables
//! `WITHOUT ROWID` and indices are not read.
//!
//! Source: "Database File Format", <https://sqlite.org/fileformat2.html>.

mod io;
mod leaf;
mod page_size;
mod record;
mod store;
mod tree;
mod wal;

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::File;
use std::io::{ErrorKind, Read, Result, Seek};
use std::ops::RangeInclusive;
use std::path::Path;

use leaf::Leaf;
pub use page_size::{PageSize, PageSizeFrom};
pub use record::Value;
pub use store::Origin;
use store::{PageCopy, Payload, Store};
pub use wal::WalState;

/// Row that was read completely.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Key in its table.
    pub rowid: i64,
    /// Columns in the order of the table.
    pub values: Vec<Value>,
    /// Its page, counted from 1.
    pub page: u32,
    /// Copy of that page that was read.
    pub origin: Origin,
    /// True if SQLite would read this copy of the page too: the frame of the WAL where the page has a good one,
    /// otherwise the main file; and the page is not free, where known ([`Scan::knows_free`]).
    pub current: bool,
}

/// Counts of a scan over the pages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Copies of pages read.
    pub pages: u64,
    /// Of these, leaves of tables.
    pub leaves: u64,
    /// Rows read completely.
    pub rows: u64,
    /// Rows on current leaves that did not parse. Rows of a page that no longer looks like a leaf are not counted.
    pub rows_lost: u64,
    /// Reads that failed on the disk.
    pub reads_failed: u64,
}

/// Scan of a database, row by row: `F` is a file, or its bytes in a cursor.
///
/// Reading never panics. Memory holds a row, a page and a list of the WAL's pages; for a row's blobs and texts it is at
/// most the size of the files.
pub struct Scan<F> {
    store: Store<F>,
    tally: Tally,
    free: Option<BTreeSet<u32>>,
}

impl Scan<File> {
    /// Opens a database and the `-wal` beside it, if there is one. Both are only read.
    ///
    /// Do not open a file that this process has open in SQLite: on POSIX closing it again here
    /// would drop SQLite's locks.
    ///
    /// # Errors
    /// The main file or an existing WAL cannot be opened, or their lengths are unknown. Damage is never an error.
    pub fn open(main: &Path) -> Result<Self> {
        let mut wal = OsString::from(main);
        wal.push("-wal");
        let wal = match File::open(wal) {
            Ok(wal) => Some(wal),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        Self::new(File::open(main)?, wal)
    }
}

impl<F: Read + Seek> Scan<F> {
    /// Scan over the main file and its WAL. Reads the WAL once, and up to 4 MiB of the main file to test its header, or up
    /// to 256 MiB if the header is damaged.
    ///
    /// # Errors
    /// The length of a file is unknown. Damage is never an error.
    pub fn new(main: F, wal: Option<F>) -> Result<Self> {
        let mut store = Store::new(main, wal)?;
        let free = tree::free_pages(&mut store);
        Ok(Self {
            store,
            tally: Tally::default(),
            free,
        })
    }

    /// True if the list of free pages is intact. If not, deleted rows may count as current.
    pub fn knows_free(&self) -> bool {
        self.free.is_some()
    }

    /// Number of pages of the main file.
    pub fn pages(&self) -> u32 {
        self.store.main_pages()
    }

    /// Number of pages that the trees of the tables lead to but that are not pages of a table any more.
    pub fn lost_pages(&mut self) -> u64 {
        let roots = self.rows().filter(|row| row.current).filter_map(root);
        let mut wanted: BTreeSet<u32> = roots.collect();
        // The root page of the schema itself.
        wanted.insert(1);
        let beyond = self.store.other_copies();
        let beyond = beyond.iter().filter(|copy| copy.current);
        let pages = (1..=self.pages()).chain(beyond.map(|copy| copy.page));
        let pages: Vec<u32> = pages.filter(|page| !self.is_free(*page)).collect();
        for number in pages {
            let page = self.store.page(number, Origin::Wal).unwrap_or_default();
            wanted.extend(tree::children(&page, number).into_iter().flatten());
        }
        let store = &mut self.store;
        let lost = wanted.into_iter().filter(|number| {
            let page = store.page(*number, Origin::Wal);
            !page.is_some_and(|page| tree::is_of_table(&page, *number))
        });
        lost.count() as u64
    }

    fn is_free(&self, page: u32) -> bool {
        self.store.is_beyond(page) || self.free.as_ref().is_some_and(|free| free.contains(&page))
    }

    /// True if the file has a database's header.
    pub fn has_header(&self) -> bool {
        matches!(self.page_size().from, PageSizeFrom::Header)
    }

    /// Page size, and its source.
    pub fn page_size(&self) -> PageSize {
        self.store.page_size()
    }

    /// State of the WAL; all zeros without one.
    pub fn wal(&self) -> WalState {
        self.store.wal_state()
    }

    /// Counts of the latest [`rows`](Self::rows) so far.
    pub fn tally(&self) -> Tally {
        Tally {
            reads_failed: self.store.reads_failed(),
            ..self.tally
        }
    }

    /// Iterates over every row that parses: first those of the copies that SQLite would read and of free pages, in the
    /// order of the pages, then those of the other copies: frames past damage, and the main file's pages under frames of
    /// the WAL.
    pub fn rows(&mut self) -> Rows<'_, F> {
        self.tally = Tally::default();
        let pages = self.store.main_pages();
        let rest = self.store.other_copies();
        Rows {
            scan: self,
            main: 1..=pages,
            rest: rest.into_iter(),
            leaf: None,
        }
    }
}

/// Root page of a table, in a row of the schema.
fn root(row: Row) -> Option<u32> {
    match row.values.as_slice() {
        [Value::Text(kind), _, _, Value::Int(root), Value::Text(_)] if kind == "table" => {
            u32::try_from(*root).ok()
        }
        _ => None,
    }
}

/// Iterator over the rows of a [`Scan`].
pub struct Rows<'a, F> {
    scan: &'a mut Scan<F>,
    main: RangeInclusive<u32>,
    rest: std::vec::IntoIter<PageCopy>,
    leaf: Option<(PageCopy, Leaf<Vec<u8>>, usize)>,
}

impl<F: Read + Seek> Rows<'_, F> {
    fn next_copy(&mut self) -> Option<PageCopy> {
        if let Some(page) = self.main.next() {
            return Some(PageCopy {
                page,
                origin: self.scan.store.current_origin(page),
                current: !self.scan.is_free(page),
            });
        }
        let copy = self.rest.next()?;
        Some(PageCopy {
            current: copy.current && !self.scan.is_free(copy.page),
            ..copy
        })
    }

    fn row(&mut self, copy: PageCopy, leaf: &Leaf<Vec<u8>>, cell: usize) -> Option<Row> {
        let store = &mut self.scan.store;
        let cell = leaf.cell(cell, store.usable())?;
        if cell.payload > store.len() {
            return None;
        }
        let local = leaf.bytes(cell.local.clone())?;
        let mut payload = Payload::new(store, copy.origin, local, &cell);
        Some(Row {
            rowid: cell.rowid,
            values: record::read(cell.payload, local, |bytes| payload.take(bytes))?,
            page: copy.page,
            origin: copy.origin,
            current: copy.current,
        })
    }
}

impl<F: Read + Seek> Iterator for Rows<'_, F> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        loop {
            while let Some((copy, leaf, cell)) = self.leaf.take() {
                if cell == leaf.cells() {
                    break;
                }
                let row = self.row(copy, &leaf, cell);
                self.leaf = Some((copy, leaf, cell + 1));
                match row {
                    Some(row) => {
                        self.scan.tally.rows += 1;
                        return Some(row);
                    }
                    None => self.scan.tally.rows_lost += u64::from(copy.current),
                }
            }
            let copy = self.next_copy()?;
            self.scan.tally.pages += 1;
            let bytes = self.scan.store.page(copy.page, copy.origin);
            if let Some(leaf) = bytes.and_then(|bytes| Leaf::parse(bytes, copy.page)) {
                self.scan.tally.leaves += 1;
                self.leaf = Some((copy, leaf, 0));
            }
        }
    }
}
