//! A painting that is only read stays unchanged, and the cost of one wrong bit.

mod studio;

use std::path::Path;
use std::sync::Arc;

use maulstick_document::error::RowKind;
use maulstick_document::{
    Access, Checkpoint, Document, DocumentError, DocumentSettings, DocumentStats, glance,
};
use rusqlite::{Connection, params};
use studio::{Painter, equip, print, sequencer};

/// A closed painting with some paint; returns its state.
fn painted(path: &Path) -> Vec<String> {
    let settings = DocumentSettings::new(path, Access::Paint);
    let (document, _) = Document::open(&settings).expect("begun");
    let mut kept = sequencer(Arc::clone(document.pager()));
    equip(&mut kept);
    let mut painter = Painter::new(3);
    for _ in 0..12 {
        let act = painter.next();
        painter.act(&mut kept, &act);
    }
    document.write_checkpoint(Checkpoint::of(&mut kept, 0));
    let print = print(&mut kept);
    document.close().expect("closed");
    print
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("there")
}

#[test]
fn another_programs_database_stays_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("places.sqlite");
    let foreign = Connection::open(&path).expect("begun");
    foreign
        .execute_batch("CREATE TABLE place(name TEXT); INSERT INTO place VALUES('here')")
        .expect("written");
    foreign.close().expect("closed");
    let before = bytes(&path);
    let refused = |error: Option<DocumentError>| matches!(error, Some(DocumentError::NoPainting));
    assert!(refused(glance(&path).err()));
    assert!(refused(DocumentStats::read(&path).err()));
    for access in [Access::Paint, Access::Read] {
        let settings = DocumentSettings::new(&path, access);
        assert!(refused(Document::open(&settings).err()));
    }
    assert!(bytes(&path) == before);
    let names = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(names.count(), 1, "nothing lies beside it");
}

/// Changes the rows of a closed painting.
fn harmed(path: &Path, statement: &str) {
    let open = Connection::open(path).expect("opened");
    assert!(open.execute(statement, params![]).expect("changed") > 0);
    open.close().expect("closed");
}

#[test]
fn a_painting_that_turns_out_to_be_damaged_leaves_no_journal() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    painted(&path);
    harmed(&path, "UPDATE page SET sum = sum + 1");
    let settings = DocumentSettings::new(&path, Access::Paint);
    let (document, opened) = Document::open(&settings).expect("its rows are there");
    let opened = opened.expect("a painting");
    let since = opened.snapshot().versions;
    let mut kept = opened.sequencer().expect("nothing was read");
    kept.painting_mut().keep("before").expect("kept");
    document.write_checkpoint(Checkpoint::of(&mut kept, since));
    document.flush();
    assert!(
        path.with_extension("maul-wal").exists(),
        "a fault would pass"
    );
    kept.painting_mut().report();
    assert!(document.pager().fault().is_some(), "it is damaged");
    document.close().ok();
    let names = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(names.count(), 1, "nothing lies beside it");
}

#[test]
fn rows_that_were_deleted_are_missed() {
    let folder = tempfile::tempdir().expect("a folder");
    let checked = |statement: &str| {
        let path = folder.path().join("a.maul");
        std::fs::remove_file(&path).ok();
        painted(&path);
        if !statement.is_empty() {
            harmed(&path, statement);
        }
        let settings = DocumentSettings::new(&path, Access::Read);
        let (document, opened) = Document::open(&settings).expect("it can be opened");
        let checked = opened.expect("a painting").check();
        document.close().expect("closed");
        checked
    };
    assert!(checked("").is_ok());
    for (statement, kind) in [
        (
            "DELETE FROM tile WHERE place = (SELECT max(place) FROM tile)",
            RowKind::Tiles,
        ),
        ("DELETE FROM tile", RowKind::Tiles),
        (
            "DELETE FROM step WHERE id = (SELECT max(id) FROM step)",
            RowKind::Steps,
        ),
        (
            "DELETE FROM step WHERE id = (SELECT min(id) FROM step)",
            RowKind::Steps,
        ),
    ] {
        let error = checked(statement).expect_err(statement);
        assert!(
            matches!(error, DocumentError::Rows { rows, found, written } if rows == kind && found < written),
            "{error:?}"
        );
    }
}

#[test]
fn looking_at_a_painting_that_was_not_closed_leaves_its_journal() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    painted(&path);
    let open = Connection::open(&path).expect("opened");
    open.execute_batch("PRAGMA wal_autocheckpoint = 0; UPDATE tile SET version = version + 1")
        .expect("written");
    let killed = folder.path().join("killed.maul");
    let journal = |path: &Path| path.with_extension("maul-wal");
    std::fs::copy(&path, &killed).expect("copied");
    std::fs::copy(journal(&path), journal(&killed)).expect("copied");
    let before = [bytes(&killed), bytes(&journal(&killed))];
    assert!(before[1].len() > 1000);
    assert!(glance(&killed).expect("a painting"));
    DocumentStats::read(&killed).expect("read");
    assert!([bytes(&killed), bytes(&journal(&killed))] == before);
    // The damage is reported, and the journal is still there.
    let settings = DocumentSettings::new(&killed, Access::Paint);
    assert!(matches!(
        Document::open(&settings).err(),
        Some(DocumentError::Damaged(_))
    ));
    assert!(bytes(&journal(&killed)) == before[1]);
}

#[test]
fn a_wrong_bit_in_the_state_costs_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let before = painted(&path);
    let open = Connection::open(&path).expect("opened");
    open.execute(
        "UPDATE state SET value = replace(value, 'canvas', 'conves') WHERE key = ?1",
        params!["sequencer"],
    )
    .expect("written");
    open.execute(
        "UPDATE state SET value = value || ' ' WHERE key = ?1",
        params!["painting"],
    )
    .expect("written");
    open.close().expect("closed");
    let settings = DocumentSettings::new(&path, Access::Read);
    let (document, opened) = Document::open(&settings).expect("opened");
    let mut sequencer = opened.expect("a painting").sequencer().expect("whole");
    assert_eq!(print(&mut sequencer), before);
    document.close().expect("closed");
}

#[test]
fn reading_a_painting_that_was_not_closed_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.maul");
    let before = painted(&path);
    let open = Connection::open(&path).expect("opened");
    open.execute_batch(
        "PRAGMA wal_autocheckpoint = 0; INSERT INTO shown VALUES(10, 99, 1, 1, x'00', 0)",
    )
    .expect("written");
    let killed = folder.path().join("killed.maul");
    let journal = |path: &Path| path.with_extension("maul-wal");
    std::fs::copy(&path, &killed).expect("copied");
    std::fs::copy(journal(&path), journal(&killed)).expect("copied");
    let files = || [bytes(&killed), bytes(&journal(&killed))];
    let left = files();
    let settings = DocumentSettings::new(&killed, Access::Read);
    let (document, opened) = Document::open(&settings).expect("opened");
    let mut sequencer = opened.expect("a painting").sequencer().expect("whole");
    assert_eq!(print(&mut sequencer), before);
    document.close().expect("closed");
    assert!(files() == left);
}
