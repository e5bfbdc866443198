//! Everything in the window is reached by the mouse alone, by the keyboard alone, and has a name for screen readers.

use std::collections::BTreeSet;

use eframe::egui::accesskit::{self, Role};
use eframe::egui::{Button, Key, Modifiers, Sense, Ui};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use serde::Deserialize as _;
use serde::de::value::{Error, StrDeserializer};

use crate::input::keys::{Action, BINDINGS};
use crate::panels;
use crate::sessions::tests::{recording, replay};
use crate::settings::brush_library::of_library;
use crate::test_support::overlay_bench::{Bench, ctrl, press, window};

/// Greatest number of presses of Tab: more than there are controls.
const MOST: usize = 400;

/// A control: its role, its name, and its number.
type Control = (Role, String, accesskit::NodeId);

/// The controls of a window that act.
fn controls<T>(harness: &Harness<'_, T>) -> BTreeSet<Control> {
    let all = harness.root().children_recursive();
    let control = |node: egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        let acts = matches!(
            node.role(),
            Role::Button
                | Role::CheckBox
                | Role::ComboBox
                | Role::Link
                | Role::MultilineTextInput
                | Role::RadioButton
                | Role::Slider
                | Role::SpinButton
                | Role::TextInput
        );
        let name = node.label().unwrap_or_default();
        (acts && !node.is_disabled()).then(|| (node.role(), name, node.locate().0))
    };
    all.filter_map(control).collect()
}

/// The controls that the keyboard comes to.
fn reached<T>(harness: &mut Harness<'_, T>) -> BTreeSet<accesskit::NodeId> {
    let mut reached = BTreeSet::new();
    for _ in 0..MOST {
        let all = harness.root().children_recursive();
        let focused = all.filter(|node| node.accesskit_node().is_focused());
        let new: Vec<_> = focused
            .map(|node| node.accesskit_node().locate().0)
            .collect();
        reached.extend(new);
        harness.key_press(Key::Tab);
        harness.step();
    }
    reached
}

/// New controls without a name for screen readers, or out of reach of the keyboard.
fn faults<T>(harness: &mut Harness<'_, T>, before: &BTreeSet<Control>) -> Vec<String> {
    let controls = &controls(harness) - before;
    let reached = reached(harness);
    let fault = |(role, name, id): &Control| match (name.trim(), reached.contains(id)) {
        ("", _) => Some(format!("a {role:?} without a name")),
        (name, false) => Some(format!("the {role:?} '{name}' without the keyboard")),
        _ => None,
    };
    controls.iter().filter_map(fault).collect()
}

/// A window with all panels unfolded.
fn unfolded() -> Harness<'static, Bench> {
    let mut harness = window(None);
    let file = of_library("round").expect("round").clone();
    let text = file.to_toml().expect("written");
    let bench = harness.state_mut();
    bench.rig.brushes[0].file = Some((file, text));
    for panel in panels::all() {
        bench.preferences.unfold(panel.title(), true);
    }
    harness.set_size([900.0, 6000.0].into());
    press(&mut harness, Key::F6);
    harness
}

#[test]
fn every_control_of_the_panels_is_named_and_reached_by_the_keyboard() {
    let mut harness = unfolded();
    assert!(controls(&harness).len() > 60, "{:?}", controls(&harness));
    assert_eq!(faults(&mut harness, &BTreeSet::new()), Vec::<String>::new());
}

#[test]
fn every_control_of_the_dialogs_is_named_and_reached_by_the_keyboard() {
    let folder = tempfile::tempdir().expect("a folder");
    for (key, more) in [
        (Key::N, Modifiers::NONE),
        (Key::O, Modifiers::NONE),
        (Key::S, Modifiers::SHIFT),
        (Key::E, Modifiers::NONE),
        (Key::P, Modifiers::NONE),
        (Key::R, Modifiers::NONE),
        (Key::T, Modifiers::SHIFT),
        (Key::M, Modifiers::NONE),
        (Key::Comma, Modifiers::NONE),
    ] {
        let mut harness = window(Some(folder.path()));
        let before = controls(&harness);
        ctrl(&mut harness, key, more);
        let now = controls(&harness).len();
        assert!(now > before.len(), "Ctrl+{key:?} opens nothing");
        assert_eq!(
            faults(&mut harness, &before),
            Vec::<String>::new(),
            "{key:?}"
        );
    }
}

#[test]
fn every_control_of_recorder_and_player_is_named_and_reached_by_the_keyboard() {
    let mut harness = window(None);
    let before = controls(&harness);
    let rig = &mut harness.state_mut().rig;
    (rig.recording, rig.replay) = (Some(recording()), Some(replay(false)));
    harness.run_steps(3);
    assert_eq!(controls(&harness).len(), before.len() + 8);
    press(&mut harness, Key::F6);
    assert_eq!(faults(&mut harness, &before), Vec::<String>::new());
}

#[test]
fn a_control_without_name_or_keyboard_is_found() {
    let show = |ui: &mut Ui| {
        drop(ui.button("Named"));
        drop(ui.button(" "));
        drop(ui.add(Button::new("Mouse only").sense(Sense::CLICK - Sense::FOCUSABLE)));
    };
    let mut harness = Harness::builder()
        .with_accessibility_check(false)
        .build_ui(show);
    let found = faults(&mut harness, &BTreeSet::new());
    assert_eq!(
        found,
        [
            "a Button without a name",
            "the Button 'Mouse only' without the keyboard"
        ]
    );
}

/// An action by its stored name.
fn action(name: &str) -> Result<Action, Error> {
    Action::deserialize(StrDeserializer::new(name))
}

/// All actions; an unknown name is answered with theirs.
fn actions() -> Vec<Action> {
    let words = action("").expect_err("no action").to_string();
    let names = words.split('`').skip(3).step_by(2);
    names.map(|name| action(name).expect("an action")).collect()
}

#[test]
fn every_action_has_a_key() {
    let actions = actions();
    assert!(actions.len() > 30, "{actions:?}");
    for action in actions {
        let has_key = BINDINGS.iter().any(|binding| binding.act == action);
        assert!(has_key, "{action:?}");
    }
}

#[test]
fn every_command_is_reached_by_the_mouse_alone() {
    let mut seen = BTreeSet::new();
    for title in ["Painting", "Brush", "View", "Help"] {
        let mut harness = window(None);
        harness.get_by_label("Menu").click();
        harness.run_steps(3);
        let entries = harness.get_all_by_label_contains(title);
        // The menu's titles are below all else that says so.
        let top = |node: &egui_kittest::Node<'_>| {
            let place = node.accesskit_node().bounding_box();
            place.map_or(0.0, |place| place.y0)
        };
        let lowest = entries.max_by(|a, b| top(a).total_cmp(&top(b)));
        lowest.expect("a menu").click();
        harness.run_steps(3);
        let names = controls(&harness).into_iter().map(|(_, name, _)| name);
        seen.extend(names);
    }
    // Drags: the slider of the brush's width, and the wheel.
    let is_drag = |action: Action| matches!(action, Action::Size | Action::Zoom);
    for binding in BINDINGS.iter().filter(|binding| !is_drag(binding.act)) {
        let entry = seen.iter().any(|name| name.starts_with(binding.words));
        assert!(entry, "'{}' is not in {seen:?}", binding.words);
    }
}
