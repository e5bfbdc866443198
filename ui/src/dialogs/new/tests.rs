use maulstick_types::values::ValueError;

use super::*;
use crate::test_support::overlay_bench::picture;

fn asked(change: impl FnOnce(&mut NewPainting)) -> Result<Command, DialogFault> {
    let mut new = NewPainting::kept_in(
        "/nowhere/Painting".into(),
        Units::Metric,
        UnsavedState::default(),
    );
    new.as_sketch = true;
    change(&mut new);
    new.command()
}

fn is_no_cells(fault: &DialogFault) -> bool {
    matches!(fault, DialogFault::NoCells)
}

#[test]
fn numbers_out_of_range_are_told_with_what_to_do() {
    let width = |text: &str| asked(|new| new.width = text.to_owned());
    assert!(width("20,5").is_ok() && width(" 20.5 ").is_ok());
    for text in ["0", "1000000", "-5"] {
        let fault = width(text).expect_err("refused");
        assert!(
            matches!(fault, DialogFault::Value(ValueError::Canvas { .. })),
            "{fault}"
        );
    }
    for text in ["wide", "", "NaN", "inf"] {
        let fault = width(text).expect_err("refused");
        assert!(matches!(fault, DialogFault::NoNumber { .. }), "{fault}");
    }
    for (fine, is_meant) in [
        ("0", is_no_cells as fn(&DialogFault) -> bool),
        ("-4", is_no_cells),
        ("1e9", |fault| {
            matches!(fault, DialogFault::Value(ValueError::Range(_)))
        }),
        ("four", |fault| {
            matches!(fault, DialogFault::NoNumber { .. })
        }),
    ] {
        let fault = asked(|new| new.fine = fine.to_owned()).expect_err("refused");
        assert!(is_meant(&fault), "{fine}: {fault}");
    }
    let large =
        asked(|new| (new.width, new.height, new.fine) = ("600".into(), "600".into(), "10".into()));
    let fault = large.expect_err("refused");
    assert!(
        matches!(fault, DialogFault::Value(ValueError::Cells(_))),
        "{fault}"
    );
}

#[test]
fn it_is_kept_in_a_file_that_is_not_there_yet() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| {
        let path = folder.path().join(name).display().to_string();
        asked(|new| (new.as_sketch, new.path) = (false, path))
    };
    let Ok(Command::Rig(RigCommand::New { path, .. })) = at("sea") else {
        panic!("refused");
    };
    assert!(path.is_some_and(|path| path.ends_with("/sea.maul")));
    std::fs::write(folder.path().join("sea.maul"), "").expect("written");
    assert!(matches!(at("sea"), Err(DialogFault::Taken(_))));
    assert!(matches!(at("none/sea"), Err(DialogFault::NoFolder(_))));
    assert!(matches!(at(""), Err(DialogFault::NoPaintingName)));
    let no_file = asked(|new| new.ground = FILE);
    assert!(matches!(no_file, Err(DialogFault::NoGround)));
    let ground = asked(|new| (new.ground, new.ground_file) = (FILE, "/g/oak.png".into()));
    assert!(
        matches!(ground, Ok(Command::Rig(RigCommand::New { canvas, .. })) if canvas.ground == "/g/oak.png")
    );
}

#[test]
fn how_large_it_is_is_told_in_words() {
    let of = |width: &str, fine: &str| {
        let command = asked(|new| (new.width, new.fine) = (width.into(), fine.into()));
        match command.expect("a canvas") {
            Command::Rig(RigCommand::New { canvas, .. }) => estimate(&canvas),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(
        of("21", "4"),
        "840 × 840 cells, 0.7 million in all; about 30 MB of memory when all of it is painted."
    );
    let small = of("0.5", "4");
    assert!(
        small.contains("20 × 840") && small.contains("16800"),
        "{small}"
    );
    assert!(of("210", "12").contains("GB"));
}

#[test]
fn it_looks_as_in_its_picture() {
    let new = || {
        let path = "/home/ada/Paintings/Birches.maul".into();
        NewPainting::kept_in(path, Units::Metric, UnsavedState::default())
    };
    picture(
        "files_new",
        [500.0, 400.0],
        new,
        |ui, new| {
            let _ = new.show(ui.ctx(), false);
        },
        |_| {},
        |new| new.width = "0".into(),
    );
}

#[test]
fn a_canvas_of_so_many_cells_that_painting_is_slow_is_asked_for() {
    let fine = |cells: &str, may_be_slow: bool| {
        asked(|new| (new.fine, new.may_be_slow) = (cells.into(), may_be_slow))
    };
    assert!(fine("16", false).is_ok());
    assert!(fine("48", false).is_err());
    assert!(fine("48", true).is_ok());
}
