//! The window in each language, as large as a small display.

use std::collections::BTreeSet;
use std::path::Path;

use eframe::egui::accesskit::Role;
use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_optics::THINNER;
use maulstick_types::paint::{HistoryStep, PaintStatus, StepName};
use maulstick_ui_kit::language::{Language, all, choose, chosen, lacking, translated};

use crate::panels::canvas::CanvasPanel;
use crate::panels::device::tests::devices;
use crate::rig::state::RigState;
use crate::sessions::tests::{recording, replay};
use crate::settings::preferences::{Preferences, WindowPreferences};
use crate::test_support::context_bench;
use crate::test_support::overlay_bench::{Bench, ctrl, press, until, window_of};
use crate::test_support::panel_bench::{self, rig, steps};

/// A small display, points.
const DISPLAY: [f32; 2] = [1280.0, 720.0];
/// Distance by which texts may touch, points.
const TOUCH: f32 = 1.5;

/// A rig with a brush in the hand and steps in its history.
fn studio() -> RigState {
    let mut studio = context_bench::rig();
    let mut paint = rig().live.paint.expect("a paint node");
    let step = |(id, what): (u64, StepName)| HistoryStep {
        id,
        what,
        done: true,
    };
    let stroke = StepName::Stroke {
        kind: "round".into(),
        on_palette: false,
    };
    let load = StepName::Load {
        paints: vec!["Cobalt Blue".into()],
    };
    let named = [(3, stroke), (2, StepName::Dry), (1, load)];
    paint.status = PaintStatus {
        history: named.into_iter().map(step).collect(),
        ..steps(3, 1)
    };
    studio.live.paint = Some(paint);
    let mut named = devices();
    // Its daemon supplies the words of its driver and its trouble.
    named.live.devices.remove("tablet");
    (studio.live.devices, studio.live.now_ns) = (named.live.devices, named.live.now_ns);
    studio.brushes.truncate(1);
    studio
}

/// A window in a language with one panel unfolded.
fn speaking(code: &str, panel: &str) -> Harness<'static, Bench> {
    choose(Some(code));
    let preferences = Preferences::of_window(WindowPreferences {
        panels: true,
        open: vec![panel.to_owned()],
        language: Some(code.to_owned()),
        ..WindowPreferences::default()
    });
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

/// English words of the window that no sentence of the language and no paint has.
fn english_words(language: &Language) -> BTreeSet<String> {
    let english = language.texts().flat_map(|(english, _)| words(english));
    let own = language.texts().flat_map(|(_, text)| words(text));
    let own: BTreeSet<String> = own.collect();
    let library = maulstick_optics::PaintLibrary::measured().expect("whole");
    let paints = library.paints().iter().map(|paint| paint.name.as_str());
    let paints: BTreeSet<String> = paints.chain([THINNER]).flat_map(words).collect();
    english
        .filter(|word| !own.contains(word) && !paints.contains(word))
        .collect()
}

/// Labels and values that a screen reader reads.
fn read(harness: &Harness<'_, Bench>) -> Vec<String> {
    let nodes = harness.root().children_recursive();
    let said = nodes.flat_map(|node| {
        let node = node.accesskit_node();
        [node.label(), node.value()].into_iter().flatten()
    });
    // A word of egui's own.
    said.filter(|said| said != "Close window").collect()
}

/// Visible texts with their places.
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

