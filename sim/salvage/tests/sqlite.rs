//! Rows come out of damaged files.

mod tables;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use maulstick_salvage::sqlite::{PageSizeFrom, Row, Scan, Value};
use proptest::prelude::{any, prop, proptest};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use rusqlite::Connection;
use tables::{Files, Tables, any_of, missing, right, tag};

#[test]
fn all_rows_come_out_whatever_the_page_size() {
    for page_size in [512, 1024, 4096, 16_384, 65_536] {
        let mut tables = Tables::new(page_size, 1);
        tables.fill(40);
        tables.fold();
        tables.fill(40);
        let folded_half = tables.files();
        assert!(folded_half.wal.as_ref().is_some_and(|wal| !wal.is_empty()));
        tables.fold();
        let folded = tables.files();
        for files in [folded_half, folded] {
            let mut scan = files.scan();
            assert_eq!(scan.page_size().bytes, page_size);
            assert_eq!(scan.page_size().from, PageSizeFrom::Header);
            assert!(!scan.wal().damaged);
            let current: Vec<Row> = scan.rows().filter(|row| row.current).collect();
            assert_eq!(scan.tally().rows_lost, 0);
            let tagged = current.iter().filter_map(tag);
            assert_eq!(tagged.count(), tables.rows.len(), "each row once");
            let schema = current.iter().filter(|row| row.page == 1).count();
            assert_eq!(schema, 2, "the schema's rows come out, too");
            let all = tables.rows.keys().cloned();
            assert_eq!(missing(&files, &tables.rows, all), [""; 0]);
        }
    }
}

#[test]
fn a_database_on_disk_is_read_with_the_wal_beside_it() {
    let mut tables = Tables::new(4096, 2);
    tables.fill(20);
    let copy = tempfile::tempdir().expect("a directory");
    let main = copy.path().join("b.maul");
    let files = tables.files();
    std::fs::write(&main, &files.main).expect("is written");
    std::fs::write(copy.path().join("b.maul-wal"), files.wal.expect("a WAL")).expect("is written");
    let mut scan = Scan::open(&main).expect("opens");
    assert_eq!(
        scan.rows().filter(|row| row.current).count(),
        2 + tables.rows.len()
    );
    assert!(Scan::open(&main.with_extension("none")).is_err());
}

#[test]
fn every_whole_number_keeps_its_value() {
    let mut tables = Tables::new(4096, 3);
    tables.fill(300);
    let widths: BTreeSet<u32> = tables
        .rows
        .values()
        .filter_map(|row| match row.values[2] {
            Value::Int(number) => Some(number.unsigned_abs().leading_zeros() / 8),
            _ => None,
        })
        .collect();
    assert_eq!(widths.len(), 9, "integers of all widths are among them");
    let all = tables.rows.keys().cloned();
    assert_eq!(missing(&tables.files(), &tables.rows, all), [""; 0]);
}

#[test]
fn what_is_left_after_deletions_comes_out() {
    let mut tables = Tables::new(1024, 4);
    tables
        .db
        .execute_batch("PRAGMA auto_vacuum = FULL; VACUUM")
        .expect("is packed");
    tables.fill(120);
    tables
        .db
        .execute("DELETE FROM tiles WHERE id % 3 = 0", [])
        .expect("are deleted");
    tables.fold();
    let left = tables.rows.iter();
    let left = left.filter(|(tag, row)| tag.starts_with("notes") || row.rowid % 3 != 0);
    let left: Vec<String> = left.map(|(tag, _)| tag.clone()).collect();
    assert_eq!(left.len(), 200);
    assert_eq!(
        missing(&tables.files(), &tables.rows, left.into_iter()),
        [""; 0]
    );
}

/// A folded database, and the pages of its rows.
struct Folded {
    tables: Tables,
    files: Files,
    pages: BTreeMap<String, BTreeSet<u32>>,
    page_size: usize,
}

impl Folded {
    fn new(page_size: usize, seed: u64) -> Self {
        let mut tables = Tables::new(page_size, seed);
        tables.fill(120);
        tables.fold();
        let files = tables.files();
        let pages = tables.pages();
        assert_eq!(pages.len(), tables.rows.len());
        Self {
            tables,
            files,
            pages,
            page_size,
        }
    }

    /// Every row none of whose pages `is_hurt` comes out of `files`; gives how many these are.
    fn assert_rest(&self, files: &Files, is_hurt: impl Fn(u32) -> bool) -> usize {
        let pages = self.pages.iter();
        let whole = pages.filter(|(_, pages)| !pages.iter().any(|page| is_hurt(*page)));
        let whole: Vec<String> = whole.map(|(tag, _)| tag.clone()).collect();
        let count = whole.len();
        assert_eq!(
            missing(files, &self.tables.rows, whole.into_iter()),
            [""; 0]
        );
        count
    }

