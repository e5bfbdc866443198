use maulstick_types::command::PAINT_NODE;
use std::path::PathBuf;

use eframe::egui::{Key, Modifiers, MouseWheelUnit, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_painting::edits::{Load, Wells};
use maulstick_types::Mixture;
use maulstick_types::scene::{Well, WellKind};
use maulstick_ui_kit::notifications::Notifications;

use super::settings::ReferencePreferences;
use super::*;
use crate::rig::requests::Requests;
use crate::rig::state::RigState;
use crate::test_support::overlay_bench::{Bench, ctrl, let_go, picture, press, until, window};
use crate::test_support::panel_bench::rig;

const PICTURE: &str = "Reference picture. Arrow keys move the cross, Enter picks, + and - zoom";

/// A sky over a field, and a red sun.
fn landscape() -> Vec<[u8; 3]> {
    let at = |i: usize| {
        let (x, y) = ((i % 120) as f32 - 80.0, (i / 120) as f32 - 24.0);
        match (x * x + y * y < 150.0, y < 26.0) {
            (true, _) => [196, 60, 44],
            (_, true) => [150, 180, 205],
            _ => [120, 116, 50],
        }
    };
    (0..120 * 80).map(at).collect()
}

fn file(folder: &Path) -> PathBuf {
    let path = folder.join("Field.png");
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 120, 80);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a header");
    let pixels: Vec<u8> = landscape().into_iter().flatten().collect();
    writer.write_image_data(&pixels).expect("written");
    drop(writer);
    std::fs::write(&path, bytes).expect("written");
    path
}

fn pinned(folder: &Path) -> Harness<'static, Bench> {
    let mut harness = window(Some(folder));
    let path = file(folder);
    let_go(&mut harness, &[&path]);
    until(&mut harness, |harness| {
        harness.query_by_label(PICTURE).is_some()
    });
    harness.run_steps(3);
    harness
}

fn mixed(harness: &mut Harness<'static, Bench>) {
    until(harness, |harness| {
        harness.query_all_by_label_contains("Load ").count() == 3
    });
}

#[test]
fn a_click_on_a_colour_proposes_mixtures_that_are_loaded_put_on_the_palette_and_copied() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = pinned(folder.path());
    harness.get_by_label(PICTURE).click();
    mixed(&mut harness);
    let load = |harness: &Harness<'static, Bench>| {
        harness
            .query_all_by_label_contains("Load ")
            .next()
            .map(|node| {
                node.click();
            })
    };
    load(&harness).expect("a mixture");
    harness.run_steps(3);
    let asked = harness.state_mut().asked();
    let [(node, command)] = &asked[..] else {
        panic!("{asked:?}");
    };
    let Load { mixture, brush, .. } = command.edit().expect("a load");
    assert_eq!((node.as_str(), brush.as_str()), (PAINT_NODE, "main"));
    let names = of_palette(harness.state().rig.live.palette()).expect("paints");
    assert!(mixture.parts.iter().all(|part| names.contains(&part.paint)));
    let copy = harness.query_all_by_label_contains("Copy ").next();
    copy.expect("a mixture").click();
    harness.step();
    let commands = &harness.output().platform_output.commands;
    let copied = commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied: Mixture = copied.expect("copied").parse().expect("a mixture");
    assert_eq!(copied, mixture);
    let put = harness
        .query_all_by_label_contains("To the palette: ")
        .next();
    put.expect("a mixture").click();
    harness.run_steps(3);
    let asked_next = harness.state_mut().asked();
    let [(_, command)] = &asked_next[..] else {
        panic!("{asked_next:?}");
    };
    let Wells { wells, .. } = command.edit().expect("wells");
    let lies =
        |well: &Well| matches!(&well.kind, WellKind::Paint { mixture: lies } if *lies == mixture);
    assert_eq!(wells.iter().filter(|well| lies(well)).count(), 1);
    harness.get_by_label("Done").click();
    harness.run_steps(3);
    assert_eq!(harness.query_all_by_label_contains("Load ").count(), 0);
}

