//! The folder of motions, the dialog, and a motion at the pointer, with neither bus nor desk.

use std::path::Path;

use eframe::egui::{
    Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, Ui, pos2, vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_brush::palette_place::Side;
use maulstick_device::Take;
use maulstick_device::demo::{Subject, performance};
use maulstick_types::scene::Surface;
use maulstick_ui_kit::notifications::Severity;

use super::*;
use crate::motions::drawn_paths::DrawnPaths;
use crate::motions::library::{Known, Library, Motion};
use crate::rig::requests::Requests;
use crate::sessions::SessionOrder;
use crate::settings::preferences::Preferences;
use crate::test_support::overlay_bench::{Bench, ctrl, until, window_of};
use crate::test_support::panel_bench::rig;

/// A take of the demo's first strokes.
fn take() -> Take {
    let mut take = performance(Subject::Flower, 1);
    take.samples.truncate(1500);
    take
}

/// A folder with a motion, a damaged one, one that never paints and another file.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    take().write(&path("sweep.mcap")).expect("written");
    std::fs::write(path("torn.mcap"), "no take").expect("written");
    std::fs::write(path("notes.txt"), "words").expect("written");
    let mut air = take();
    air.samples.truncate(5);
    air.write(&path("air.mcap")).expect("written");
    folder
}

fn motion() -> Motion {
    Motion {
        path: "/p/sweep.mcap".into(),
        drawn: DrawnPaths::of(&take(), 0.0),
        seconds: 6.0,
    }
}

#[test]
fn a_folder_has_the_takes_that_paint() {
    let folder = folder();
    let context = Context::default();
    let mut library = Library::new(&context, folder.path().to_owned(), 0.0);
    let is_read = |library: &Library| {
        let files = library.files.as_ref().expect("listed");
        !library.is_coming() && files.iter().all(|(_, known)| *known != Known::Coming)
    };
    while !is_read(&library) {
        library.take_in(&context);
        std::thread::yield_now();
    }
    let files = library.files.expect("listed");
    let names: Vec<String> = files
        .iter()
        .map(|(path, _)| {
            path.file_name()
                .expect("a name")
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    assert_eq!(names, ["air.mcap", "sweep.mcap", "torn.mcap"]);
    let [
        (_, Known::Unusable),
        (_, Known::Here(motion)),
        (_, Known::Unusable),
    ] = &files[..]
    else {
        panic!("{files:?}");
    };
    assert_eq!(motion.drawn, DrawnPaths::of(&take(), 0.0));
}

#[test]
fn lines_of_a_long_take_have_few_points_and_keep_their_ends() {
    let long = performance(Subject::Flower, 1);
    let drawn = DrawnPaths::of(&long, 0.0);
    let strokes = maulstick_motion::strokes(&long.samples, 0.0);
    assert_eq!(drawn.strokes.len(), strokes.len());
    for (line, stroke) in drawn.strokes.iter().zip(&strokes) {
        let whole = stroke.path(&long.samples, 0.0);
        assert_eq!((line.first(), line.last()), (whole.first(), whole.last()));
    }
    let points: usize = drawn.strokes.iter().map(Vec::len).sum();
    let whole: usize = strokes.iter().map(|stroke| stroke.samples.len()).sum();
    assert!(2 * points < whole && points > 100, "{points} of {whole}");
}

fn bench(folder: &Path) -> Harness<'static, Bench> {
    let preferences = Preferences {
        motions: Some(folder.to_owned()),
        has_painted: true,
        ..Preferences::default()
    };
    window_of([900.0, 700.0], rig(), preferences)
}

#[test]
fn a_motion_is_chosen_by_its_picture_and_follows_the_pointer_then() {
    let folder = folder();
    let mut harness = bench(folder.path());
    ctrl(&mut harness, Key::M, Modifiers::SHIFT);
    until(&mut harness, |harness| {
        harness.query_by_label("sweep").is_some() && harness.query_by_label("torn").is_none()
    });
    let go = harness.get_by_label("Put down");
    assert!(go.accesskit_node().is_disabled(), "nothing is chosen");
    harness.get_by_label("sweep").click();
    harness.run_steps(3);
    harness.get_by_label("Put down").click();
    harness.run_steps(3);
    let bench = harness.state();
    assert!(bench.overlay.motions.is_placing() && !bench.overlay.motions.is_open());
    let shown = bench.notifications.shown().iter();
    let severities: Vec<_> = shown.map(|toast| toast.severity).collect();
    assert_eq!(severities, [Severity::Note], "{}", bench.told());
    assert_eq!(bench.preferences.motions.as_deref(), Some(folder.path()));
}

#[test]
fn a_folder_without_takes_says_so_and_nothing_is_begun_while_something_plays() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = bench(&folder.path().join("none"));
    ctrl(&mut harness, Key::M, Modifiers::SHIFT);
    until(&mut harness, |harness| {
        harness
            .query_by_label_contains("No motions are here")
            .is_some()
    });
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(!harness.state().overlay.motions.is_open());
    harness.state_mut().rig.replay = Some(crate::sessions::tests::replay(false));
    ctrl(&mut harness, Key::M, Modifiers::SHIFT);
    let bench = harness.state();
    assert!(!bench.overlay.motions.is_open());
    let told = bench.notifications.shown().iter();
    let faults = told.filter(|toast| toast.severity == Severity::Fault);
    assert_eq!(faults.count(), 1, "{}", bench.told());
}

