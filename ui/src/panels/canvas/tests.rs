use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_painting::edits::{Fill, FillPaint, Flip, Ground, Piles, Place, Size, Tooth};
use maulstick_types::Mixture;
use maulstick_types::command::Command;
use maulstick_types::values::{BrushName, FilmThickness, MaterialName, StainThickness};

use super::*;
use crate::test_support::panel_bench::{Bench, harness, picture, rig};

fn panel() -> Harness<'static, Bench<CanvasPanel>> {
    harness(rig())
}

fn choose(harness: &mut Harness<'static, Bench<CanvasPanel>>, combo: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, combo).click();
    harness.run();
    harness.get_by_label(entry).click();
    harness.run();
}

fn set(harness: &mut Harness<'static, Bench<CanvasPanel>>, role: Role, label: &str, value: f64) {
    harness
        .get_by_role_and_label(role, label)
        .set_value_accesskit(value);
    harness.run();
}

#[test]
fn another_paint_model_is_asked_for() {
    let mut harness = panel();
    choose(&mut harness, "Paint model", "dab");
    let expected = [Command::from(Convert {
        model: ModelName::new("dab").expect("valid"),
        surface: CANVAS,
    })];
    assert_eq!(harness.state_mut().asked(), expected);
    choose(&mut harness, "Paint model", "stokes");
    assert_ne!(harness.state_mut().asked(), expected, "a fault would pass");
}

/// Unfolds what few painters need.
fn advanced(harness: &mut Harness<'static, Bench<CanvasPanel>>) {
    harness.get_by_label("Advanced").click();
    harness.run();
}

#[test]
fn tooth_ground_and_sizing_are_asked_for() {
    let mut harness = panel();
    let seed = harness.state().rig.live.canvas().expect("one").tooth_seed;
    choose(&mut harness, "Tooth", "paper");
    advanced(&mut harness);
    set(&mut harness, Role::SpinButton, "Cloth piece", 7.0);
    choose(&mut harness, "Ground", "grey");
    set(&mut harness, Role::Slider, "Absorbency", 12.0);
    let tooth = |tooth: &str, seed: u64| {
        Command::from(Tooth {
            tooth: MaterialName::new(tooth).expect("valid"),
            seed,
            surface: CANVAS,
        })
    };
    let expected = [
        tooth("paper", seed),
        tooth("linen", 7),
        Command::from(Ground::named(CANVAS, "grey").expect("valid")),
        Command::from(Size {
            stain: StainThickness::new(12.0 * 1e-6).expect("in range"),
            surface: CANVAS,
        }),
    ];
    assert_eq!(harness.state_mut().asked(), expected);
    set(&mut harness, Role::Slider, "Absorbency", 5e4);
    assert!(harness.state_mut().asked().is_empty());
    let told = harness.state().notifications.shown();
    assert!(
        told[0].what.contains("stain") && told[0].what.contains("1000 µm"),
        "{told:?}"
    );
}

#[test]
fn a_measured_ground_is_read_or_told_with_its_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("toned.csv");
    std::fs::write(&path, "400,0.4\n700,1.6\n").expect("written");
    let mut harness = panel();
    advanced(&mut harness);
    let field = |harness: &mut Harness<'static, Bench<CanvasPanel>>, text: &str| {
        let label = "Ground from";
        harness
            .get_by_role_and_label(Role::TextInput, label)
            .focus();
        harness.run();
        if !text.is_empty() {
            let field = harness.get_by_role_and_label(Role::TextInput, label);
            field.type_text(text);
            harness.run();
        }
        harness.key_press(Key::Enter);
        harness.run();
    };
    field(&mut harness, &path.display().to_string());
    assert!(harness.state_mut().asked().is_empty());
    harness.get_by_label_contains("toned.csv:2");
    let good = "400,0.4\n700,0.6\n";
    std::fs::write(&path, good).expect("written");
    field(&mut harness, "");
    let expected = Command::from(Ground::spectrum(CANVAS, good).expect("valid"));
    assert_eq!(harness.state_mut().asked(), [expected]);
}

#[test]
fn the_canvas_is_tilted_turned_and_zoomed_each_beside_the_others() {
    let mut harness = panel();
    set(&mut harness, Role::Slider, "Tilt", 30.0);
    set(&mut harness, Role::Slider, "Turn", -15.0);
    set(&mut harness, Role::Slider, "Zoom", 200.0);
    let canvas = harness.state().rig.live.canvas().expect("one").clone();
    let (pose, zoom) = Posture {
        tilt_deg: 30.0,
        turn_deg: -15.0,
        zoom: 2.0,
    }
    .laid(&canvas);
    let asked = harness.state_mut().asked();
    assert_eq!(asked.len(), 3);
    let last = Command::from(Place::new(CANVAS, pose, zoom).expect("in reach"));
    assert_eq!(asked[2], last);
    assert_ne!(asked[1], last, "a fault would pass");
}

