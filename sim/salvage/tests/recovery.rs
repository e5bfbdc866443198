//! Intact parts of a damaged painting are recovered, and nothing that never existed.

#[path = "../../document/tests/easel/mod.rs"]
mod easel;
#[path = "../../document/tests/studio/mod.rs"]
mod studio;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::Cursor;
use std::path::{Path, PathBuf};

use easel::Easel;
use maulstick_canvas::quantum::SLOTS;
use maulstick_document::rows::place_number;
use maulstick_document::tables::checksum::Checksum;
use maulstick_document::tables::schema::Table;
use maulstick_document::{Access, DocumentError, DocumentSettings};
use maulstick_painting::history::TilePlace;
use maulstick_salvage::sqlite::{Row, Scan, Value};
use maulstick_salvage::{SalvageError, SalvageReport, recover};
use proptest::prelude::*;
use studio::{Dice, Painter, content, print, tiles};
use tempfile::TempDir;

/// Bytes of a page of the file.
const PAGE: usize = 8192;

/// A row's table and key.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Key {
    Number(i64, i64),
    Text(i64, String),
}

/// The rows that SQLite reads, by table and key.
struct Rows(HashMap<Key, Vec<Vec<Value>>>);

impl Rows {
    fn of(bytes: &[u8]) -> Self {
        let mut scan = Scan::new(Cursor::new(bytes), None).expect("memory");
        let mut rows: HashMap<Key, Vec<Vec<Value>>> = HashMap::new();
        let current: Vec<Row> = scan.rows().filter(|row| row.current).collect();
        for row in current {
            let key = match row.values.as_slice() {
                [Value::Int(tag), Value::Text(key), ..] => Key::Text(*tag, key.clone()),
                [Value::Int(tag), ..] => Key::Number(*tag, row.rowid),
                _ => continue,
            };
            rows.entry(key).or_default().push(row.values);
        }
        Self(rows)
    }

    fn has(&self, key: &Key, row: &Vec<Value>) -> bool {
        self.0.get(key).is_some_and(|rows| rows.contains(row))
    }
}

/// A painting in a closed file.
struct Painted {
    folder: TempDir,
    bytes: Vec<u8>,
    rows: Rows,
    painter: Painter,
    print: Vec<String>,
    tiles: BTreeMap<TilePlace, Vec<u64>>,
    /// All that ever lay on each tile.
    seen: BTreeMap<TilePlace, BTreeSet<Vec<u64>>>,
}

