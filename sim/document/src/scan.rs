//! Rows out of a damaged SQLite file, read without SQLite.
//!
//! Every page that stands as a leaf of a table gives its rows, whatever became of the pages above
//! it: neither the header nor the schema nor an interior page is needed. A row says nothing of the
//! table it was in, so the caller tells rows apart by their values. Rows of freed pages, which the
//! database had already deleted, come out as well, and so may older copies of a row.
//!
//! As SQLite stores them, which the caller has to know: an `INTEGER PRIMARY KEY` is NULL among the
//! values and is the rowid; a whole number in a REAL column may be an integer; columns that were
//! added later are missing at the end. Text is taken as UTF-8. Tables `WITHOUT ROWID` and indices
//! are not read.
//!
//! Source: "Database File Format", <https://sqlite.org/fileformat2.html>.

mod format;
mod leaf;
mod record;
mod store;
mod tree;
mod wal;

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read, Seek};
use std::ops::RangeInclusive;
use std::path::Path;

pub use format::{PageSize, PageSizeFrom};
use leaf::Leaf;
use store::{Payload, Store};

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// NULL.
    Null,
    /// A whole number.
    Int(i64),
    /// A floating-point number.
    Real(f64),
    /// Text that is UTF-8; a row with other text is damaged.
    Text(String),
    /// Bytes.
    Blob(Vec<u8>),
}

/// Copy of a page that a row was read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// The main file.
    Main,
    /// A committed frame of the WAL, with nothing damaged before it.
    Wal,
    /// A frame of the WAL with a damaged one before it or in its transaction. Its own checksum is
    /// right, but SQLite would not read it, and its transaction may never have been acknowledged.
    WalPastDamage,
}

/// A row that was read whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The row's key in its table.
    pub rowid: i64,
    /// The columns in the order of the table.
    pub values: Vec<Value>,
    /// The page it stands on, counted from 1.
    pub page: u32,
    /// Copy of that page.
    pub origin: Origin,
    /// True if SQLite would read this copy of the page too: the frame of the WAL where the page has a good one,
    /// otherwise the main file; and the page is not free, as far as that is known ([`Scan::knows_free`]).
    pub current: bool,
}

/// Counts of a walk over the pages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Copies of pages looked at.
    pub pages: u64,
    /// Of these, leaves of tables.
    pub leaves: u64,
    /// Rows that came out.
    pub rows: u64,
    /// Rows on current leaves that did not parse whole. Rows of a page that no longer looks like a
    /// leaf are in no count.
    pub rows_lost: u64,
    /// Reads that the disk refused.
    pub reads_failed: u64,
}

/// State of the WAL.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WalState {
    /// Committed frames before any damage: those SQLite would read.
    pub frames_good: u64,
    /// Committed frames with a right checksum behind a damaged one.
    pub frames_past_damage: u64,
    /// True if bytes of this WAL's own are damaged, as far as that can be seen: a power cut in the middle of a commit
    /// looks the same, and a damaged end looks like an unfinished commit.
    pub damaged: bool,
}

/// A database that is to be read row by row: `F` is a file, or its bytes in a cursor.
///
/// Reading never panics. It keeps a row, a page and a list of the WAL's pages, and asks for no more
/// memory for a row's blobs and texts than the files have bytes.
pub struct Scan<F> {
    store: Store<F>,
    tally: Tally,
    free: Option<BTreeSet<u32>>,
}

impl Scan<File> {
    /// Opens a database and, where it stands beside it, its `-wal`. Both are only read.
    ///
    /// Do not open a file that this process has open in SQLite: on POSIX closing it again here
    /// would drop SQLite's locks.
    ///
    /// # Errors
    /// The main file cannot be opened, the WAL is there and cannot be, or their lengths cannot be
    /// told. Damage is never an error.
    pub fn open(main: &Path) -> io::Result<Self> {
        let mut wal = OsString::from(main);
        wal.push("-wal");
        let wal = match File::open(wal) {
            Ok(wal) => Some(wal),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        Self::new(File::open(main)?, wal)
    }
}

impl<F: Read + Seek> Scan<F> {
    /// A scan over the main file and its WAL. Reads the WAL through once, and of the main file up to 4
    /// MiB to see whether its header says the truth, or up to 256 MiB where the header is damaged.
    ///
    /// # Errors
    /// The length of a file cannot be told. Damage is never an error.
    pub fn new(main: F, wal: Option<F>) -> io::Result<Self> {
        let mut store = Store::new(main, wal)?;
        let free = tree::free_pages(&mut store);
        Ok(Self {
            store,
            tally: Tally::default(),
            free,
        })
    }