/// A desk with a motion at the pointer.
struct Desk {
    motions: Motions,
    bench: Bench,
    surfaces: Vec<Surface>,
    view: Option<View>,
}

impl Desk {
    fn show(ui: &mut Ui, desk: &mut Self) {
        let view = View::of(ui.max_rect(), &desk.surfaces[0], None, Side::Left, 0.0);
        let view = view.expect("a view");
        desk.view = Some(view);
        let bench = &mut desk.bench;
        let work = &mut PanelContext {
            rig: &mut bench.rig,
            requests: &mut bench.requests,
            preferences: &mut bench.preferences,
            notifications: &mut bench.notifications,
        };
        let around = (&view, &desk.surfaces[..]);
        desk.motions.place(ui.ctx(), ui.painter(), around, work);
    }
}

fn desk() -> Harness<'static, Desk> {
    let rig = rig();
    let surfaces = rig.live.scene.as_ref().map(|scene| scene.surfaces.clone());
    let desk = Desk {
        motions: Motions {
            dialog: None,
            placing: Some(Placing::new(motion())),
        },
        bench: Bench {
            overlay: crate::app::overlay::Overlay::default(),
            rig,
            requests: Requests::default(),
            preferences: Preferences::default(),
            notifications: maulstick_ui_kit::notifications::Notifications::default(),
        },
        surfaces: surfaces.expect("a scene"),
        view: None,
    };
    let mut harness = Harness::builder()
        .with_size([800.0, 600.0])
        .build_ui_state(Desk::show, desk);
    harness.run_steps(2);
    harness
}

fn button(pos: Pos2, button: PointerButton) -> Event {
    Event::PointerButton {
        pos,
        button,
        pressed: true,
        modifiers: Modifiers::NONE,
    }
}

fn wheel(lines: f32, modifiers: Modifiers) -> Event {
    Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, lines),
        phase: TouchPhase::Move,
        source: eframe::egui::MouseWheelSource::Wheel,
        modifiers,
    }
}

#[test]
fn it_is_put_down_where_the_pointer_clicks_scaled_and_turned_as_it_was_seen() {
    let mut harness = desk();
    let at = pos2(300.0, 200.0);
    harness.event(Event::PointerMoved(pos2(500.0, 400.0)));
    harness.run_steps(1);
    harness.event(Event::PointerMoved(at));
    harness.event(wheel(2.0, Modifiers::NONE));
    harness.event(wheel(1.0, Modifiers::SHIFT));
    harness.run_steps(1);
    let motions = &mut harness.state_mut().motions;
    assert!(motions.follow(Action::Larger) && motions.follow(Action::TurnLeft));
    assert!(!motions.follow(Action::Undo), "it is the painter's");
    harness.event(button(at, PointerButton::Primary));
    harness.run_steps(2);
    let desk = harness.state_mut();
    assert!(!desk.motions.is_placing());
    let orders = desk.bench.requests.take_session_orders();
    let [
        SessionOrder::PutDown {
            take,
            at_mm,
            scale,
            turn_deg,
        },
    ] = &orders[..]
    else {
        panic!("{orders:?}");
    };
    let place = desk.view.expect("a view").to_desk(at, &desk.surfaces);
    assert_eq!(take.as_path(), Path::new("/p/sweep.mcap"));
    assert_eq!(*at_mm, [1e3 * place.x, 1e3 * place.y]);
    assert!(
        (scale / maulstick_num::exp(0.26) - 1.0).abs() < 1e-9,
        "{scale}"
    );
    assert!((turn_deg - 18.0).abs() < 1e-9, "{turn_deg}");
}

#[test]
fn escape_or_the_other_button_lets_it_go() {
    for key in [true, false] {
        let mut harness = desk();
        harness.event(Event::PointerMoved(pos2(300.0, 200.0)));
        harness.run_steps(1);
        assert!(harness.state().motions.is_placing());
        if key {
            harness.key_press(Key::Escape)
        } else {
            harness.event(button(pos2(300.0, 200.0), PointerButton::Secondary))
        }
        harness.run_steps(2);
        let desk = harness.state_mut();
        assert!(!desk.motions.is_placing());
        assert!(desk.bench.requests.take_session_orders().is_empty());
    }
}
