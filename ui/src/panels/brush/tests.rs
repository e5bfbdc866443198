//! Brush panel: requests of its controls, and its snapshot.

use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_painting::edits::{Clean, Handle, Load, Tune};
use maulstick_types::Mixture;
use maulstick_types::command::BrushCommand;
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushMode, MARKER_FLOW};
use maulstick_types::values::BrushName;

use super::*;
use crate::settings::presets::Preset;
use crate::test_support::context_bench::{Bench, differ, harness, pictures};

fn panel<'a>(bench: Bench) -> Harness<'a, Bench> {
    let mut harness = harness(BrushPanel::default(), bench);
    harness.run();
    harness
}

fn set(harness: &mut Harness<'_, Bench>, name: &str, value: f64) {
    harness
        .get_by_role_and_label(Role::Slider, name)
        .set_value_accesskit(value);
    harness.run();
}

fn write(harness: &mut Harness<'_, Bench>, field: &str, text: &str) {
    harness.get_by_label(field).focus();
    harness.run();
    harness.get_by_label(field).type_text(text);
    harness.run();
}

#[test]
fn sliders_ask_for_what_they_say() {
    let mut harness = panel(Bench::new());
    set(&mut harness, "Stiffness", 2.0);
    let tuning = Tuning {
        brush: "main".into(),
        stiffness: 2.0,
        wetness: 0.0,
    };
    let commands = harness.state_mut().commands();
    assert_eq!(
        commands,
        [Command::from(Tune::try_from(&tuning).expect("in range"))]
    );
    set(&mut harness, "Wetness", 40.0);
    let tuning = Tuning {
        wetness: 0.4,
        ..tuning
    };
    let commands = harness.state_mut().commands();
    assert_eq!(
        commands,
        [Command::from(Tune::try_from(&tuning).expect("in range"))],
        "the stiffness asked for holds"
    );
    set(&mut harness, "Width", 12.5);
    let commands = harness.state_mut().commands();
    let [Command::Brush(BrushCommand::Define { brush, toml })] = &commands[..] else {
        panic!("{commands:?}")
    };
    assert_eq!(*brush, "main");
    let file = BrushFile::parse(toml).expect("a brush");
    assert_eq!(file.head.width_mm, 12.5);
}

#[test]
fn what_the_rig_says_is_shown_where_nothing_was_asked() {
    let mut bench = Bench::new();
    let mut scene = bench.rig.live.scene.clone().expect("a scene");
    scene.tunings = vec![Tuning {
        brush: "main".into(),
        stiffness: 0.5,
        wetness: 0.3,
    }];
    bench.rig.lay(scene);
    let harness = panel(bench);
    let value = |name: &str| {
        let slider = harness.get_by_role_and_label(Role::Slider, name);
        slider.accesskit_node().numeric_value()
    };
    assert_eq!(value("Stiffness"), Some(0.5));
    assert_eq!(value("Wetness"), Some(30.0));
    assert_eq!(value("Width"), Some(10.0));
}

#[test]
fn the_way_shows_what_belongs_to_it() {
    let mut harness = panel(Bench::new());
    assert!(harness.query_by_label("Flow").is_none());
    harness.get_by_label("Mode").click();
    harness.run();
    harness.get_by_label("Marker").click();
    harness.run();
    let marker = BrushHandling {
        mode: BrushMode::Marker,
        ..BrushHandling::normal("main")
    };
    let commands = harness.state_mut().commands();
    assert_eq!(
        commands,
        [Command::from(Handle::try_from(&marker).expect("in range"))]
    );
    // The rig answers.
    let scene = harness.state_mut().rig.live.scene.as_mut();
    scene.expect("a scene").handlings.push(marker.clone());
    harness.run();
    let flow = harness
        .get_by_role_and_label(Role::Slider, "Flow")
        .accesskit_node()
        .numeric_value();
    assert_eq!(flow, Some(MARKER_FLOW * 1e3));
    harness
        .get_by_role_and_label(Role::CheckBox, "Limit the thickness")
        .click();
    harness.run();
    let handling = BrushHandling {
        most_m: 60e-6,
        ..marker
    };
    assert_eq!(
        harness.state_mut().commands(),
        [Command::from(
            Handle::try_from(&handling).expect("in range")
        )]
    );
    assert!(
        harness
            .query_by_role_and_label(Role::Slider, "Thickness")
            .is_some()
    );
    harness.get_by_label("Mode").click();
    harness.run();
    harness.get_by_label("Lift paint").click();
    harness.run();
    assert!(harness.query_by_label("Limit the thickness").is_none());
}