    fn page_of(&self, byte: usize) -> u32 {
        (byte / self.page_size) as u32 + 1
    }
}

#[test]
fn a_cut_file_gives_the_rows_before_the_cut() {
    for page_size in [512, 4096, 65_536] {
        let folded = Folded::new(page_size, 5);
        let mut random = Pcg32::new(5, 2);
        let mut counts = BTreeSet::new();
        for _ in 0..15 {
            let cut = any_of(&mut random, folded.files.main.len());
            let mut files = folded.files.clone();
            files.main.truncate(cut);
            counts.insert(folded.assert_rest(&files, |page| page >= folded.page_of(cut)));
        }
        assert!(counts.len() > 5 && counts.last() > Some(&50), "{counts:?}");
    }
}

#[test]
fn flipped_bits_cost_only_the_rows_on_their_pages() {
    for page_size in [512, 4096, 65_536] {
        let folded = Folded::new(page_size, 6);
        let mut random = Pcg32::new(6, 2);
        let mut most = 0;
        for flips in [1, 1, 2, 5, 10, 20, 50, 100, 200, 1000] {
            let mut files = folded.files.clone();
            let mut hurt = BTreeSet::new();
            for _ in 0..flips {
                let at = any_of(&mut random, files.main.len());
                files.main[at] ^= 1 << (random.next_u32() % 8);
                hurt.insert(folded.page_of(at));
            }
            most = most.max(folded.assert_rest(&files, |page| hurt.contains(&page)));
        }
        assert!(most > 200, "{most}");
    }
}

#[test]
fn zeroed_pages_cost_only_their_rows() {
    for page_size in [512, 4096] {
        let folded = Folded::new(page_size, 7);
        let mut random = Pcg32::new(7, 2);
        let all = folded.files.main.len() / page_size;
        for zeroed in [1, 3, 10, 30, 100] {
            let mut files = folded.files.clone();
            let mut hurt = BTreeSet::from([1]);
            files.main[..page_size].fill(0);
            for _ in 0..zeroed {
                let page = any_of(&mut random, all);
                files.main[page * page_size..][..page_size].fill(0);
                hurt.insert(page as u32 + 1);
            }
            assert_eq!(files.scan().page_size().bytes, page_size);
            folded.assert_rest(&files, |page| hurt.contains(&page));
        }
    }
}

#[test]
fn no_byte_of_the_header_is_needed() {
    for page_size in [512, 1024, 2048, 4096, 8192, 16_384, 32_768, 65_536] {
        let folded = Folded::new(page_size, 8);
        let mut zeroed = folded.files.clone();
        zeroed.main[..100].fill(0);
        let guessed = zeroed.scan().page_size();
        assert_eq!(
            (guessed.bytes, guessed.from),
            (page_size, PageSizeFrom::Guess)
        );
        let all = folded.assert_rest(&zeroed, |_| false);
        assert_eq!(all, folded.tables.rows.len());

        // Another page size that could be, and reserved space that could be.
        let mut lying = folded.files.clone();
        let other: u16 = if page_size == 4096 { 8192 } else { 4096 };
        lying.main[16..18].copy_from_slice(&other.to_be_bytes());
        folded.assert_rest(&lying, |_| false);
        let mut reserved = folded.files.clone();
        reserved.main[20] = 32;
        folded.assert_rest(&reserved, |_| false);
    }
    let folded = Folded::new(4096, 8);
    let mut random = Pcg32::new(8, 2);
    for at in 0..100 {
        let mut files = folded.files.clone();
        files.main[at] = files.main[at].wrapping_add(1 + any_of(&mut random, 255) as u8);
        folded.assert_rest(&files, |_| false);
    }
}

/// Space at the end of each page that some extensions keep from rows: a database without tables is
/// given it by its header and the end of its only page's content.
#[test]
fn reserved_space_is_not_taken_for_rows() {
    let dir = tempfile::tempdir().expect("a directory");
    let path = dir.path().join("a.maul");
    let db = Connection::open(&path).expect("opens");
    let made = "PRAGMA page_size = 1024; PRAGMA user_version = 1";
    db.execute_batch(made).expect("is made");
    drop(db);
    let mut main = std::fs::read(&path).expect("stands");
    main[20] = 24;
    main[105..107].copy_from_slice(&1000_u16.to_be_bytes());
    std::fs::write(&path, &main).expect("is written");
    let db = Connection::open(&path).expect("opens");
    let made = "CREATE TABLE t (n INTEGER, body BLOB);
        WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c WHERE n < 200)
        INSERT INTO t SELECT n, randomblob(n * 30) FROM c";
    db.execute_batch(made).expect("is made");
    let mut stored = db.prepare("SELECT n, body FROM t").expect("stands");
    let stored = stored.query_map([], |row| {
        Ok(vec![Value::Int(row.get(0)?), Value::Blob(row.get(1)?)])
    });
    let stored: Vec<Vec<Value>> = stored
        .expect("answers")
        .map(|row| row.expect("stands"))
        .collect();
    let mut scan = Scan::open(&path).expect("opens");
    let mut out: Vec<Row> = scan.rows().filter(|row| row.values.len() == 2).collect();
    out.sort_by_key(|row| row.rowid);
    let out: Vec<Vec<Value>> = out.into_iter().map(|row| row.values).collect();
    assert_eq!(stored.len(), 200);
    assert!(out == stored);
}