#[test]
fn buttons_do_what_keys_do() {
    let mut harness = panel();
    for label in ["Fit", "Actual pixels (1:1)", "New…"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let acts = harness.state_mut().requests.take_acts();
    assert_eq!(acts, [Action::Fit, Action::Hundred, Action::New]);
}

#[test]
fn a_tracing_picture_is_chosen_shown_and_removed() {
    let mut harness = panel();
    let click = |harness: &mut Harness<'static, Bench<CanvasPanel>>, label: &str| {
        harness.get_by_label(label).click();
        harness.run();
    };
    click(&mut harness, "Tracing picture…");
    let acts = harness.state_mut().requests.take_acts();
    assert_eq!(acts, [Action::ChooseTracing]);
    let traced = |harness: &mut Harness<'static, Bench<CanvasPanel>>| {
        let bench = harness.state_mut();
        bench.work().tracing().cloned()
    };
    harness.state_mut().work().trace(Path::new("/sketch.png"));
    harness.run();
    click(&mut harness, "Show tracing picture");
    set(&mut harness, Role::Slider, "Strength", 80.0);
    let own = traced(&mut harness).expect("one");
    assert!(!own.shown && (own.strength - 0.8).abs() < 1e-6, "{own:?}");
    click(&mut harness, "Another…");
    let acts = harness.state_mut().requests.take_acts();
    assert_eq!(acts, [Action::ChooseTracing]);
    click(&mut harness, "Remove");
    assert_eq!(traced(&mut harness), None);
    harness.get_by_label("Tracing picture…");
}

#[test]
fn the_hand_and_the_lasting_paint_are_switched() {
    let mut harness = panel();
    harness.get_by_label("Left-handed").click();
    harness.run();
    assert!(harness.state().preferences.window.left_handed);
    harness.get_by_label("Palette never runs out").click();
    harness.run();
    let expected = Command::from(Piles {
        last: true,
        surface: PALETTE,
    });
    assert_eq!(harness.state_mut().asked(), [expected]);
}

#[test]
fn a_film_is_of_a_paint_or_of_what_the_brush_carries() {
    let mut harness = panel();
    harness.get_by_label("Cover the canvas with paint").click();
    harness.run();
    harness.get_by_label("Cover").click();
    harness.run();
    choose(&mut harness, "Paint", "Titanium White");
    set(&mut harness, Role::Slider, "Thickness", 20.0);
    harness.get_by_label("Cover").click();
    harness.run();
    let surface = CANVAS;
    let expected = [
        Command::from(Fill {
            paint: FillPaint::Carried {
                brush: BrushName::main(),
            },
            thickness: FilmThickness::new(50.0 * 1e-6).expect("in range"),
            surface,
        }),
        Command::from(Fill {
            paint: FillPaint::Mixture {
                mixture: Mixture::pure("Titanium White"),
            },
            thickness: FilmThickness::new(20.0 * 1e-6).expect("in range"),
            surface,
        }),
    ];
    assert_eq!(harness.state_mut().asked(), expected);
    set(&mut harness, Role::Slider, "Thickness", 9000.0);
    harness.get_by_label("Cover").click();
    harness.run();
    let told = harness.state().notifications.shown();
    assert!(told[0].what.contains("5000 µm"), "{told:?}");
}

#[test]
fn the_canvas_is_flipped() {
    let mut harness = panel();
    harness.get_by_label("Advanced").click();
    harness.run();
    harness.get_by_label("Flip left to right").click();
    harness.run();
    let expected = Command::from(Flip { surface: CANVAS });
    assert_eq!(harness.state_mut().asked(), [expected]);
}

#[test]
fn the_panel_looks_as_it_did() {
    let open = |harness: &mut Harness<'static, Bench<CanvasPanel>>| {
        harness.state_mut().work().trace(Path::new("/sketch.png"));
        harness.run();
        harness.get_by_label("Cover the canvas with paint").click();
        harness.run();
        harness.remove_cursor();
    };
    picture::<CanvasPanel>("canvas", &rig(), open, |rig| {
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.surfaces[0].zoom = 4.0;
    });
}
