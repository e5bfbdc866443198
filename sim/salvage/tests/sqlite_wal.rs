//! Rows come out of a WAL, whole or damaged.

mod tables;

use std::collections::{BTreeMap, BTreeSet};

use maulstick_salvage::sqlite::{Origin, PageSizeFrom};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use tables::{Files, Tables, any_of, missing, right, tag};

/// The tags of the rows that SQLite would read, too.
fn current(files: &Files) -> BTreeSet<String> {
    let mut scan = files.scan();
    let current = scan.rows().filter(|row| row.current);
    current
        .filter_map(|row| tag(&row).map(str::to_owned))
        .collect()
}

/// A WAL of six transactions, none of it folded.
struct Logged {
    tables: Tables,
    files: Files,
    /// Bytes of the WAL when each row was committed.
    ends: Vec<(String, usize)>,
    page_size: usize,
}

const WAL_HEADER: usize = 32;
const FRAME_HEADER: usize = 24;

impl Logged {
    fn new(page_size: usize, seed: u64) -> Self {
        let mut tables = Tables::new(page_size, seed);
        let mut ends = Vec::new();
        for _ in 0..6 {
            let before: BTreeSet<String> = tables.rows.keys().cloned().collect();
            tables.db.execute_batch("BEGIN").expect("begins");
            tables.fill(10);
            tables.db.execute_batch("COMMIT").expect("is committed");
            let end = tables.files().wal.map_or(0, |wal| wal.len());
            let new = tables.rows.keys().filter(|tag| !before.contains(*tag));
            ends.extend(new.map(|tag| (tag.clone(), end)));
        }
        let files = tables.files();
        Self {
            tables,
            files,
            ends,
            page_size,
        }
    }

    fn frame_of(&self, byte: usize) -> usize {
        (byte - WAL_HEADER) / (FRAME_HEADER + self.page_size)
    }

    /// The page of each frame of the WAL.
    fn pages_of_frames(&self) -> Vec<u32> {
        let wal = self.files.wal.as_ref().expect("a WAL");
        let frames = wal[WAL_HEADER..].chunks_exact(FRAME_HEADER + self.page_size);
        frames
            .map(|frame| u32::from_be_bytes([frame[0], frame[1], frame[2], frame[3]]))
            .collect()
    }
}

#[test]
fn a_damaged_wal_is_used_up_to_the_damage() {
    let logged = Logged::new(4096, 10);
    let wal = logged.files.wal.clone().expect("a WAL");
    let mut random = Pcg32::new(10, 2);
    for turn in 0..40 {
        let mut files = logged.files.clone();
        let at = WAL_HEADER + any_of(&mut random, wal.len() - WAL_HEADER);
        let hurt = files.wal.as_mut().expect("a WAL");
        if turn % 2 == 0 {
            hurt[at] ^= 1 << (random.next_u32() % 8);
        } else {
            hurt.truncate(at);
        }
        let ends = logged.ends.iter().filter(|(_, end)| *end <= at);
        let before: BTreeSet<String> = ends.map(|(tag, _)| tag.clone()).collect();
        assert_eq!(current(&files), before);
        assert_eq!(
            missing(&files, &logged.tables.rows, before.into_iter()),
            [""; 0]
        );
    }
}

#[test]
fn what_stands_behind_the_damage_comes_out_apart() {
    let logged = Logged::new(4096, 11);
    let pages = logged.tables.pages();
    let frames = logged.pages_of_frames();
    let last: BTreeMap<u32, usize> = frames
        .iter()
        .zip(0..)
        .map(|(page, at)| (*page, at))
        .collect();
    let mut random = Pcg32::new(11, 2);
    let wal = logged.files.wal.clone().expect("a WAL");
    let later = logged.ends[logged.ends.len() - 21].1;
    for _ in 0..30 {
        let at = WAL_HEADER + any_of(&mut random, later - WAL_HEADER);
        let frame = logged.frame_of(at);
        let content = WAL_HEADER + frame * (FRAME_HEADER + logged.page_size) + FRAME_HEADER;
        let mut files = logged.files.clone();
        files.wal.as_mut().expect("a WAL")[at.max(content)] ^= 0x10;
        let whole = pages.iter();
        let whole = whole.filter(|(_, pages)| pages.iter().all(|page| last[page] != frame));
        let whole: BTreeSet<String> = whole.map(|(tag, _)| tag.clone()).collect();
        let mut scan = files.scan();
        let mut out = BTreeSet::new();
        for row in scan.rows() {
            assert!(!(row.current && row.origin == Origin::WalPastDamage));
            out.extend(right(&row, &logged.tables.rows));
        }
        assert!(scan.wal().damaged && scan.wal().frames_past_damage > 0);
        assert!(whole.is_subset(&out), "{:?}", whole.difference(&out));
    }
    // Without the WAL's header all frames but the first can still be verified.
    let mut files = logged.files.clone();
    files.wal = Some(wal);
    files.wal.as_mut().expect("a WAL")[..WAL_HEADER].fill(0);
    let mut scan = files.scan();
    let out: BTreeSet<String> = scan
        .rows()
        .filter_map(|row| tag(&row).map(str::to_owned))
        .collect();
    assert!(logged.tables.rows.keys().all(|tag| out.contains(tag)));
    assert_eq!(scan.wal().frames_good, 0);
}

#[test]
fn a_wal_gives_the_page_size_that_the_main_file_lost() {
    for page_size in [512, 8192, 65_536] {
        let mut logged = Logged::new(page_size, 12);
        logged.files.main.fill(0);
        let scan = logged.files.scan();
        assert_eq!(scan.page_size().bytes, page_size);
        assert_eq!(scan.page_size().from, PageSizeFrom::Wal);
        let all = logged.tables.rows.keys().cloned();
        assert_eq!(missing(&logged.files, &logged.tables.rows, all), [""; 0]);
    }
}

#[test]
fn an_unfinished_transaction_is_not_current() {
    let mut tables = Tables::new(4096, 15);
    tables.fill(10);
    let committed = tables.rows.clone();
    let length = |files: &Files| files.wal.as_ref().map_or(0, Vec::len);
    let before = length(&tables.files());
    // A small cache spills uncommitted pages into the WAL.
    let begin = "PRAGMA cache_size = 10; BEGIN";
    tables.db.execute_batch(begin).expect("begins");
    tables.fill(30);
    let unfinished = tables.files();
    assert!(length(&unfinished) > before + 50 * 4096, "is spilled");
    assert_eq!(unfinished.scan().wal().frames_past_damage, 0);
    assert!(current(&unfinished).iter().eq(committed.keys()));

    // Later writes overwrite the first of these frames.
    tables.db.execute_batch("ROLLBACK").expect("is rolled back");
    tables.rows = committed;
    tables.insert("notes", 20);
    let files = tables.files();
    assert_eq!(length(&files), length(&unfinished));
    assert!(current(&files).iter().eq(tables.rows.keys()));
    assert_eq!(
        missing(&files, &tables.rows, tables.rows.keys().cloned()),
        [""; 0]
    );
}
