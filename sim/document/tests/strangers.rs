//! A painting's file changed by another program: its contents are not executed, and the change is reported.

mod easel;
mod studio;

use std::path::Path;

use easel::Easel;
use maulstick_canvas::dry::DRY_LAYERS_MOST;
use maulstick_document::{
    Access, Document, DocumentError, DocumentSettings, DocumentStats, glance,
};
use rusqlite::{Connection, params};
use studio::{Painter, print};

fn settings(path: &Path, access: Access) -> DocumentSettings {
    DocumentSettings::new(path, access)
}

/// A closed painting with some paint; returns its state.
fn painted(path: &Path) -> Vec<String> {
    let mut easel = Easel::begin(&settings(path, Access::Paint));
    let mut painter = Painter::new(3);
    for _ in 0..12 {
        let act = painter.next();
        easel.act(&mut painter, &act);
    }
    let seen = print(&mut easel.sequencer);
    easel.close();
    seen
}

fn alter(path: &Path, statements: &str) {
    let open = Connection::open(path).expect("opened");
    open.execute_batch(statements).expect("altered");
    open.close().expect("closed");
}

/// The error of opening a file, if all attempts are refused alike.
fn refused(path: &Path) -> String {
    let mut said: Vec<String> = [Access::Paint, Access::Read]
        .into_iter()
        .filter_map(|access| Document::open(&settings(path, access)).err())
        .chain(glance(path).err())
        .chain(DocumentStats::read(path).err())
        .map(|error| match error {
            DocumentError::Altered(what) => what,
            other => format!("something else: {other}"),
        })
        .collect();
    assert_eq!(said.len(), 4, "{said:?}");
    said.dedup();
    said.join("; ")
}

#[test]
fn tables_that_are_not_a_paintings_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = folder.path().join("whole.maul");
    let seen = painted(&whole);
    for (statements, what) in [
        (
            "CREATE TRIGGER t BEFORE INSERT ON journal BEGIN SELECT raise(ignore); END",
            "trigger 't'",
        ),
        ("CREATE VIEW v AS SELECT * FROM page", "view 'v'"),
        (
            "ALTER TABLE page RENAME TO pages; CREATE VIEW page AS \
             WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) \
             SELECT 3 AS tag, id, 0 AS base, 0 AS depth, 1 AS slots, x'' AS data, 0 AS sum FROM n",
            "'page",
        ),
        ("CREATE TABLE mine(what TEXT)", "table 'mine'"),
        (
            "CREATE VIRTUAL TABLE found USING fts5(what)",
            "table 'found",
        ),
        ("CREATE INDEX i ON tile(hex(place))", "index 'i'"),
        (
            "ALTER TABLE journal ADD COLUMN more INTEGER",
            "table 'journal'",
        ),
        ("DROP INDEX page_base", "index 'page_base'"),
        ("DROP TABLE load", "'load'"),
    ] {
        let path = folder.path().join("altered.maul");
        std::fs::copy(&whole, &path).expect("copied");
        let open = Connection::open(&path).expect("opened");
        if open.execute_batch(statements).is_err() && statements.contains("fts5") {
            // SQLite was built without it.
            continue;
        }
        open.close().expect("closed");
        let before = std::fs::read(&path).expect("there");
        let said = refused(&path);
        assert!(said.contains(what), "{statements}: {said}");
        assert!(std::fs::read(&path).expect("there") == before, "it stays");
        std::fs::remove_file(&path).expect("removed");
    }
    let mut easel = Easel::open(&settings(&whole, Access::Paint)).expect("its own tables");
    assert_eq!(print(&mut easel.sequencer), seen);
}

#[test]
fn statistics_and_a_vacuum_of_sqlite_alter_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let seen = painted(&path);
    alter(&path, "VACUUM; PRAGMA optimize; ANALYZE");
    let mut easel = Easel::open(&settings(&path, Access::Paint)).expect("a painting");
    assert_eq!(print(&mut easel.sequencer), seen);
}

#[test]
fn more_dry_layers_than_a_tile_can_have_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    painted(&path);
    let open = Connection::open(&path).expect("opened");
    let page: i64 = open
        .query_row("SELECT min(id) FROM page", params![], |row| row.get(0))
        .expect("a page");
    open.execute_batch("BEGIN").expect("begun");
    for number in 1..=100_000i64 {
        let id = (1 << 40) + number;
        let below = if number == 1 { 0 } else { id - 1 };
        let ints = [id, below, 1, page];
        let sum = {
            let mut hasher = crc32fast::Hasher::new();
            hasher.update(&4i64.to_le_bytes());
            ints.iter()
                .for_each(|int| hasher.update(&int.to_le_bytes()));
            i64::from(hasher.finalize())
        };
        open.prepare_cached("INSERT INTO dry VALUES(4, ?1, ?2, ?3, ?4, ?5)")
            .expect("prepared")
            .execute(params![ints[0], ints[1], ints[2], ints[3], sum])
            .expect("written");
    }
    open.execute_batch("COMMIT").expect("written");
    open.close().expect("closed");
    let error = Document::open(&settings(&path, Access::Read)).expect_err("too many");
    let most = DRY_LAYERS_MOST.to_string();
    assert!(matches!(error, DocumentError::Damaged(what) if what.contains(&most)));
}
