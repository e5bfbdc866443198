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

/// The outcome of an order, or its refusal at once.
fn outcome(order: &ExportOrder) -> Outcome {
    let mut exporter = Exporter::default();
    let usual = Export::default();
    match exporter.begin((1, 2), order, painting([96, 64]), &usual, 0) {
        Ok(()) => wait(&mut exporter),
        Err(Refusal { what, advice }) => Outcome::Refused { what, advice },
    }
}

/// An order to a file in a folder.
fn order(folder: &Path, name: &str) -> ExportOrder {
    let path = folder.join(name).display().to_string();
    ExportOrder::to(WholePath::new(path).expect("whole"))
}

#[test]
fn every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let heads: [(&str, &str, &[u8]); 6] = [
        ("a.png", "", b"\x89PNG"),
        ("a.exr", "", &[0x76, 0x2f, 0x31, 0x01]),
        ("a.ora", "", b"PK"),
        ("h.png", "height", b"\x89PNG"),
        ("gloss.png", "gloss", b"\x89PNG"),
        ("a.stl", "", b"Maulstick"),
    ];
    for (name, format, head) in heads {
        let order = ExportOrder {
            format: format.to_owned(),
            ..order(folder.path(), name)
        };
        let outcome = outcome(&order);
        assert!(matches!(outcome, Outcome::Done { .. }), "{outcome:?}");
        let bytes = std::fs::read(folder.path().join(name)).expect("written");
        assert!(
            bytes.starts_with(head) || name == "a.stl" && bytes.len() > 84,
            "{name}: {:?}",
            &bytes[..9]
        );
    }
}

#[test]
fn refuses_what_is_no_export() {
    let folder = tempfile::tempdir().expect("a folder");
    let order = |name: &str| order(folder.path(), name);
    let profile = ExportOrder {
        profile: "own.icc".into(),
        ..order("a.png")
    };
    let beside = ExportOrder {
        format: "png".into(),
        ..order("a.maul-wal")
    };
    let step = ExportOrder {
        exaggeration: -1.0,
        ..order("b.stl")
    };
    for (order, quoted) in [
        (order("a.jpg"), "'jpg'"),
        (order("no/a.png"), "no/a.png"),
        (profile, "'own.icc'"),
        (beside, ""),
        (step, "-1"),
    ] {
        let Outcome::Refused { what, .. } = outcome(&order) else {
            panic!("{order:?}");
        };
        assert!(what.contains(quoted), "{what}");
    }
    let files = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(files.count(), 0);
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
    assert!(matches!(outcome, Outcome::Refused { .. }), "{outcome:?}");
    assert_eq!(std::fs::read(&path).expect("there"), BEFORE);
    assert_eq!(exporter.status(9), None);
    let files = std::fs::read_dir(folder.path()).expect("a folder");
    assert_eq!(files.count(), 1, "nothing half-written stays");
}
