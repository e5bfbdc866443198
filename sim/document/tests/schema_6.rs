//! A painting of schema 6, with names of steps and decisions in words, is read and painted on.

mod easel;
mod studio;

use std::path::{Path, PathBuf};

use easel::Easel;
use maulstick_document::tables::schema::VERSION;
use maulstick_document::{Access, Document, DocumentSettings, DocumentStats};
use maulstick_painting::edits::Undo;
use maulstick_painting::sequencer::{Accepted, Sequencer};
use maulstick_types::paint::{Decision, Entry, StepName};

/// Painted with a program whose journal entries had version 11: a film of paint that was dried, a stroke and a return
/// to a version.
const PAINTING: &[u8] = include_bytes!("schema_6.maul.zst");

fn unpacked(folder: &Path) -> PathBuf {
    let path = folder.join("a.maul");
    let bytes = zstd::decode_all(PAINTING).expect("packed");
    std::fs::write(&path, bytes).expect("written");
    path
}

/// Most by which the wet paint of its replay differs, as a share: bristles are now disordered in another way.
const APART: f64 = 0.15;

/// Volumes of dry and of wet paint on its canvas, m³.
fn volumes(sequencer: &mut Sequencer) -> [f64; 2] {
    let report = sequencer.painting_mut().report();
    assert_eq!(report.quanta_missing, 0);
    ["dry", "canvas"].map(|account| report.accounts_m3[account])
}

/// Decisions of its record, and true if its replay, with or without the states of its brush, has its paint.
fn record(path: &Path, with_states: bool) -> (Vec<Decision>, bool) {
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
            if with_states || matches!(record.what, Accepted::Entry(_)) {
                again.replay(record);
            }
        }
    }
    drop(document);
    let (_document, opened) = Document::open(&settings).expect("opened");
    let opened = opened.expect("a painting");
    let [dry, wet] = volumes(&mut again);
    let [own_dry, own_wet] = volumes(&mut opened.sequencer().expect("whole"));
    (
        decisions,
        dry == own_dry && (wet / own_wet - 1.0).abs() < APART,
    )
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
    let (decisions, is_alike) = record(&path, true);
    assert_eq!(decisions, [const { Decision::Resumed }; 3]);
    assert!(is_alike && !record(&path, false).1, "a fault passes");
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
    let (decisions, is_alike) = record(&path, true);
    assert_eq!(decisions.len(), 4, "the record did not begin anew");
    assert!(is_alike);
    let easel = Easel::open(&settings).expect("opened");
    assert_eq!(steps(&easel), named);
}
