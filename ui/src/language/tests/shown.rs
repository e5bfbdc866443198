//! The window in German, as large as a small display.

use std::collections::BTreeSet;
use std::path::Path;

use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_types::paint::{HistoryStep, PaintStatus};

use super::MISSED;
use crate::language::{self, Language, all, choose};
use crate::rig::state::RigState;
use crate::settings::preferences::Preferences;
use crate::test_support::context_bench;
use crate::test_support::overlay_bench::{Bench, ctrl, picture, press, window_of};
use crate::test_support::panel_bench::{rig, steps};

/// A small display, points.
const DISPLAY: [f32; 2] = [1280.0, 720.0];
/// Distance by which texts may touch, points.
const TOUCH: f32 = 1.5;

/// A rig with a brush in the hand and steps in its history.
fn studio() -> RigState {
    let mut studio = context_bench::rig();
    let mut paint = rig().paint.expect("a paint node");
    let step = |(id, what): (u64, &str)| HistoryStep {
        id,
        what: what.to_owned(),
        done: true,
    };
    let named = [(3, "round stroke"), (2, "dry"), (1, "load Cobalt Blue")];
    paint.status = PaintStatus {
        history: named.into_iter().map(step).collect(),
        ..steps(3, 1)
    };
    studio.paint = Some(paint);
    studio.brushes.truncate(1);
    studio
}

/// A window in German with one panel unfolded.
fn german(panel: &str) -> Harness<'static, Bench> {
    choose(Some("de"));
    let preferences = Preferences {
        panels: true,
        open: vec![panel.to_owned()],
        language: Some("de".to_owned()),
        ..Preferences::default()
    };
    let mut harness = window_of(DISPLAY, studio(), preferences);
    harness.run_steps(4);
    harness
}

fn words(text: &str) -> impl Iterator<Item = String> {
    let words = text.split(|letter: char| !letter.is_alphabetic());
    words
        .filter(|word| word.chars().count() > 2)
        .map(str::to_lowercase)
}

/// English words of the window that no German sentence and no paint has.
fn english_words(language: &Language) -> BTreeSet<String> {
    let english = language.by_english.keys().flat_map(|text| words(text));
    let german: BTreeSet<String> = language
        .by_english
        .values()
        .flat_map(|text| words(text))
        .collect();
    let library = maulstick_optics::PaintLibrary::measured().expect("whole");
    let paints: BTreeSet<String> = library
        .paints()
        .iter()
        .flat_map(|paint| words(&paint.name))
        .collect();
    english
        .filter(|word| !german.contains(word) && !paints.contains(word))
        .collect()
}

/// Labels and values that a screen reader reads.
fn read(harness: &Harness<'_, Bench>) -> Vec<String> {
    let nodes = harness.root().children_recursive();
    let said = nodes.flat_map(|node| {
        let node = node.accesskit_node();
        [node.label(), node.value()].into_iter().flatten()
    });
    said.collect()
}