/// Chains with a loop in them, or two rows' chains in one.
#[test]
fn overflow_chains_that_run_astray_end() {
    let folded = Folded::new(512, 13);
    let mut random = Pcg32::new(13, 2);
    let all = folded.files.main.len() / 512;
    let chained = folded.pages.values().filter(|pages| pages.len() > 2);
    for pages in chained.take(60) {
        let mut files = folded.files.clone();
        let links: Vec<u32> = pages.iter().copied().collect();
        let from = links[1 + any_of(&mut random, links.len() - 1)];
        let kind = random.next_u32() % 3;
        let to = match kind {
            0 => links[any_of(&mut random, links.len())],
            1 => any_of(&mut random, all) as u32,
            _ => random.next_u32(),
        };
        files.main[(from as usize - 1) * 512..][..4].copy_from_slice(&to.to_be_bytes());
        if kind == 0 {
            let mut scan = files.scan();
            let mut tagged = scan.rows().filter(|row| tag(row).is_some());
            assert!(tagged.all(|row| right(&row, &folded.tables.rows).is_some()));
        }
        folded.assert_rest(&files, |page| page == from);
    }
}

/// Reads everything there is; no row has more bytes than the files.
fn exhaust(main: &[u8], wal: Option<&[u8]>) {
    let length = main.len() + wal.map_or(0, <[u8]>::len);
    let mut scan = Scan::new(Cursor::new(main), wal.map(Cursor::new)).expect("memory");
    let mut rows = 0;
    for row in scan.rows() {
        rows += 1;
        let bytes = row.values.iter().map(|value| match value {
            Value::Text(text) => text.len(),
            Value::Blob(blob) => blob.len(),
            Value::Null | Value::Int(_) | Value::Real(_) => 0,
        });
        assert!(bytes.sum::<usize>() <= length);
    }
    assert_eq!(scan.tally().rows, rows);
    assert_eq!(scan.tally().reads_failed, 0);
}

proptest! {
    #[test]
    fn random_bytes_are_survived(
        main in prop::collection::vec(any::<u8>(), 0..20_000),
        wal in prop::option::of(prop::collection::vec(any::<u8>(), 0..9_000)),
    ) {
        exhaust(&main, wal.as_deref());
    }

    /// Random bytes with the beginnings of a database's pages.
    #[test]
    fn random_leaves_are_survived(
        mut main in prop::collection::vec(any::<u8>(), 4_000..20_000),
        power in 9_u32..=12,
        cells in any::<u8>(),
    ) {
        let size = 1_usize << power;
        for page in main.chunks_mut(size) {
            let header = [0x0D, 0, 0, 0, cells, 0, 0, 0];
            let room = page.len().min(header.len());
            page[..room].copy_from_slice(&header[..room]);
        }
        main[..16].copy_from_slice(b"SQLite format 3\0");
        main[16..18].copy_from_slice(&(size as u16).to_be_bytes());
        main[20..24].copy_from_slice(&[0, 64, 32, 32]);
        main[100] = 0x0D;
        exhaust(&main, None);
    }
}

#[test]
fn damage_of_any_kind_is_survived() {
    let mut tables = Tables::new(512, 14);
    tables.fill(25);
    tables.fold();
    tables.fill(10);
    let files = tables.files();
    let mut random = Pcg32::new(14, 2);
    for _ in 0..150 {
        let mut hurt = [files.main.clone(), files.wal.clone().expect("a WAL")];
        for bytes in &mut hurt {
            for _ in 0..1 << any_of(&mut random, 12) {
                let at = any_of(&mut random, bytes.len());
                // Starts of pages, where the structure is, more often than their contents.
                let at = if random.next_u32() & 1 == 0 {
                    at
                } else {
                    at / 512 * 512 + at % 16
                };
                let at = at.min(bytes.len() - 1);
                bytes[at] = random.next_u32() as u8;
            }
            if random.next_u32() & 3 == 0 {
                bytes.truncate(any_of(&mut random, bytes.len()));
            }
        }
        exhaust(&hurt[0], Some(&hurt[1]));
    }
}