#[test]
fn colours_are_picked_by_keys_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = pinned(folder.path());
    harness.get_by_label(PICTURE).focus();
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    let sky = harness.query_by_label("#96b4cd").is_some();
    let field = harness.query_by_label("#787432").is_some();
    assert!(sky || field, "the middle");
    for _ in 0..12 {
        press(&mut harness, Key::ArrowDown);
    }
    press(&mut harness, Key::Enter);
    harness.get_by_label("#787432");
    mixed(&mut harness);
}

#[test]
fn it_goes_and_comes_by_its_key_and_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = window(Some(folder.path()));
    ctrl(&mut harness, Key::R, Modifiers::NONE);
    harness.get_by_label("Pin a reference picture");
    press(&mut harness, Key::Escape);
    let path = file(folder.path());
    let_go(&mut harness, &[&path]);
    until(&mut harness, |harness| {
        harness.query_by_label(PICTURE).is_some()
    });
    let kept = harness.state().preferences.reference.clone();
    assert!(kept.shown && kept.path == Some(path));
    ctrl(&mut harness, Key::R, Modifiers::NONE);
    assert!(harness.query_by_label(PICTURE).is_none());
    ctrl(&mut harness, Key::R, Modifiers::NONE);
    until(&mut harness, |harness| {
        harness.query_by_label(PICTURE).is_some()
    });
    harness.get_by_label("Another …").click();
    harness.run_steps(4);
    harness.get_by_label("Pin a reference picture");
}

#[test]
fn numbers_that_make_no_frame_are_not_believed() {
    let wild = ReferencePreferences {
        place: [f32::NAN, -1e9],
        size: [1.0, f32::INFINITY],
        opacity: -3.0,
        ..ReferencePreferences::default()
    };
    let sound = wild.sound();
    assert_eq!((sound.place, sound.opacity), ([24.0, 0.0], 0.1));
    assert_eq!(sound.size, [LEAST[0], 320.0]);
}

/// The frame alone, on a wall.
struct Wall {
    reference: Reference,
    rig: RigState,
    preferences: Preferences,
    opacity: f32,
    palette: Option<Rect>,
}

fn wall() -> Wall {
    let preferences = Preferences {
        reference: ReferencePreferences {
            shown: true,
            path: Some(PathBuf::from("/home/ada/Field.png")),
            place: [16.0, 16.0],
            ..ReferencePreferences::default()
        },
        ..Preferences::default()
    };
    Wall {
        reference: Reference::default(),
        rig: rig(),
        preferences,
        opacity: 1.0,
        palette: None,
    }
}

fn show(ui: &mut Ui, wall: &mut Wall) {
    let path = Path::new("/home/ada/Field.png");
    if wall.reference.pinned.path().is_none() {
        let picture = Picture::of([120, 80], landscape());
        wall.reference.pinned = Pinned::here(ui.ctx(), path, picture);
    }
    wall.preferences.reference.opacity = wall.opacity;
    let (mut requests, mut notifications) = (Requests::default(), Notifications::default());
    let mut work = PanelContext {
        rig: &mut wall.rig,
        requests: &mut requests,
        preferences: &mut wall.preferences,
        notifications: &mut notifications,
    };
    assert_eq!(wall.reference.show(ui.ctx(), wall.palette, &mut work), None);
}

