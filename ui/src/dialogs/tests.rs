use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use maulstick_brush::BrushFile;
use maulstick_painting::edits::Undo;
use maulstick_rig::UserError;
use maulstick_types::command::{Detail, ExportOrder, NewCanvas};
use maulstick_types::command::{FileCommand, RigCommand, SaveAs};
use maulstick_types::command::{PAINT_NODE as PAINT, RIG_NODE as RIG};
use maulstick_types::paint::ExportStatus;
use maulstick_types::values::WholePath;
use maulstick_ui_kit::notifications::Severity;

use super::*;
use crate::test_support::overlay_bench::{ctrl, let_go, press, until, window, write};
use crate::tracing::settings::{Tracing, Tracings};

fn gone() -> Modifiers {
    Modifiers::NONE
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

#[test]
fn a_new_painting_is_begun_by_keys_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::N, gone());
    assert!(harness.get_by_label("Width").is_focused());
    ctrl(&mut harness, Key::A, gone());
    harness.get_by_label("Width").type_text("12,5");
    press(&mut harness, Key::Tab);
    assert!(harness.get_by_label("Height").is_focused());
    ctrl(&mut harness, Key::A, gone());
    harness.get_by_label("Height").type_text("10");
    press(&mut harness, Key::Enter);
    let asked = harness.state_mut().asked();
    let command = Command::from(RigCommand::New {
        path: Some(WholePath::new(text(&folder.path().join("Painting.maul"))).expect("valid")),
        canvas: NewCanvas {
            width_m: 0.125,
            height_m: 0.1,
            cell_m: 2.5e-4,
            ground: "gesso".parse().expect("a name"),
            tooth: "linen".parse().expect("a name"),
            tooth_seed: 1,
            stain_m: 3e-6,
        },
        forget: false,
    });
    assert_eq!(asked, [(RIG.to_owned(), command)]);
    // It is requested once, however often Enter is pressed.
    press(&mut harness, Key::Enter);
    assert!(harness.state_mut().asked().is_empty());
    let refusal = UserError::usage("the disk is full").help("free some space");
    harness.state_mut().answer(&asked[0], Err(refusal));
    harness.run_steps(3);
    harness.get_by_label("The disk is full. Free some space.");
    harness.get_by_label("Width").focus();
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    let asked = harness.state_mut().asked();
    harness
        .state_mut()
        .answer(&asked[0], Ok(Detail::say("Painting.maul")));
    harness.run_steps(3);
    assert!(harness.query_by_label("Width").is_none());
    assert!(harness.state().told().contains("Painting.maul"));
}

#[test]
fn escape_leaves_a_dialog_and_keys_are_the_desks_again() {
    let mut harness = window(None);
    ctrl(&mut harness, Key::N, gone());
    ctrl(&mut harness, Key::Z, gone());
    assert!(
        harness.state_mut().asked().is_empty(),
        "Ctrl+Z is the field's"
    );
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("Width").is_none());
    ctrl(&mut harness, Key::Z, gone());
    let undo = Command::from(Undo { brush: None });
    assert_eq!(harness.state_mut().asked(), [(PAINT.to_owned(), undo)]);
}

#[test]
fn a_painting_is_found_by_typing_and_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["sea.maul", "birches.maul"] {
        std::fs::write(folder.path().join(name), "").expect("written");
    }
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::O, gone());
    until(&mut harness, |harness| {
        harness.query_by_label("sea.maul").is_some()
    });
    assert!(harness.get_by_label("File").is_focused());
    harness.get_by_label("File").type_text("s");
    harness.run_steps(2);
    press(&mut harness, Key::ArrowDown);
    press(&mut harness, Key::Enter);
    let open = |path: PathBuf, forget: bool| {
        let path = text(&path);
        (
            RIG.to_owned(),
            Command::from(RigCommand::Open {
                path: WholePath::new(path).expect("valid"),
                forget,
            }),
        )
    };
    let sea = open(folder.path().join("sea.maul"), false);
    assert_eq!(harness.state_mut().asked(), [sea]);
}