impl Painted {
    fn new(seed: u64, acts: usize) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.maul");
        let settings = DocumentSettings::new(&path, Access::Paint);
        let mut painter = Painter::new(seed);
        let mut easel = Easel::begin(&settings);
        let mut seen: BTreeMap<TilePlace, BTreeSet<Vec<u64>>> = BTreeMap::new();
        for _ in 0..acts {
            let act = painter.next();
            easel.act(&mut painter, &act);
            for (place, words) in tiles(&mut easel.sequencer) {
                seen.entry(place).or_default().insert(words);
            }
            // Content of a tile between two steps of one act.
            for step in easel.sequencer.painting().history().steps() {
                for (place, change) in &*step.tiles {
                    let known = seen.entry(*place).or_default();
                    known.extend([0, 1].map(|end| content(change.end(end))));
                }
            }
            if painter.dice.below(3) == 0 {
                easel.checkpoint();
            }
            if painter.dice.below(5) == 0 {
                easel.flush();
            }
        }
        let print = print(&mut easel.sequencer);
        let tiles = tiles(&mut easel.sequencer);
        easel.close();
        let bytes = std::fs::read(&path).expect("read");
        Self {
            folder,
            rows: Rows::of(&bytes),
            bytes,
            painter,
            print,
            tiles,
            seen,
        }
    }

    /// Recovers these bytes instead of its own into a new file.
    fn recover(&self, bytes: &[u8]) -> Result<(PathBuf, SalvageReport), SalvageError> {
        let damaged = self.folder.path().join("damaged.maul");
        let to = self.folder.path().join("new.maul");
        std::fs::write(&damaged, bytes).expect("written");
        std::fs::remove_file(&to).ok();
        let recovered = recover(&damaged, &to, &mut |done, all| assert!(done <= all));
        let there = std::fs::read(&damaged).expect("read");
        assert!(there == bytes, "the damaged file is only read");
        assert_eq!(to.exists(), recovered.is_ok());
        let files = std::fs::read_dir(self.folder.path()).expect("a folder");
        assert!(files.count() <= 3, "nothing else is left");
        Ok((to, recovered?))
    }

    /// True if nothing of a tile was damaged: its row, its page with the base, its dry layers with theirs.
    fn is_untouched(&self, place: TilePlace, damaged: &Rows) -> bool {
        let mut next = vec![Key::Number(6, place_number(place))];
        while let Some(key) = next.pop() {
            let Some([row]) = self.rows.0.get(&key).map(Vec::as_slice) else {
                return false;
            };
            if !damaged.has(&key, row) {
                return false;
            }
            let int = |column: usize| match row[column] {
                Value::Int(number) => number,
                _ => 0,
            };
            let leads = match row[0] {
                Value::Int(6) => [(3, int(3)), (4, int(4))],
                Value::Int(4) => [(4, int(2)), (3, int(4))],
                _ => [(3, int(2)), (3, 0)],
            };
            let leads = leads.into_iter().filter(|(_, id)| *id != 0);
            next.extend(leads.map(|(tag, id)| Key::Number(tag, id)));
        }
        true
    }

    /// What is wrong with what was recovered from these bytes.
    fn check(&self, damaged: &Rows, new: &Path, salvage: &SalvageReport) -> Result<(), Wrong> {
        let settings = DocumentSettings::new(new, Access::Paint);
        let mut easel = Easel::open(&settings).map_err(Wrong::Unreadable)?;
        print(&mut easel.sequencer);
        let found = tiles(&mut easel.sequencer);
        let none = Vec::new();
        for place in self.seen.keys().chain(found.keys()) {
            let was = self.tiles.get(place).unwrap_or(&none);
            let is = found.get(place).unwrap_or(&none);
            if was == is {
                continue;
            }
            if self.is_untouched(*place, damaged) {
                return Err(Wrong::Changed(*place));
            }
            let is_thin = salvage.thinned.contains(place);
            let seen = self.seen.get(place);
            if !(is.is_empty() || is_thin || seen.is_some_and(|seen| seen.contains(is))) {
                return Err(Wrong::Invented(*place));
            }
            let mut named = salvage.older.iter().chain(&salvage.missing);
            let key = Key::Number(6, place_number(*place));
            let row = self.rows.0.get(&key).and_then(|rows| rows.first());
            let has_row = row.is_some_and(|row| damaged.has(&key, row));
            if has_row && !is_thin && !named.any(|other| other == place) {
                return Err(Wrong::Unnamed(*place));
            }
        }
        // Painting and undo work on it.
        let mut painter = self.painter.clone();
        for _ in 0..5 {
            let act = painter.next();
            easel.act(&mut painter, &act);
            print(&mut easel.sequencer);
        }
        easel.undo_all();
        print(&mut easel.sequencer);
        easel.close();
        Easel::open(&settings).map(drop).map_err(Wrong::Unreadable)
    }

    /// What is wrong with what comes of these bytes.
    fn try_with(&self, bytes: &[u8]) -> Result<Option<SalvageReport>, Wrong> {
        let damaged = Rows::of(bytes);
        let has_state = ["painting", "painting copy"].iter().any(|key| {
            let state = Key::Text(1, (*key).to_owned());
            (self.rows.0[&state].iter()).all(|row| damaged.has(&state, row))
        });
        match self.recover(bytes) {
            Ok((new, salvage)) => {
                self.check(&damaged, &new, &salvage)?;
                Ok(Some(salvage))
            }
            Err(SalvageError::Lost(_) | SalvageError::Document(DocumentError::NoPainting))
                if !has_state =>
            {
                Ok(None)
            }
            Err(error) => Err(Wrong::Unreadable(error.to_string())),
        }
    }
}

/// A fault of what was recovered.
#[derive(Debug, PartialEq)]
enum Wrong {
    /// It cannot be opened.
    Unreadable(String),
    /// A tile was whole and is another.
    Changed(TilePlace),
    /// A tile never was so.
    Invented(TilePlace),
    /// A tile is another and not named.
    Unnamed(TilePlace),
}

/// Hurts a file somewhere.
fn hurt(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let at = |dice: &mut Dice, length: usize| dice.below(length as u64) as usize;
    let length = bytes.len();
    match dice.below(5) {
        0 => bytes.truncate(at(dice, length)),
        1 => {
            let page = at(dice, length / PAGE);
            bytes[page * PAGE..(page + 1) * PAGE].fill(0);
        }
        2 => {
            let from = at(dice, length);
            let to = (from + at(dice, 4 * PAGE)).min(length);
            bytes[from..to].fill_with(|| dice.below(256) as u8);
        }
        _ => {
            for _ in 0..1 + dice.below(30) {
                let bit = dice.below(8);
                let byte = at(dice, length);
                bytes[byte] ^= 1 << bit;
            }
        }
    }
}