#[test]
fn a_paint_is_completed_thinned_and_loaded() {
    let mut harness = panel(Bench::new());
    write(&mut harness, "Paint", "ultra");
    harness.get_by_label("Ultramarine Blue").click();
    harness.run();
    set(&mut harness, "Thinner", 20.0);
    harness.get_by_label("Load").click();
    harness.run();
    let mixture: Mixture = "Ultramarine Blue=0.8,Thinner=0.2".parse().expect("one");
    let brush = "main".to_owned();
    let commands = harness.state_mut().commands();
    assert_eq!(
        commands,
        [Command::from(Load {
            mixture,
            beside: None,
            brush: BrushName::new(brush).expect("valid")
        })]
    );
    harness.get_by_label("Clean").click();
    harness.run();
    let brush = "main".to_owned();
    assert_eq!(
        harness.state_mut().commands(),
        [Command::from(Clean {
            brush: BrushName::new(brush).expect("valid")
        })]
    );
}

#[test]
fn two_paints_side_by_side_and_one_that_there_is_not() {
    let mut harness = panel(Bench::new());
    write(&mut harness, "Paint", "Bone Black");
    harness
        .get_by_label("Second colour on the right half")
        .click();
    harness.run();
    write(&mut harness, "Right half", "Colbat Blue");
    harness.key_press(Key::Enter);
    harness.run();
    assert!(harness.state_mut().commands().is_empty());
    let told = "there is no paint called 'Colbat Blue'; did you mean 'Cobalt Blue'?";
    harness.get_by_label(told);
    harness.get_by_label("Right half").focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    write(&mut harness, "Right half", "Cobalt Blue");
    assert!(harness.query_by_label(told).is_none(), "it is another text");
    harness.key_press(Key::Enter);
    harness.run();
    let commands = harness.state_mut().commands();
    let load: Load = commands[0].edit().expect("a load");
    assert_eq!(load.mixture, Mixture::pure("Bone Black"));
    assert_eq!(load.beside, Some(Mixture::pure("Cobalt Blue")));
}

#[test]
fn another_shape_keeps_its_own_width() {
    let mut harness = panel(Bench::new());
    harness.get_by_label("Shape").click();
    harness.run();
    harness.get_by_label("Filbert").click();
    harness.run();
    let commands = harness.state_mut().commands();
    let [Command::Brush(BrushCommand::Define { toml, .. })] = &commands[..] else {
        panic!("{commands:?}")
    };
    let file = BrushFile::parse(toml).expect("a brush");
    assert_eq!((file.kind.as_str(), file.head.width_mm), ("filbert", 16.0));
}

#[test]
fn bristles_are_changed_and_come_back() {
    let mut harness = panel(Bench::new());
    harness.get_by_label("Bristles").click();
    harness.run();
    set(&mut harness, "Inside", 500.0);
    let commands = harness.state_mut().commands();
    let [Command::Brush(BrushCommand::Define { toml, .. })] = &commands[..] else {
        panic!("{commands:?}")
    };
    assert_eq!(BrushFile::parse(toml).expect("one").load.inside_um, 500.0);
    harness.get_by_label("As it was made").click();
    harness.run();
    let commands = harness.state_mut().commands();
    let [Command::Brush(BrushCommand::Define { toml, .. })] = &commands[..] else {
        panic!("{commands:?}")
    };
    let file = BrushFile::parse(toml).expect("one");
    assert_eq!(Ok(file), BrushFile::library("round"));
    assert!(harness.query_by_label("As it was made").is_none());
}

