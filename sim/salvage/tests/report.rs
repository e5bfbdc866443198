//! A report names the losses of an edited file, and nothing else.

#[path = "../../document/tests/easel/mod.rs"]
mod easel;
#[path = "../../document/tests/studio/mod.rs"]
mod studio;

use std::path::Path;

use easel::Easel;
use maulstick_document::tables::schema::VERSION;
use maulstick_document::{Access, DocumentSettings};
use maulstick_salvage::{SalvageReport, recover};
use rusqlite::Connection;
use studio::Painter;

/// A painting in a closed file, changed by these statements, and recovered.
fn recovered(folder: &Path, statements: &str) -> SalvageReport {
    let [path, to] = ["a.maul", "b.maul"].map(|name| folder.join(name));
    let mut easel = Easel::begin(&DocumentSettings::new(&path, Access::Paint));
    let mut painter = Painter::new(5);
    for _ in 0..12 {
        let act = painter.next();
        easel.act(&mut painter, &act);
    }
    easel.close();
    let open = Connection::open(&path).expect("opened");
    open.execute_batch(statements).expect("written");
    open.close().expect("closed");
    recover(&path, &to, &mut |_, _| {}).expect("recovered")
}

#[test]
fn a_wrong_bit_in_one_copy_of_the_state_costs_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = recovered(
        folder.path(),
        "UPDATE state SET value = replace(value, 'canvas', 'conves') WHERE key = 'sequencer';
         UPDATE state SET value = value || ' ' WHERE key = 'painting'",
    );
    assert!(!report.is_old && report.missing.is_empty(), "{report:?}");
    assert!(report.rows > 0, "a fault would pass: {report:?}");
}

#[test]
fn a_newer_programs_painting_is_not_called_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let newer = format!(
        "PRAGMA journal_mode = DELETE; PRAGMA user_version = {}",
        VERSION + 1
    );
    let report = recovered(folder.path(), &newer);
    assert_eq!(report.format, Some(VERSION + 1));
    assert!(!report.is_whole());
}
