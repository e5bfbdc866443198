//! Exports are whole files, refused in words, or stopped.

use maulstick_types::values::WholePath;
use std::time::{Duration, Instant};

use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;

use super::*;

fn painting(cells: [u32; 2]) -> Painting {
    let setup = PaintingSetup {
        cells,
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    Painting::new(&setup, library).expect("a painting")
}

fn wait(exporter: &mut Exporter) -> Outcome {
    let give_up = Instant::now() + Duration::from_secs(120);
    loop {
        if let Some((asker, outcome)) = exporter.ended() {
            assert_eq!(asker, (1, 2));
            return outcome;
        }
        assert!(Instant::now() < give_up, "it does not end");
        std::thread::yield_now();
    }
}

fn whole(folder: &tempfile::TempDir, name: &str) -> WholePath {
    WholePath::new(folder.path().join(name).display().to_string()).expect("whole")
}

fn begin(exporter: &mut Exporter, order: &ExportOrder) -> Result<(), Refusal> {
    exporter.begin((1, 2), order, painting([96, 64]), &Export::default(), 0)
}

#[test]
fn every_format_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| whole(&folder, name);
    let mut exporter = Exporter::default();
    let heads: [(&str, &str, &[u8]); 5] = [
        ("a.png", "", b"\x89PNG"),
        ("a.exr", "", &[0x76, 0x2f, 0x31, 0x01]),
        ("a.ora", "", b"PK"),
        ("h.png", "height", b"\x89PNG"),
        ("a.stl", "", b"Maulstick"),
    ];
    for (name, format, head) in heads {
        let order = ExportOrder {
            format: format.to_owned(),
            ..ExportOrder::to(at(name))
        };
        begin(&mut exporter, &order).expect("begun");
        let outcome = wait(&mut exporter);
        assert!(matches!(outcome, Outcome::Done { .. }), "{outcome:?}");
        let bytes = std::fs::read(at(name).as_str()).expect("written");
        assert!(
            bytes.starts_with(head) || name == "a.stl" && bytes.len() > 84,
            "{name}: {:?}",
            &bytes[..9]
        );
    }
}

#[test]
fn an_order_that_cannot_be_carried_out_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| whole(&folder, name);
    let mut exporter = Exporter::default();
    let refused = |order: ExportOrder, words: [&str; 2]| {
        let mut exporter = Exporter::default();
        let said = match begin(&mut exporter, &order) {
            Err(refusal) => format!("{}; {}", refusal.what, refusal.advice),
            Ok(()) => match wait(&mut exporter) {
                Outcome::Refused { what, advice } => format!("{what}; {advice}"),
                done => unreachable!("{done:?}"),
            },
        };
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    refused(
        ExportOrder::to(at("a.jpg")),
        ["'jpg'", ".png, .exr, .ora, .stl or .glb"],
    );
    refused(ExportOrder::to(at("no/a.png")), ["no/a.png", "folder"]);
    let profile = ExportOrder {
        profile: "own.icc".into(),
        ..ExportOrder::to(at("a.png"))
    };
    refused(profile, ["'own.icc'", "display-p3"]);
    let beside = ExportOrder {
        format: "png".into(),
        ..ExportOrder::to(at("a.maul-wal"))
    };
    refused(beside, ["may belong to a painting", "another name"]);
    let step = ExportOrder {
        exaggeration: -1.0,
        ..ExportOrder::to(at("b.stl"))
    };
    begin(&mut exporter, &step).expect("seen later");
    let outcome = wait(&mut exporter);
    assert!(matches!(outcome, Outcome::Refused { .. }), "{outcome:?}");
    assert!(!Path::new(at("b.stl").as_str()).exists());
}

#[test]
fn an_export_that_is_stopped_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.png");
    const BEFORE: &[u8] = b"\x89PNG\r\n\x1a\nbefore";
    std::fs::write(&path, BEFORE).expect("written");
    let order = ExportOrder::to(WholePath::new(path.display().to_string()).expect("whole"));
    let mut exporter = Exporter::default();
    let usual = Export::default();
    assert!(exporter.stop().is_err(), "nothing to stop");
    exporter
        .begin((1, 2), &order, painting([2048, 2048]), &usual, 5)
        .expect("begun");
    let status = exporter.status(7).expect("it goes on");
    assert_eq!((status.path, status.since_ns), (order.path.to_string(), 2));
    let second = exporter.begin((1, 3), &order, painting([64, 64]), &usual, 5);
    assert!(second.expect_err("one at a time").what.contains("a.png"));
    exporter.stop().expect("stopped");
    let outcome = wait(&mut exporter);
    let Outcome::Refused { what, .. } = outcome else {
        unreachable!("it was stopped: {outcome:?}");
    };
    assert!(what.contains("was stopped"), "{what}");
    assert_eq!(std::fs::read(&path).expect("there"), BEFORE);
    assert_eq!(exporter.status(9), None);
    let files = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(files.count(), 1, "nothing half-written stays");
}