#[test]
fn a_preset_is_saved_and_taken_up() {
    let mut bench = Bench::new();
    bench.preferences.brushes.presets.clear();
    bench.preferences.brushes.loading.paint = "Bone Black".into();
    let mut harness = panel(bench);
    harness.get_by_label("Save this brush").click();
    harness.run();
    harness.get_by_label("Give it a name first.");
    write(&mut harness, "Name", "Ink");
    harness.get_by_label("Save this brush").click();
    harness.run();
    let saved = harness.state().preferences.brushes.presets.clone();
    assert_eq!(
        (saved[0].name.as_str(), saved[0].kind.as_str()),
        ("Ink", "round")
    );
    assert!(saved[0].file.is_empty(), "it is of the library");
    // Another brush, and the preset again.
    harness.state_mut().work().next_brush();
    harness
        .state_mut()
        .preferences
        .brushes
        .loading
        .paint
        .clear();
    harness.state_mut().commands();
    harness.run();
    harness.get_by_label("Ink").click();
    harness.run();
    let commands = harness.state_mut().commands();
    let [
        Command::Brush(BrushCommand::Define { .. }),
        Command::Edit(tune),
        Command::Edit(handle),
    ] = &commands[..]
    else {
        panic!("{commands:?}")
    };
    assert!(tune.is::<Tune>() && handle.is::<Handle>());
    let then = harness.state().rig.brushes[0].then.clone();
    assert!(
        then.is_some_and(|(command, _)| command.edit::<Load>().is_some()),
        "once it is a round one"
    );
    assert_eq!(
        harness.state().preferences.brushes.loading.paint,
        "Bone Black"
    );
}

#[test]
fn a_preset_is_renamed_deleted_and_brought_back() {
    let mut bench = Bench::new();
    let presets = &mut bench.preferences.brushes.presets;
    presets.truncate(1);
    presets[0].name = "Ink".into();
    let mut harness = panel(bench);
    harness.get_by_label("Rename").click();
    harness.run();
    harness.run();
    harness.get_by_label("New name").type_text(" wash");
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(
        harness.state().preferences.brushes.presets[0].name,
        "Ink wash"
    );
    harness.get_by_label("Delete").click();
    harness.run();
    assert!(harness.state().preferences.brushes.presets.is_empty());
    harness.get_by_label("Bring back").click();
    harness.run();
    assert_eq!(
        harness.state().preferences.brushes.presets[0].name,
        "Ink wash"
    );
}

#[test]
fn a_preset_that_was_spoilt_changes_nothing_and_is_told() {
    let mut bench = Bench::new();
    let spoilt = |change: fn(&mut Preset)| {
        let mut preset = Preset {
            name: "x".into(),
            ..Preset::default()
        };
        change(&mut preset);
        preset
    };
    let faults = [
        spoilt(|preset| preset.kind = "rnd".into()),
        spoilt(|preset| preset.width_mm = f64::NAN),
        spoilt(|preset| preset.stiffness = -1.0),
        spoilt(|preset| preset.mode = "spnge".into()),
        spoilt(|preset| preset.file = "kind = 7".into()),
        spoilt(|preset| preset.loading.paint = "Blue=3".into()),
    ];
    for preset in faults {
        assert!(bench.work().take_up_preset(&preset).is_err(), "{preset:?}");
        assert!(bench.requests.take().is_empty(), "{preset:?}");
    }
    assert!(
        bench.work().take_up_preset(&Preset::default()).is_ok(),
        "a fault would pass"
    );
}

#[test]
fn a_brush_file_that_is_none_is_told() {
    let mut harness = panel(Bench::new());
    harness.get_by_label("Own brush files").click();
    harness.run();
    write(&mut harness, "File", "/nowhere/rake.toml");
    harness.get_by_label("Add to the rack").click();
    harness.run();
    assert!(harness.state().preferences.brushes.own_brushes.is_empty());
    let told = harness.state().notifications.shown();
    assert_eq!(told.len(), 1, "{told:?}");
}

#[test]
fn a_brush_that_has_said_nothing_is_waited_for() {
    let mut bench = Bench::new();
    bench.rig.brushes[0].file = None;
    let harness = panel(bench);
    harness.get_by_label("The brush 'main' has not said yet what it is.");
}

#[test]
fn it_looks_as_it_should() {
    let bench = || {
        let mut bench = Bench::new();
        bench.preferences.brushes.loading.paint = "Ultramarine Blue=0.6,Titanium White=0.4".into();
        let preset = bench.work().preset_in_hand("Evening sky").expect("a brush");
        bench.preferences.brushes.presets.push(preset);
        bench
    };
    let mut shown = panel(bench());
    shown.fit_contents();
    shown.snapshot_options("brush", &pictures());
    let mut other = bench();
    other.rig.in_hand = 1;
    let mut other = panel(other);
    other.fit_contents();
    assert!(differ(&mut shown, &mut other), "a fault would pass");
}
