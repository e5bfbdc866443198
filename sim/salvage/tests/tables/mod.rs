//! A database with rows of all kinds, and, from SQLite itself, the pages of each row.

#![allow(
    dead_code,
    reason = "every test binary compiles this module and uses its own part of it"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use maulstick_salvage::sqlite::{Row, Scan, Value};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use rusqlite::{Connection, params};
use tempfile::TempDir;

/// The two tables: rows of any length, and short ones.
pub(crate) const TABLES: [&str; 2] = ["tiles", "notes"];

/// Values to store under a row's tag.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stored {
    pub(crate) rowid: i64,
    pub(crate) values: Vec<Value>,
}

/// An open database whose WAL is not folded, unless [`fold`](Self::fold) is called.
pub(crate) struct Tables {
    dir: TempDir,
    pub(crate) db: Connection,
    pub(crate) rows: BTreeMap<String, Stored>,
    random: Pcg32,
}

/// The files as they stand.
#[derive(Clone)]
pub(crate) struct Files {
    pub(crate) main: Vec<u8>,
    pub(crate) wal: Option<Vec<u8>>,
}

/// Tag that distinguishes rows; `None` for the schema's own.
pub(crate) fn tag(row: &Row) -> Option<&str> {
    match row.values.as_slice() {
        [Value::Null, Value::Text(tag), _, _, Value::Blob(_)] => Some(tag),
        _ => None,
    }
}

/// The tags of `wanted` without an exact copy.
pub(crate) fn missing(
    files: &Files,
    stored: &BTreeMap<String, Stored>,
    wanted: impl Iterator<Item = String>,
) -> Vec<String> {
    let mut scan = files.scan();
    let found: BTreeSet<String> = scan.rows().filter_map(|row| right(&row, stored)).collect();
    wanted.filter(|tag| !found.contains(tag)).collect()
}

/// The row's tag, if it is exactly as stored.
pub(crate) fn right(row: &Row, stored: &BTreeMap<String, Stored>) -> Option<String> {
    let tag = tag(row)?;
    let stored = stored.get(tag)?;
    (stored.rowid == row.rowid && stored.values == row.values).then(|| tag.to_owned())
}

pub(crate) fn any_of(random: &mut Pcg32, count: usize) -> usize {
    random.next_u32() as usize % count
}

impl Files {
    pub(crate) fn scan(&self) -> Scan<Cursor<&[u8]>> {
        let wal = self.wal.as_deref().map(Cursor::new);
        Scan::new(Cursor::new(self.main.as_slice()), wal).expect("memory has a length")
    }
}

impl Tables {
    pub(crate) fn new(page_size: usize, seed: u64) -> Self {
        let dir = tempfile::tempdir().expect("a directory");
        let db = Connection::open(dir.path().join("a.maul")).expect("opens");
        db.execute_batch(&format!(
            "PRAGMA page_size = {page_size}; PRAGMA locking_mode = EXCLUSIVE;
             PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0; PRAGMA synchronous = OFF;
             CREATE TABLE tiles (id INTEGER PRIMARY KEY, tag TEXT, n INTEGER, x REAL, body BLOB);
             CREATE TABLE notes (id INTEGER PRIMARY KEY, tag TEXT, n INTEGER, x REAL, body BLOB);"
        ))
        .expect("is made");
        Self {
            dir,
            db,
            rows: BTreeMap::new(),
            random: Pcg32::new(seed, 1),
        }
    }

    /// Stores `count` more rows in each table, the tiles with blobs of 10 bytes to 200 kB.
    pub(crate) fn fill(&mut self, count: usize) {
        for _ in 0..count {
            let octave = self.random.next_u32() % 15;
            let bytes = (10 << octave) + self.random.next_u32() as usize % (10 << octave);
            self.insert("tiles", bytes.min(200_000));
            self.insert("notes", self.rows.len() % 30);
        }
    }

    pub(crate) fn insert(&mut self, table: &str, bytes: usize) {
        let random = &mut self.random;
        let tag = format!("{table} {}", self.rows.len());
        let shift = random.next_u32() % 64;
        let number = random.next_u64().cast_signed() >> shift;
        let real =
            (!random.next_u32().is_multiple_of(3)).then(|| f64::from(random.next_u32()) + 0.5);
        let mut body = vec![0; bytes];
        random.fill_bytes(&mut body);
        let insert = format!("INSERT INTO {table} (tag, n, x, body) VALUES (?, ?, ?, ?)");
        let mut insert = self.db.prepare_cached(&insert).expect("stands");
        let rowid = insert
            .insert(params![tag, number, real, body])
            .expect("is stored");
        let values = vec![
            Value::Null,
            Value::Text(tag.clone()),
            Value::Int(number),
            real.map_or(Value::Null, Value::Real),
            Value::Blob(body),
        ];
        self.rows.insert(tag, Stored { rowid, values });
    }

    /// Folds the WAL into the main file and leaves it empty.
    pub(crate) fn fold(&self) {
        let folded = self
            .db
            .query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |row| row.get(0));
        assert_eq!(folded, Ok(0));
    }

    pub(crate) fn files(&self) -> Files {
        let read = |name: &str| std::fs::read(self.dir.path().join(name)).ok();
        Files {
            main: read("a.maul").expect("stands"),
            wal: read("a.maul-wal"),
        }
    }

    /// The leaf and the overflow pages of each row, by SQLite's `dbstat`: the cells of the leaves in
    /// the order of their paths are the rows in the order of their keys, and the overflow pages of
    /// cell `c` of the leaf at `path` are at `path`, `c` as three hexadecimal digits, `+`, a number.
    pub(crate) fn pages(&self) -> BTreeMap<String, BTreeSet<u32>> {
        let mut pages = BTreeMap::new();
        for table in TABLES {
            let keys = format!("SELECT tag FROM {table} ORDER BY id");
            let mut keys = self.db.prepare(&keys).expect("stands");
            let tags = keys.query_map([], |row| row.get(0)).expect("answers");
            let mut tags = tags.map(|tag| tag.expect("is text"));
            let mut stat = self
                .db
                .prepare(
                    "SELECT path, pageno, pagetype, ncell FROM dbstat WHERE name = ? ORDER BY path",
                )
                .expect("dbstat is there");
            let all: Vec<(String, u32, String, u32)> = stat
                .query_map([table], |row| {
                    Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?))
                })
                .expect("answers")
                .collect::<Result<_, _>>()
                .expect("answers");
            let mut chains: BTreeMap<&str, BTreeSet<u32>> = BTreeMap::new();
            for (path, page, _, _) in &all {
                if let Some((cell, _)) = path.split_once('+') {
                    chains.entry(cell).or_default().insert(*page);
                }
            }
            for (path, page, _, cells) in all.iter().filter(|all| all.2 == "leaf") {
                for cell in 0..*cells {
                    let mut on = BTreeSet::from([*page]);
                    let chain = format!("{path}{cell:03x}");
                    on.extend(chains.get(chain.as_str()).into_iter().flatten());
                    let tag: String = tags.next().expect("a row for each cell");
                    pages.insert(tag, on);
                }
            }
            assert_eq!(tags.next(), None, "a cell for each row");
        }
        pages
    }
}