    /// True if the list of free pages is intact. If not, rows that the database had deleted may pass for current ones.
    pub fn knows_free(&self) -> bool {
        self.free.is_some()
    }

    /// Pages of the main file.
    pub fn pages(&self) -> u32 {
        self.store.main_pages()
    }

    /// Number of pages that the trees of the tables lead to but that are no longer pages of a table. Their rows, if
    /// any, are not known.
    pub fn lost_pages(&mut self) -> u64 {
        let roots = self.rows().filter(|row| row.current).filter_map(root);
        let mut wanted: BTreeSet<u32> = roots.collect();
        // Without a schema its own page is one of them.
        wanted.insert(1);
        let beyond = self.store.stops_of_wal();
        let beyond = beyond.iter().filter(|stop| stop.current);
        let pages = (1..=self.pages()).chain(beyond.map(|stop| stop.page));
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

    /// True if the file begins as a database does.
    pub fn has_header(&self) -> bool {
        matches!(self.page_size().from, PageSizeFrom::Header)
    }

    /// The page size, and how it became known.
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

    /// Walks over all pages and gives every row that parses whole: first those of the copies that
    /// SQLite would read and of free pages, in the order of the pages, then those of the copies that
    /// SQLite would not read: frames past damage, and the main file's pages under frames of the WAL.
    pub fn rows(&mut self) -> Rows<'_, F> {
        self.tally = Tally::default();
        let pages = self.store.main_pages();
        let rest = self.store.stops_of_wal();
        Rows {
            scan: self,
            main: 1..=pages,
            rest: rest.into_iter(),
            leaf: None,
        }
    }
}

/// The root page of a table, in a row of the schema.
fn root(row: Row) -> Option<u32> {
    match row.values.as_slice() {
        [Value::Text(kind), _, _, Value::Int(root), Value::Text(_)] if kind == "table" => {
            u32::try_from(*root).ok()
        }
        _ => None,
    }
}

/// A copy of a page to be looked at.
#[derive(Debug, Clone, Copy)]
struct Stop {
    page: u32,
    origin: Origin,
    current: bool,
}

/// The rows of a [`Scan`].
pub struct Rows<'a, F> {
    scan: &'a mut Scan<F>,
    main: RangeInclusive<u32>,
    rest: std::vec::IntoIter<Stop>,
    leaf: Option<(Stop, Leaf<Vec<u8>>, usize)>,
}

impl<F: Read + Seek> Rows<'_, F> {
    fn next_stop(&mut self) -> Option<Stop> {
        if let Some(page) = self.main.next() {
            return Some(Stop {
                page,
                origin: self.scan.store.current_origin(page),
                current: !self.scan.is_free(page),
            });
        }
        let stop = self.rest.next()?;
        Some(Stop {
            current: stop.current && !self.scan.is_free(stop.page),
            ..stop
        })
    }

    fn row(&mut self, stop: Stop, leaf: &Leaf<Vec<u8>>, cell: usize) -> Option<Row> {
        let store = &mut self.scan.store;
        let cell = leaf.cell(cell, store.usable())?;
        if cell.payload > store.len() {
            return None;
        }
        let local = leaf.bytes(cell.local.clone())?;
        let mut payload = Payload::new(store, stop.origin, local, &cell);
        Some(Row {
            rowid: cell.rowid,
            values: record::read(cell.payload, local, |bytes| payload.take(bytes))?,
            page: stop.page,
            origin: stop.origin,
            current: stop.current,
        })
    }
}

impl<F: Read + Seek> Iterator for Rows<'_, F> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        loop {
            while let Some((stop, leaf, cell)) = self.leaf.take() {
                if cell == leaf.cells() {
                    break;
                }
                let row = self.row(stop, &leaf, cell);
                self.leaf = Some((stop, leaf, cell + 1));
                match row {
                    Some(row) => {
                        self.scan.tally.rows += 1;
                        return Some(row);
                    }
                    None => self.scan.tally.rows_lost += u64::from(stop.current),
                }
            }
            let stop = self.next_stop()?;
            self.scan.tally.pages += 1;
            let bytes = self.scan.store.page(stop.page, stop.origin);
            if let Some(leaf) = bytes.and_then(|bytes| Leaf::parse(bytes, stop.page)) {
                self.scan.tally.leaves += 1;
                self.leaf = Some((stop, leaf, 0));
            }
        }
    }
}
