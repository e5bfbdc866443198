//! A painting of schema 6, with names of steps and decisions in words, is read and painted on.

mod easel;
mod studio;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use easel::Easel;
use maulstick_document::tables::schema::VERSION;
use maulstick_document::{Access, Document, DocumentSettings, DocumentStats};
use maulstick_painting::edits::Undo;
use maulstick_painting::history::TilePlace;
use maulstick_painting::sequencer::{Accepted, Sequencer};
use maulstick_types::paint::{Decision, Entry, StepName};
use studio::tiles;

/// Painted with a program whose journal entries had version 11: a film of paint that was dried, a stroke and a return
/// to a version.
const PAINTING: &[u8] = include_bytes!("schema_6.maul.zst");

fn unpacked(folder: &Path) -> PathBuf {
    let path = folder.join("a.maul");
    let bytes = zstd::decode_all(PAINTING).expect("packed");
    std::fs::write(&path, bytes).expect("written");
    path
}

/// Decisions of its record, and true if its replay paints on the same tiles; the paint differs, because bristles are now
/// disordered in another way.
fn record(path: &Path) -> (Vec<Decision>, bool) {
    let settings = DocumentSettings::new(path, Access::Read);
    let (document, opened) = Document::open(&settings).expect("opened");
    let opened = opened.expect("a painting");
    let mut again = opened.first().expect("whole").expect("a record");
    let (mut decisions, mut next) = (Vec::new(), again.serial());
    while let Some(row) = document.record_row(next).expect("intact") {
        for record in row.records {
            next += 1;
            if let Accepted::Entry(Entry::Decision { what }) = &record.what {
                decisions.push(what.clone());
            }
            again.replay(record);
        }
    }
    drop(document);
    let (_document, opened) = Document::open(&settings).expect("opened");
    let opened = opened.expect("a painting");
    let painted = |sequencer: &mut Sequencer| -> BTreeSet<TilePlace> {
        assert_eq!(sequencer.painting_mut().report().quanta_missing, 0);
        tiles(sequencer).into_keys().collect()
    };
    let is_on_same_tiles = painted(&mut again) == painted(&mut opened.sequencer().expect("whole"));
    (decisions, is_on_same_tiles)
}

fn steps(easel: &Easel) -> Vec<StepName> {
    let steps = easel.sequencer.painting().history().steps();
    steps.map(|step| step.what.clone()).collect()
}

#[test]
fn its_record_is_executed_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = unpacked(folder.path());
    let stats = DocumentStats::read(&path).expect("read");
    stats.check(&path, &mut |_, _| {}).expect("whole");
    let (decisions, is_on_same_tiles) = record(&path);
    assert_eq!(decisions, [const { Decision::Resumed }; 3]);
    assert!(is_on_same_tiles);
}

#[test]
fn its_steps_have_names_and_it_is_painted_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = unpacked(folder.path());
    let settings = DocumentSettings::new(&path, Access::Paint);
    let mut easel = Easel::open(&settings).expect("opened");
    let named = [
        StepName::Fill,
        StepName::Dry,
        StepName::LayerOpacity,
        StepName::Load {
            paints: vec!["Bone Black".to_owned(), "Titanium White".to_owned()],
        },
        StepName::Stroke {
            kind: "round".to_owned(),
            on_palette: false,
        },
        StepName::Return {
            version: "first".to_owned(),
        },
    ];
    assert_eq!(steps(&easel), named);
    let undone = easel.sequencer.edit(Undo { brush: None });
    undone.expect("the return is undone");
    easel.close();

    let stats = DocumentStats::read(&path).expect("read");
    assert_eq!(stats.format, VERSION);
    let (decisions, is_on_same_tiles) = record(&path);
    assert_eq!(decisions.len(), 4, "the record did not begin anew");
    assert!(is_on_same_tiles);
    let easel = Easel::open(&settings).expect("opened");
    assert_eq!(steps(&easel), named);
}