#[test]
fn what_is_in_no_file_is_let_go_only_where_that_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("sea.maul"), "").expect("written");
    let mut harness = window(Some(folder.path()));
    let node = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    node.status.blank = false;
    ctrl(&mut harness, Key::O, gone());
    write(&mut harness, "File", &text(&folder.path().join("sea.maul")));
    press(&mut harness, Key::Enter);
    assert!(harness.state_mut().asked().is_empty());
    harness.get_by_label_contains("would be gone");
    harness
        .get_by_label_contains("Let go of the painting")
        .click();
    harness.run_steps(2);
    harness.get_by_label("Open").click();
    harness.run_steps(2);
    let asked = harness.state_mut().asked();
    assert!(matches!(
        &asked[..],
        [(_, Command::Rig(RigCommand::Open { forget: true, .. }))]
    ));
}

#[test]
fn a_path_that_is_not_there_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::O, gone());
    write(
        &mut harness,
        "File",
        &text(&folder.path().join("none.maul")),
    );
    press(&mut harness, Key::Enter);
    harness.get_by_label_contains("There is no file");
    write(&mut harness, "File", &text(folder.path()));
    press(&mut harness, Key::Enter);
    harness.get_by_label_contains("This is a folder");
    write(&mut harness, "File", "/no such folder/");
    until(&mut harness, |harness| {
        let told = harness.query_by_label("There is no such folder.");
        told.is_some()
    });
    assert!(harness.state_mut().asked().is_empty());
}

#[test]
fn saving_is_confirmed_and_what_is_in_no_file_gets_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::S, gone());
    harness.get_by_label("Save under another name");
    press(&mut harness, Key::Enter);
    let path = folder.path().join("Painting.maul");
    let save = |replace: bool| {
        let path = text(&path);
        (
            RIG.to_owned(),
            Command::from(RigCommand::SaveAs(SaveAs {
                path: WholePath::new(path).expect("valid"),
                replace,
            })),
        )
    };
    assert_eq!(harness.state_mut().asked(), [save(false)]);
    let sketch = Tracing {
        path: "/sketch.png".into(),
        ..Tracing::default()
    };
    harness.state_mut().preferences.tracings = Tracings::of(sketch.clone());
    harness
        .state_mut()
        .answer(&save(false), Ok(Detail::say("Painting.maul")));
    harness.run_steps(2);
    let node = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    (node.status.path, node.status.blank) = (text(&path), false);
    harness.run_steps(2);
    assert_eq!(harness.state().preferences.recent[0], path);
    let traced = harness.state().preferences.tracings.in_file(&text(&path));
    assert_eq!(traced, Some(&sketch), "it goes with the painting");
    ctrl(&mut harness, Key::S, gone());
    assert!(harness.query_by_label("Save under another name").is_none());
    assert!(harness.state().told().contains("Painting.maul"));
    // Under another name, over an existing painting.
    std::fs::write(&path, "").expect("written");
    ctrl(&mut harness, Key::S, Modifiers::SHIFT);
    write(&mut harness, "File", &text(&path));
    press(&mut harness, Key::Enter);
    assert!(harness.state_mut().asked().is_empty());
    harness
        .get_by_label("Replace the painting Painting.maul")
        .click();
    harness.run_steps(2);
    harness.get_by_label("Save").click();
    harness.run_steps(2);
    assert_eq!(harness.state_mut().asked(), [save(true)]);
}