#[test]
fn the_wheel_goes_closer_to_what_is_under_the_pointer_and_dragging_moves_it() {
    let mut harness = Harness::builder()
        .with_size([400.0, 420.0])
        .build_ui_state(show, wall());
    harness.run_steps(4);
    let area = harness.get_by_label(PICTURE).rect();
    let look = |harness: &Harness<'_, Wall>| harness.state().reference.look;
    let pointer = area.center() + vec2(60.0, -30.0);
    let under = |harness: &Harness<'_, Wall>| {
        let at = laid(area, [120, 80], &look(harness));
        (pointer - at.min) / at.size()
    };
    let before = under(&harness);
    harness.hover_at(pointer);
    harness.step();
    harness.event(egui::Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 200.0),
        source: egui::MouseWheelSource::Unknown,
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    assert!(look(&harness).zoom > 1.5, "{:?}", look(&harness));
    assert!((under(&harness) - before).length() < 1e-3);
    let middle = look(&harness).middle;
    harness.drag_at(pointer);
    harness.step();
    harness.hover_at(pointer + vec2(-40.0, 0.0));
    harness.step();
    harness.drop_at(pointer + vec2(-40.0, 0.0));
    harness.run_steps(2);
    assert!(look(&harness).middle.x > middle.x + 0.02);
    assert!(
        harness.state().reference.picked.is_none(),
        "a drag is no pick"
    );
    harness.get_by_label("Fit").click();
    harness.run_steps(3);
    assert_eq!(look(&harness).zoom, 1.0);
}

#[test]
fn a_pick_neither_makes_the_frame_larger_nor_hides_a_mixture_and_dragging_moves_it_for_good() {
    let palette = Rect::from_min_max(pos2(0.0, 0.0), pos2(120.0, 600.0));
    let mut state = wall();
    state.palette = Some(palette);
    let mut harness = Harness::builder()
        .with_size([900.0, 700.0])
        .build_ui_state(show, state);
    harness.run_steps(4);
    let frame = |harness: &Harness<'_, Wall>| {
        let close = harness.get_by_label("Another …").rect();
        let picture = harness.get_by_label(PICTURE).rect();
        (close.min, picture)
    };
    let (corner, before) = frame(&harness);
    assert!(corner.x > palette.right(), "beside the palette: {corner:?}");
    assert_eq!(harness.state().preferences.reference.place, [16.0, 16.0]);
    harness.get_by_label(PICTURE).click();
    until(&mut harness, |harness| {
        harness.query_all_by_label_contains("Load ").count() == 3
    });
    harness.run_steps(4);
    let (_, during) = frame(&harness);
    let copies = harness.query_all_by_label_contains("Copy ");
    let lowest = copies.map(|copy| copy.rect().bottom()).fold(0.0, f32::max);
    assert!(during.height() < before.height());
    assert!(lowest < before.bottom() + 24.0, "{lowest} {before:?}");
    harness.get_by_label("Done").click();
    harness.run_steps(6);
    assert_eq!(frame(&harness), (corner, before), "as large as before");
    let kept = harness.state().preferences.reference.clone();
    assert_eq!((kept.place, kept.size), ([16.0, 16.0], [320.0, 320.0]));
    // By its title.
    let title = pos2(corner.x + 100.0, corner.y - 14.0);
    harness.drag_at(title);
    harness.step();
    let to = title + vec2(200.0, 90.0);
    harness.hover_at(title + vec2(40.0, 30.0));
    harness.step();
    harness.hover_at(to);
    harness.run_steps(2);
    harness.drop_at(to);
    harness.run_steps(3);
    let moved = frame(&harness).0 - corner;
    assert!(moved.x > 100.0, "{moved:?}");
    let kept = harness.state().preferences.reference.place;
    assert!(
        (kept[0] + 8.0 - frame(&harness).0.x).abs() < 12.0,
        "{kept:?}"
    );
}

#[test]
fn it_looks_as_in_its_picture() {
    picture(
        "reference",
        [380.0, 430.0],
        wall,
        show,
        |harness| {
            harness.get_by_label(PICTURE).click();
            until(harness, |harness| {
                harness.query_all_by_label_contains("Load ").count() == 3
            });
            harness.remove_cursor();
        },
        |wall| wall.opacity = 0.4,
    );
}