/// Texts with their places, as far as they are seen.
fn texts(harness: &Harness<'_, Bench>) -> Vec<(String, Rect, Rect, bool)> {
    fn collect(shape: &Shape, clip: Rect, found: &mut Vec<(String, Rect, Rect, bool)>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, clip, found)),
            Shape::Text(text) => {
                let place = text.galley.rect.translate(text.pos.to_vec2());
                let words = text.galley.text().to_owned();
                if place.intersects(clip) && !words.trim().is_empty() {
                    found.push((words, place, clip, text.galley.elided));
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    for ClippedShape {
        clip_rect, shape, ..
    } in &harness.output().shapes
    {
        collect(shape, *clip_rect, &mut found);
    }
    found
}

/// English words, and texts that are cut off or lie over each other.
fn faults(harness: &Harness<'_, Bench>, may_overlap: bool) -> Vec<String> {
    let german = &all()["de"];
    let english = english_words(german);
    let mut faults = Vec::new();
    for text in read(harness) {
        let foreign: Vec<String> = words(&text).filter(|word| english.contains(word)).collect();
        if !foreign.is_empty() {
            faults.push(format!("English {foreign:?} in {text:?}"));
        }
    }
    let texts = texts(harness);
    let known: BTreeSet<&String> = german.by_english.values().collect();
    let window = Rect::from_min_size(Default::default(), DISPLAY.into());
    for (place, (text, area, clip, elided)) in texts.iter().enumerate() {
        if *elided && known.contains(text) {
            faults.push(format!("cut off: {text:?}"));
        }
        let seen = clip.intersect(window);
        if area.left() < seen.left() - TOUCH || area.right() > seen.right() + TOUCH {
            faults.push(format!("out of its place: {text:?}"));
        }
        for (other, second, second_clip, _) in &texts[place + 1..] {
            let both = area
                .intersect(*second)
                .intersect(seen)
                .intersect(*second_clip);
            if !may_overlap && both.width() > TOUCH && both.height() > TOUCH {
                faults.push(format!("{text:?} lies over {other:?}"));
            }
        }
    }
    faults.extend(MISSED.with_borrow(|missed| {
        missed
            .iter()
            .map(|text| format!("missed {text:?}"))
            .collect::<Vec<_>>()
    }));
    faults
}

/// Saves a picture where somebody wants to look at it.
fn look(harness: &mut Harness<'_, Bench>, name: &str) {
    if let Some(place) = std::env::var_os("MAULSTICK_LOOK") {
        let image = harness.render().expect("a picture");
        let path = Path::new(&place).join(format!("german_{name}.png"));
        image.save(path).expect("saved");
    }
}

#[test]
fn panels_rack_and_bar_are_german_and_nothing_is_cut_off() {
    for panel in crate::panels::all() {
        let mut harness = german(panel.title());
        look(&mut harness, panel.title());
        assert_eq!(faults(&harness, false), [""; 0], "{}", panel.title());
    }
}

#[test]
fn folded_parts_of_panels_are_german() {
    for (panel, parts) in [
        ("Brush", &["Maus", "Borsten", "Eigene Pinseldateien"][..]),
        ("Canvas", &["Leinwand mit Farbe überziehen"]),
        ("Light", &["Farbe im Einzelnen"]),
    ] {
        for part in parts {
            let mut harness = german(panel);
            harness.get_by_label(part).click_accesskit();
            harness.run_steps(20);
            look(&mut harness, part);
            assert_eq!(faults(&harness, false), [""; 0], "{part}");
        }
    }
}

#[test]
fn menu_keys_settings_and_dialogs_are_german() {
    let mut harness = german("Brush");
    harness.get_by_label("Menü").click_accesskit();
    harness.run_steps(4);
    for group in ["Gemälde", "Ansicht", "Hilfe"] {
        harness.get_by_label_contains(group);
    }
    let mut harness = german("none");
    press(&mut harness, Key::F1);
    harness.run_steps(4);
    look(&mut harness, "keys");
    assert_eq!(faults(&harness, true), [""; 0], "keys");
    for (name, key, more) in [
        ("settings", Key::Comma, Modifiers::NONE),
        ("new", Key::N, Modifiers::NONE),
        ("open", Key::O, Modifiers::NONE),
        ("save_as", Key::S, Modifiers::SHIFT),
        ("export", Key::E, Modifiers::NONE),
    ] {
        let mut harness = german("none");
        ctrl(&mut harness, key, more);
        look(&mut harness, name);
        assert_eq!(faults(&harness, true), [""; 0], "{name}");
    }
}

#[test]
fn an_english_word_and_a_long_one_are_found() {
    choose(None);
    let mut harness = german("Brush");
    choose(None);
    harness.run_steps(4);
    let found = faults(&harness, false);
    assert!(
        found.iter().any(|fault| fault.contains("English")),
        "a fault would pass"
    );
}

#[test]
fn another_language_is_chosen_on_the_page_of_settings_and_holds_at_once() {
    let mut harness = window_of(DISPLAY, studio(), Preferences::default());
    ctrl(&mut harness, Key::Comma, Modifiers::NONE);
    let choose_by_name = |harness: &mut Harness<'_, Bench>, label: &str, name: &str| {
        let role = eframe::egui::accesskit::Role::ComboBox;
        harness.get_by_role_and_label(role, label).click_accesskit();
        harness.run_steps(3);
        harness.get_by_label(name).click_accesskit();
        harness.run_steps(3);
    };
    choose_by_name(&mut harness, "Language", "Deutsch");
    assert_eq!(harness.state().preferences.language.as_deref(), Some("de"));
    harness.get_by_label("Schriftgröße");
    harness.get_by_label("Rückgängig");
    choose_by_name(&mut harness, "Sprache", "English");
    assert_eq!(harness.state().preferences.language.as_deref(), Some("en"));
    harness.get_by_label("Text size");
    assert!(language::chosen().is_none());
}

#[test]
fn the_page_of_settings_looks_as_in_its_picture() {
    struct Wall {
        page: crate::settings_page::SettingsPage,
        bench: context_bench::Bench,
    }
    let wall = || {
        choose(Some("de"));
        let mut page = crate::settings_page::SettingsPage::default();
        page.open();
        let mut bench = context_bench::Bench::new();
        bench.preferences.language = Some("de".to_owned());
        Wall { page, bench }
    };
    picture(
        "settings_german",
        [540.0, 540.0],
        wall,
        |ui, wall| wall.page.show(ui.ctx(), &mut wall.bench.work()),
        |_| {},
        |_| choose(Some("en")),
    );
}