proptest! {
    #![proptest_config(studio::cases(8))]

    #[test]
    fn what_is_whole_comes_back(seed in any::<u64>(), acts in 1usize..40) {
        let painted = Painted::new(seed, acts);
        let mut dice = Dice::new(seed ^ 0xdeed);
        for _ in 0..6 {
            let mut bytes = painted.bytes.clone();
            for _ in 0..1 + dice.below(2) {
                if bytes.len() > PAGE {
                    hurt(&mut bytes, &mut dice);
                }
            }
            let tried = painted.try_with(&bytes);
            prop_assert!(tried.is_ok(), "{tried:?}");
        }
    }

    #[test]
    fn of_a_whole_painting_nothing_is_missing(seed in any::<u64>(), acts in 1usize..40) {
        let painted = Painted::new(seed, acts);
        let (new, salvage) = painted.recover(&painted.bytes).expect("recovered");
        prop_assert!(salvage.is_whole(), "{salvage:?}");
        prop_assert_eq!(salvage.tiles, painted.tiles.len() as u64);
        let mut easel = Easel::open(&DocumentSettings::new(&new, Access::Paint)).expect("opened");
        let found = print(&mut easel.sequencer);
        for (one, two) in found.iter().zip(&painted.print) {
            prop_assert_eq!(one, two);
        }
        prop_assert_eq!(found.len(), painted.print.len());
        easel.undo_all();
        let store = easel.sequencer.painting().store(0).expect("a canvas");
        prop_assert_eq!(store.counts(), [0; SLOTS], "all is undone");
    }

    /// A file that was not closed, with its log and records to replay.
    #[test]
    fn a_painting_that_was_not_closed_comes_back(seed in any::<u64>(), acts in 1usize..40) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let mut painter = Painter::new(seed);
        let mut easel = Easel::begin(&DocumentSettings::new(&path("a.maul"), Access::Paint));
        for _ in 0..acts {
            let act = painter.next();
            easel.act(&mut painter, &act);
            if painter.dice.below(4) == 0 {
                easel.checkpoint();
            }
        }
        easel.flush();
        let damaged = |name: &str| {
            std::fs::copy(path("a.maul"), path(name)).expect("copied");
            let wal = std::fs::read(path("a.maul-wal")).expect("a log");
            std::fs::write(path(&format!("{name}-wal")), &wal).expect("written");
            wal
        };
        let wal = damaged("b.maul");
        let salvage = recover(&path("b.maul"), &path("c.maul"), &mut |_, _| {}).expect("recovered");
        prop_assert!(salvage.is_whole(), "{salvage:?}");
        let mut again = Easel::open(&DocumentSettings::new(&path("c.maul"), Access::Paint)).expect("opened");
        prop_assert_eq!(print(&mut again.sequencer), print(&mut easel.sequencer));
        drop(again);
        let mut dice = Dice::new(seed);
        for number in 0..4 {
            let (name, to) = (format!("d{number}.maul"), path(&format!("e{number}.maul")));
            damaged(&name);
            let mut hurt_wal = wal.clone();
            hurt(&mut hurt_wal, &mut dice);
            std::fs::write(path(&format!("{name}-wal")), &hurt_wal).expect("written");
            match recover(&path(&name), &to, &mut |_, _| {}) {
                Ok(_) => {
                    let settings = DocumentSettings::new(&to, Access::Paint);
                    let mut again = Easel::open(&settings).expect("opened");
                    print(&mut again.sequencer);
                    again.undo_all();
                    print(&mut again.sequencer);
                }
                Err(SalvageError::Lost(_) | SalvageError::Document(DocumentError::NoPainting)) => {}
                Err(error) => prop_assert!(false, "{error}"),
            }
            let left = std::fs::read(path(&format!("{name}-wal"))).expect("read");
            prop_assert!(left == hurt_wal, "the log is only read");
        }
    }
}

#[test]
fn any_page_of_the_file_may_go() {
    let painted = Painted::new(5, 60);
    let mut damaged = 0;
    let pages = painted.bytes.len() / PAGE;
    let step = pages.div_ceil(20);
    for page in (0..pages).step_by(step) {
        let mut bytes = painted.bytes.clone();
        bytes[page * PAGE..(page + 1) * PAGE].fill(0);
        let tried = painted
            .try_with(&bytes)
            .unwrap_or_else(|error| panic!("page {page}: {error:?}"));
        damaged += usize::from(tried.is_none_or(|salvage| !salvage.is_whole()));
    }
    assert!(damaged > 0);
}

