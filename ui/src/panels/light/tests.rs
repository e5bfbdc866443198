use eframe::egui::{Key, accesskit::Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_painting::edits::Relight;
use maulstick_types::command::Command;

use super::*;
use crate::test_support::panel_bench::{Bench, harness, picture, rig};

fn panel() -> Harness<'static, Bench<LightPanel>> {
    harness(rig())
}

/// The lights that were asked for, and whether their exposure is to be chosen.
fn lights(harness: &mut Harness<'static, Bench<LightPanel>>) -> Vec<(Light, bool)> {
    let light = |command: Command| {
        let Relight { light, expose } = command.edit().expect("a light");
        (light, expose)
    };
    harness.state_mut().asked().into_iter().map(light).collect()
}

#[test]
fn the_lamp_follows_the_pointer_and_nothing_else_changes() {
    let mut harness = panel();
    let pad = harness.get_by_label("Lamp").rect();
    let at = |x: f32, y: f32| pad.center() + 0.5 * pad.width() * vec2(x, -y);
    harness.drag_at(at(0.0, 0.0));
    for x in [0.2, 0.4, 0.6] {
        harness.hover_at(at(x, 0.3));
    }
    harness.drop_at(at(0.6, 0.3));
    harness.run();
    let lights = lights(&mut harness);
    assert!(lights.len() >= 3, "it streams: {}", lights.len());
    assert!(lights.iter().all(|(_, expose)| !expose), "nothing is baked");
    let (last, _) = lights.last().expect("a light");
    let [x, y, z] = last.direction;
    assert!((x - 0.6).abs() < 0.02 && (y - 0.3).abs() < 0.02, "{x} {y}");
    assert!((x * x + y * y + z * z - 1.0).abs() < 1e-9);
    let rest = Light {
        direction: Light::default().direction,
        ..last.clone()
    };
    assert_eq!(
        &rest,
        &harness
            .state()
            .rig
            .live
            .scene
            .as_ref()
            .expect("a scene")
            .light
    );
}

#[test]
fn arrows_move_the_lamp() {
    let mut harness = panel();
    let before = harness.state().rig.live.scene.as_ref().expect("a scene");
    let [x, y, z] = before.light.direction;
    let length = (x * x + y * y + z * z).sqrt();
    harness.get_by_label("Lamp").focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    harness.key_press(Key::ArrowDown);
    harness.run();
    let lights = lights(&mut harness);
    let (last, _) = lights.last().expect("a light");
    assert_eq!(lights.len(), 3);
    assert!((last.direction[0] - x / length - 0.1).abs() < 0.01);
    assert!((last.direction[1] - y / length + 0.05).abs() < 0.01);
    assert!(harness.get_by_label("Lamp").is_focused());
}

#[test]
fn a_change_keeps_what_was_changed_just_before() {
    let mut harness = panel();
    for (label, value) in [("Strength", 2.0), ("Relief", 3.0)] {
        let slider = harness.get_by_role_and_label(Role::Slider, label);
        slider.set_value_accesskit(value);
        harness.run();
    }
    let lights = lights(&mut harness);
    let (last, _) = lights.last().expect("a light");
    assert_eq!((last.intensity, last.relief), (2.0, 3.0));
}

#[test]
fn another_spectrum_is_exposed_anew_and_an_exposure_is_chosen_by_a_button() {
    let mut harness = panel();
    harness
        .get_by_role_and_label(Role::ComboBox, "Light")
        .click();
    harness.run();
    harness.get_by_label("A, light bulb").click();
    harness.run();
    harness.get_by_label("Auto exposure").click();
    harness.run();
    let lights = lights(&mut harness);
    assert_eq!(lights.len(), 2);
    assert_eq!((lights[0].0.illuminant.as_str(), lights[0].1), ("A", true));
    assert_eq!((&lights[1].0, lights[1].1), (&Light::default(), true));
}

#[test]
fn surroundings_are_chosen_and_a_picture_of_them_is_asked_for() {
    let mut harness = panel();
    for entry in ["Studio", "A picture…"] {
        harness
            .get_by_role_and_label(Role::ComboBox, "Surroundings")
            .click();
        harness.run();
        harness.get_by_label(entry).click();
        harness.run();
    }
    assert!(harness.state_mut().requests.takes_environment());
    let lights = lights(&mut harness);
    let around: Vec<_> = lights.iter().map(|(light, _)| &light.environment).collect();
    assert_eq!(around, [&Environment::Room]);
}

#[test]
fn a_spectrum_is_read_from_a_file_or_told_with_its_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("candle.csv");
    std::fs::write(&path, "nm,power\n380,0.1\n500,x\n780,2\n").expect("written");
    let mut harness = panel();
    harness.get_by_label("Advanced colour").click();
    harness.run();
    let enter = |harness: &mut Harness<'static, Bench<LightPanel>>| {
        harness
            .get_by_role_and_label(Role::TextInput, "Light from")
            .focus();
        harness.run();
    };
    enter(&mut harness);
    harness
        .get_by_role_and_label(Role::TextInput, "Light from")
        .type_text(&path.display().to_string());
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert!(lights(&mut harness).is_empty());
    harness.get_by_label_contains("candle.csv:3");
    std::fs::write(&path, "nm,power\n380,0.1\n780,2\n").expect("written");
    enter(&mut harness);
    harness.key_press(Key::Enter);
    harness.run();
    let lights = lights(&mut harness);
    assert_eq!(
        (lights[0].0.illuminant.as_str(), lights[0].1),
        ("candle", true)
    );
    assert_eq!(lights[0].0.spectrum.len(), 101);
    assert!(harness.query_by_label_contains("candle.csv:3").is_none());
}

#[test]
fn a_strength_beyond_all_lamps_is_told() {
    let mut harness = panel();
    let slider = harness.get_by_role_and_label(Role::Slider, "Strength");
    slider.set_value_accesskit(5000.0);
    harness.run();
    assert!(lights(&mut harness).is_empty());
    let told = harness.state().notifications.shown();
    assert!(
        told[0].what.contains("intensity") && told[0].what.contains("100"),
        "{told:?}"
    );
}

#[test]
fn researchers_choose_observer_rule_and_samples() {
    let mut harness = panel();
    harness.get_by_label("Advanced colour").click();
    harness.run();
    for (combo, entry) in [("Observer", "1964, 10°"), ("Rule", "gauss")] {
        harness.get_by_role_and_label(Role::ComboBox, combo).click();
        harness.run();
        harness.get_by_label(entry).click();
        harness.run();
    }
    let slider = harness.get_by_role_and_label(Role::Slider, "Samples");
    slider.set_value_accesskit(8.0);
    harness.run();
    let lights = lights(&mut harness);
    let of = |light: &Light| (light.observer, light.rule.clone(), light.samples);
    let asked: Vec<_> = lights.iter().map(|(light, _)| of(light)).collect();
    assert_eq!(asked[0], (1964, "fitted".to_owned(), 16));
    assert_eq!(asked[1], (1931, "gauss".to_owned(), 16));
    assert_eq!(asked[2], (1931, "fitted".to_owned(), 8));
}

#[test]
fn the_panel_looks_as_it_did() {
    let open = |harness: &mut Harness<'static, Bench<LightPanel>>| {
        harness.get_by_label("Advanced colour").click();
        harness.run();
        harness.remove_cursor();
    };
    picture::<LightPanel>("light", &rig(), open, |rig| {
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.light.direction = [0.5, -0.5, 0.7];
    });
}