#[test]
fn an_export_goes_on_by_itself_and_can_be_stopped() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::E, gone());
    press(&mut harness, Key::Enter);
    let path = text(&folder.path().join("Painting.png"));
    let order = ExportOrder {
        format: "png".into(),
        ..ExportOrder::to(path.parse().expect("whole"))
    };
    let asked = (PAINT.to_owned(), Command::from(FileCommand::Export(order)));
    assert_eq!(harness.state_mut().asked(), std::slice::from_ref(&asked));
    assert!(harness.query_by_label("Depth").is_none(), "it is closed");
    let node = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    node.status.export = Some(ExportStatus {
        path,
        share: 0.5,
        since_ns: 3_000_000_000,
    });
    harness.run_steps(3);
    harness.get_by_label("3 s left");
    harness.get_by_label("Stop").click();
    harness.run_steps(2);
    let stop = (PAINT.to_owned(), Command::from(FileCommand::StopExport));
    assert_eq!(harness.state_mut().asked(), [stop]);
    harness
        .state_mut()
        .answer(&asked, Ok(Detail::say("Painting.png")));
    assert!(harness.state().told().contains("Painting.png"));
}

#[test]
fn a_file_that_is_dropped_becomes_what_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let mut harness = window(Some(folder.path()));
    let painting = put("sea.maul", "");
    let_go(&mut harness, &[&painting]);
    until(&mut harness, |harness| {
        harness.state().told().contains("sea.maul")
    });
    let open = Command::from(RigCommand::Open {
        path: WholePath::new(text(&painting)).expect("valid"),
        forget: false,
    });
    assert_eq!(harness.state_mut().asked(), [(RIG.to_owned(), open)]);
    let toml = BrushFile::library_text("flat").expect("a brush");
    let_go(&mut harness, &[&put("mine.toml", toml)]);
    until(&mut harness, |harness| {
        let brush = &harness.state().rig.brushes[0];
        brush.asked.as_ref().is_some_and(|file| file.kind == "flat")
    });
    let asked = harness.state_mut().asked();
    let defined = matches!(&asked[..], [(to, Command::Brush(_))] if to == "main");
    assert!(defined, "{asked:?}");
    let picture = put("apples.png", "no picture");
    let_go(&mut harness, &[&picture]);
    until(&mut harness, |harness| {
        harness.query_by_label_contains("cannot be shown").is_some()
    });
    assert_eq!(harness.state().preferences.reference.path, Some(picture));
    let_go(&mut harness, &[&put("song.mp3", "ID3")]);
    until(&mut harness, |harness| {
        harness.state().told().contains(dropped::KINDS)
    });
    let_go(&mut harness, &[&painting, &painting]);
    harness.run_steps(2);
    let newest = harness.state().notifications.shown().last();
    let newest = newest.expect("a refusal");
    assert_eq!(newest.severity, Severity::Fault);
    assert_ne!(newest.help, dropped::KINDS);
    // A painting in no file is not closed for a dropped one.
    let node = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    node.status.blank = false;
    let_go(&mut harness, &[&painting]);
    until(&mut harness, |harness| {
        harness.query_by_label_contains("would be gone").is_some()
    });
    assert!(harness.state_mut().asked().is_empty());
}

#[test]
fn the_line_at_the_edge_says_whether_it_is_saved_and_offers_all() {
    let mut harness = window(None);
    let line = |harness: &mut egui_kittest::Harness<
        'static,
        crate::test_support::overlay_bench::Bench,
    >,
                change: fn(&mut maulstick_types::paint::PaintStatus)| {
        let node = harness.state_mut().rig.live.paint.as_mut().expect("a node");
        change(&mut node.status);
        harness.state_mut().rig.live.now_ns = 10_000_000_000;
        harness.run_steps(3);
    };
    harness.get_by_label("New painting");
    line(&mut harness, |status| status.blank = false);
    harness.get_by_label("In no file · Ctrl+S keeps it");
    line(&mut harness, |status| status.path = "/p/sea.maul".into());
    harness.get_by_label("sea.maul · saved");
    line(&mut harness, |status| status.all_committed = false);
    harness.get_by_label("sea.maul · saving …");
    line(&mut harness, |status| status.committed_ns = 9_900_000_000);
    harness.get_by_label("sea.maul · saved");
    line(&mut harness, |status| {
        status.fault = "the disk is full".into()
    });
    harness.get_by_label("sea.maul · not saved").click();
    harness.run_steps(3);
    harness.get_by_label_contains("Export a picture").click();
    harness.run_steps(3);
    harness.get_by_label("Depth");
}