#[test]
fn paint_that_never_was_is_seen() {
    let painted = Painted::new(5, 40);
    let (new, salvage) = painted.recover(&painted.bytes).expect("recovered");
    assert_eq!(painted.check(&painted.rows, &new, &salvage), Ok(()));
    let (new, salvage) = painted.recover(&painted.bytes).expect("recovered");
    let db = rusqlite::Connection::open(&new).expect("opens");
    // Two tiles change places: each row is whole.
    let two =
        "SELECT place, version, page, dry FROM tile WHERE page > 0 AND place < 1 << 40 LIMIT 2";
    let mut query = db.prepare(two).expect("SQL");
    let rows = query.query_map([], |row| {
        Ok([row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?])
    });
    let rows: Vec<[i64; 4]> = rows.expect("rows").map(|row| row.expect("a row")).collect();
    for (row, other) in [(rows[0], rows[1]), (rows[1], rows[0])] {
        let ints = [row[0], row[1], other[2], other[3]];
        let sum = Checksum::of_ints(Table::Tile, &ints);
        let update = "UPDATE tile SET page = ?2, dry = ?3, sum = ?4 WHERE place = ?1";
        let values = rusqlite::params![ints[0], ints[2], ints[3], sum];
        db.execute(update, values).expect("updated");
    }
    drop(query);
    drop(db);
    let wrong = painted.check(&painted.rows, &new, &salvage);
    assert!(
        wrong
            .as_ref()
            .is_err_and(|wrong| matches!(wrong, Wrong::Changed(_) | Wrong::Unnamed(_))),
        "{wrong:?}"
    );
}

#[test]
fn what_another_program_added_is_left_out() {
    let painted = Painted::new(5, 40);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("altered.maul");
    std::fs::write(&path, &painted.bytes).expect("written");
    let db = rusqlite::Connection::open(&path).expect("opens");
    let added = "CREATE TABLE mine(what TEXT); CREATE VIEW seen AS SELECT * FROM page; \
         CREATE TRIGGER t BEFORE INSERT ON journal BEGIN SELECT raise(ignore); END";
    db.execute_batch(added).expect("altered");
    db.close().expect("closed");
    let bytes = std::fs::read(&path).expect("read");
    let (new, salvage) = painted.recover(&bytes).expect("recovered");
    assert_eq!(painted.check(&painted.rows, &new, &salvage), Ok(()));
}

#[test]
fn nothing_is_written_over_and_nothing_made_of_nothing() {
    let painted = Painted::new(3, 5);
    let path = painted.folder.path().join("a.maul");
    let other = painted.folder.path().join("b.maul");
    let nobody = &mut |_, _| {};
    assert!(matches!(
        recover(&path, &path, nobody),
        Err(SalvageError::Document(DocumentError::Taken))
    ));
    std::fs::write(&other, b"mine").expect("written");
    assert!(matches!(
        recover(&path, &other, nobody),
        Err(SalvageError::Document(DocumentError::Taken))
    ));
    assert_eq!(std::fs::read(&other).expect("read"), b"mine");
    let new = painted.folder.path().join("c.maul");
    assert!(matches!(
        recover(&other, &new, nobody),
        Err(SalvageError::Document(DocumentError::NoPainting))
    ));
    let nowhere = painted.folder.path().join("d.maul");
    assert!(matches!(
        recover(&nowhere, &new, nobody),
        Err(SalvageError::Document(DocumentError::Missing))
    ));
    let settings = DocumentSettings::new(&path, Access::Paint);
    let easel = Easel::open(&settings).expect("opened");
    assert!(matches!(
        recover(&path, &new, nobody),
        Err(SalvageError::Document(DocumentError::InUse { .. }))
    ));
    easel.close();
    assert!(!new.exists());
}

/// Cases that once went wrong.
#[test]
fn what_was_lost_once_is_not_lost_again() {
    for (seed, acts) in [
        (17_672_387_863_968_454_319, 38),
        (4_922_705_410_365_251_054, 17),
    ] {
        let painted = Painted::new(seed, acts);
        let (_, salvage) = painted.recover(&painted.bytes).expect("recovered");
        assert!(salvage.is_whole(), "{seed}, {acts}: {salvage:?}");
    }
}