/// English words, and texts that are clipped or overlap.
fn faults(harness: &Harness<'_, Bench>, language: &Language, may_overlap: bool) -> Vec<String> {
    let english = english_words(language);
    let mut faults = Vec::new();
    for text in read(harness) {
        let foreign: Vec<String> = words(&text).filter(|word| english.contains(word)).collect();
        if !foreign.is_empty() {
            faults.push(format!("English {foreign:?} in {text:?}"));
        }
    }
    let texts = texts(harness);
    let known: BTreeSet<&str> = language.texts().map(|(_, text)| text).collect();
    let window = Rect::from_min_size(Default::default(), DISPLAY.into());
    for (place, (text, area, clip, elided)) in texts.iter().enumerate() {
        if *elided && known.contains(text.as_str()) {
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
    faults.extend(lacking().iter().map(|text| format!("missed {text:?}")));
    faults
}

/// Saves a picture for inspection, if requested.
fn look(harness: &mut Harness<'_, Bench>, code: &str, name: &str) {
    if let Some(place) = std::env::var_os("MAULSTICK_LOOK") {
        let image = harness.render().expect("a picture");
        let path = Path::new(&place).join(format!("{code}_{name}.png"));
        image.save(path).expect("saved");
    }
}

#[test]
fn panels_rack_and_bar_have_no_english_word_and_nothing_is_cut_off() {
    for (code, language) in all() {
        for panel in crate::panels::all() {
            let mut harness = speaking(code, panel.title());
            look(&mut harness, code, panel.title());
            let found = faults(&harness, language, false);
            assert_eq!(found, [""; 0], "{code}: {}", panel.title());
        }
    }
}

#[test]
fn folded_parts_of_panels_have_no_english_word_and_nothing_is_cut_off() {
    for (code, language) in all() {
        for (panel, part) in [
            ("Brush", "Mouse"),
            ("Brush", "Bristles"),
            ("Brush", "Own brush files"),
            ("Canvas", "Cover the canvas with paint"),
            ("Light", "Advanced colour"),
        ] {
            let mut harness = speaking(code, panel);
            harness.get_by_label(translated(part)).click_accesskit();
            harness.run_steps(20);
            look(&mut harness, code, part);
            let found = faults(&harness, language, false);
            assert_eq!(found, [""; 0], "{code}: {part}");
        }
    }
}

#[test]
fn menu_keys_settings_and_dialogs_have_no_english_word_and_nothing_is_cut_off() {
    for (code, language) in all() {
        let mut harness = speaking(code, "none");
        harness
            .get_by_role_and_label(Role::Button, translated("Menu"))
            .click_accesskit();
        harness.run_steps(4);
        look(&mut harness, code, "menu");
        assert_eq!(faults(&harness, language, true), [""; 0], "{code}: menu");
        let mut harness = speaking(code, "none");
        press(&mut harness, Key::F1);
        harness.run_steps(4);
        look(&mut harness, code, "keys");
        assert_eq!(faults(&harness, language, true), [""; 0], "{code}: keys");
        let title = translated("Keys");
        let mut shown = texts(&harness).into_iter();
        let title = shown.find(|(text, ..)| text == title).expect("a title");
        let top = title.1.top();
        assert!((0.0..60.0).contains(&top), "{code}: it begins at {top}");
        for (name, key, more) in [
            ("settings", Key::Comma, Modifiers::NONE),
            ("new", Key::N, Modifiers::NONE),
            ("open", Key::O, Modifiers::NONE),
            ("save_as", Key::S, Modifiers::SHIFT),
            ("export", Key::E, Modifiers::NONE),
            ("play", Key::P, Modifiers::NONE),
        ] {
            let folder = tempfile::tempdir().expect("a folder");
            let mut harness = speaking(code, "none");
            harness.state_mut().preferences.recent = vec![folder.path().join("1.maul")];
            harness.key_press_modifiers(Modifiers::COMMAND.plus(more), key);
            let looks = translated("Looking …");
            until(&mut harness, |harness| {
                harness.query_by_label(looks).is_none()
            });
            harness.run_steps(4);
            look(&mut harness, code, name);
            assert_eq!(faults(&harness, language, true), [""; 0], "{code}: {name}");
        }
    }
}

#[test]
fn recorder_and_player_have_no_english_word_and_nothing_is_cut_off() {
    for (code, language) in all() {
        for paused in [false, true] {
            let mut harness = speaking(code, "none");
            let rig = &mut harness.state_mut().rig;
            (rig.recording, rig.replay) = (Some(recording()), Some(replay(paused)));
            harness.run_steps(4);
            look(&mut harness, code, "transport");
            assert_eq!(faults(&harness, language, false), [""; 0], "{code}");
        }
    }
}

#[test]
fn an_english_word_and_a_text_that_lies_over_another_are_found() {
    let mut harness = speaking("de", "Brush");
    let found = |harness: &Harness<'_, Bench>| faults(harness, &all()["de"], false);
    assert_eq!(found(&harness), [""; 0]);
    choose(None);
    harness.run_steps(4);
    assert!(
        found(&harness)
            .iter()
            .any(|fault| fault.contains("English"))
    );
    choose(Some("de"));
    harness.set_size([380.0, 720.0].into());
    harness.run_steps(4);
    let over = |fault: &String| fault.contains("lies over") || fault.contains("out of its place");
    assert!(found(&harness).iter().any(over), "{:?}", found(&harness));
}

#[test]
fn another_language_is_chosen_on_the_page_of_settings_and_holds_at_once() {
    let mut harness = window_of(DISPLAY, studio(), Preferences::default());
    ctrl(&mut harness, Key::Comma, Modifiers::NONE);
    let choose_by_name = |harness: &mut Harness<'_, Bench>, name: &str| {
        harness.get_by_label(name).click_accesskit();
        harness.run_steps(3);
    };
    choose_by_name(&mut harness, "Deutsch");
    assert_eq!(
        harness.state().preferences.window.language.as_deref(),
        Some("de")
    );
    harness.get_by_label("Schriftgröße");
    harness.get_by_role_and_label(Role::Button, "Rückgängig");
    choose_by_name(&mut harness, "English");
    assert_eq!(
        harness.state().preferences.window.language.as_deref(),
        Some("en")
    );
    harness.get_by_label("Text size");
    assert!(chosen().is_none());
}

#[test]
fn a_panel_in_german_looks_as_in_its_picture() {
    choose(Some("de"));
    panel_bench::picture::<CanvasPanel>(
        "canvas_german",
        &panel_bench::rig(),
        |_| {},
        |_| choose(Some("en")),
    );
}
