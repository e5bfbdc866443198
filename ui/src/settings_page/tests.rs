use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_types::Edit;
use maulstick_types::command::Command;
use maulstick_ui_kit::units::Units;

use crate::input::keymap::Keymap;
use crate::settings::preferences::Preferences;
use crate::test_support::overlay_bench::{Bench, ctrl, picture, press, window, window_of};
use crate::test_support::panel_bench::rig;

fn opened() -> Harness<'static, Bench> {
    let mut harness = window(None);
    ctrl(&mut harness, Key::Comma, Modifiers::NONE);
    harness.get_by_label("Text size");
    harness
}

fn click(harness: &mut Harness<'static, Bench>, label: &str) {
    harness.get_by_label(label).click_accesskit();
    harness.run_steps(3);
}

/// Edits that a key asks for.
fn edits(harness: &mut Harness<'static, Bench>, key: Key) -> Vec<Edit> {
    press(harness, key);
    let asked = harness.state_mut().asked().into_iter();
    let edit = |(_, command)| match command {
        Command::Edit(edit) => Some(edit),
        _ => None,
    };
    asked.filter_map(edit).collect()
}

#[test]
fn a_key_is_changed_by_keys_alone_and_acts_and_is_shown_everywhere() {
    let mut harness = opened();
    harness.get_by_label("Key of “Dry the canvas”: D").focus();
    harness.run_steps(2);
    press(&mut harness, Key::Enter);
    harness.get_by_label_contains("Press the new key");
    press(&mut harness, Key::Q);
    harness.get_by_label("Key of “Dry the canvas”: Q");
    press(&mut harness, Key::Escape);
    assert!(harness.query_by_label("Text size").is_none());
    assert!(edits(&mut harness, Key::D).is_empty());
    let names = edits(&mut harness, Key::Q)
        .into_iter()
        .map(|edit| edit.name);
    assert_eq!(names.collect::<Vec<_>>(), ["dry"]);
    press(&mut harness, Key::F1);
    let row = harness.get_by_label("Dry the canvas").rect();
    let key = harness.get_by_label("Q").rect();
    assert!((row.center().y - key.center().y).abs() < 4.0);
}

#[test]
fn a_key_that_something_has_is_taken_only_where_that_is_said() {
    let mut harness = opened();
    let taken = "B is “Next brush” now.";
    click(&mut harness, "Key of “Dry the canvas”: D");
    press(&mut harness, Key::B);
    harness.get_by_label(taken);
    click(&mut harness, "Leave it");
    harness.get_by_label("Key of “Dry the canvas”: D");
    click(&mut harness, "Key of “Dry the canvas”: D");
    press(&mut harness, Key::B);
    click(&mut harness, "Take it");
    harness.get_by_label("Key of “Dry the canvas”: B");
    harness.get_by_label("Key of “Next brush”: none");
    // To reset one asks for its usual key back, which nothing has.
    click(&mut harness, "Reset the key of “Dry the canvas”");
    harness.get_by_label("Key of “Dry the canvas”: D");
    click(&mut harness, "Reset all keys");
    assert_eq!(harness.state().preferences.keys, Keymap::default());
}

#[test]
fn keys_that_cannot_be_given_are_told_and_escape_leaves_the_key() {
    let mut harness = opened();
    click(&mut harness, "Key of “Dry the canvas”: D");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Minus);
    harness.run_steps(3);
    harness.get_by_label_contains("“Smaller text” now");
    assert!(harness.query_by_label("Take it").is_none());
    click(&mut harness, "Leave it");
    let clean = "Key of “Clean the brush; held, it lifts paint”: C";
    click(&mut harness, clean);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::K);
    harness.run_steps(3);
    harness.get_by_label_contains("This one is held");
    click(&mut harness, clean);
    press(&mut harness, Key::Escape);
    harness.get_by_label(clean);
    harness.get_by_label("Text size");
    assert_eq!(harness.state().preferences.keys, Keymap::default());
}

#[test]
fn text_and_units_are_changed_and_brushes_have_widths_in_them() {
    let mut harness = opened();
    click(&mut harness, "Larger text");
    assert_eq!(harness.ctx.zoom_factor(), 1.1);
    click(&mut harness, "Inches");
    assert_eq!(harness.state().preferences.window.units, Units::Inches);
    click(&mut harness, "Close");
    assert!(harness.query_by_label("Text size").is_none());
    assert!(harness.query_all_by_label_contains(" in").count() > 5);
    assert_eq!(harness.query_all_by_label_contains(" mm").count(), 0);
}

/// Greatest distance of a key from its meaning, points.
const BESIDE: f32 = 32.0;

#[test]
fn keys_stand_beside_their_meaning() {
    let gap = |key: Rect, words: Rect| words.left() - key.right();
    let mut harness = opened();
    let words = "Held, and drag: zoom";
    let key = harness.get_by_label(&format!("Key of “{words}”: Z")).rect();
    let apart = gap(key, harness.get_by_label(words).rect());
    assert!((0.0..BESIDE).contains(&apart), "settings: {apart}");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::F1);
    harness.run_steps(3);
    let key = harness.get_by_label("Z").rect();
    let apart = gap(key, harness.get_by_label(words).rect());
    assert!((0.0..BESIDE).contains(&apart), "table: {apart}");
}

#[test]
fn settings_do_not_touch_at_double_scale() {
    let mut harness = window_of([640.0, 400.0], rig(), Preferences::default());
    ctrl(&mut harness, Key::Comma, Modifiers::NONE);
    let rows = [
        &["Smaller text", "Larger text"][..],
        &["English", "Deutsch", "Français"],
        &["Dark"],
        &["mm and cm", "Inches"],
    ];
    let rows = rows.map(|row| {
        let rects = row.iter().map(|label| harness.get_by_label(label).rect());
        rects.fold(Rect::NOTHING, |whole, own| whole | own)
    });
    for pair in rows.windows(2) {
        let apart = pair[1].top() - pair[0].bottom();
        assert!(apart >= 3.0, "{pair:?}");
    }
    let close = harness.get_by_label("Close").rect();
    assert!(close.bottom() < 400.0, "{close:?}");
    let list = harness.get_by_label("Click a key to change it.").rect();
    assert!(list.bottom() < close.top());
}

#[test]
fn it_looks_as_in_its_picture() {
    struct Wall {
        page: super::SettingsPage,
        bench: crate::test_support::context_bench::Bench,
    }
    let wall = || {
        let mut page = super::SettingsPage::default();
        page.open();
        let bench = crate::test_support::context_bench::Bench::new();
        Wall { page, bench }
    };
    picture(
        "settings",
        [540.0, 520.0],
        wall,
        |ui, wall| wall.page.show(ui.ctx(), &mut wall.bench.work()),
        |_| {},
        |wall| wall.page = super::SettingsPage::default(),
    );
}
