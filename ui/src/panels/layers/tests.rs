use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maulstick_painting::edits::{
    Dry, Finish, LayerRef, NameLayer, Opacity, StopDrying, Varnish, Wet,
};
use maulstick_types::Region;
use maulstick_types::command::Command;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::{LayerName, OpacityFactor, Share, Ticks};

use super::*;
use crate::rig::state::RigState;
use crate::test_support::panel_bench::{Bench, harness, picture, rig};

fn layered() -> RigState {
    let mut rig = rig();
    let scene = rig.live.scene.as_mut().expect("a scene");
    for (number, name, opacity) in [
        (1, "Underpainting", 1.0),
        (2, "Sky", 0.6),
        (3, "Trees", 0.0),
    ] {
        scene.layers.push(Layer {
            number,
            name: name.to_owned(),
            opacity,
        });
    }
    rig
}

fn panel() -> Harness<'static, Bench<LayersPanel>> {
    harness(layered())
}

fn opacity(layer: u32, opacity: f32) -> Command {
    Command::from(Opacity {
        layer: LayerRef::Number { number: layer },
        opacity: OpacityFactor::new(opacity).expect("in range"),
    })
}

#[test]
fn the_eye_hides_a_layer_and_shows_it_as_it_was() {
    let mut harness = panel();
    harness.get_by_label("Show Sky").click();
    harness.run_steps(4);
    assert_eq!(harness.state_mut().asked(), [opacity(2, 0.0)]);
    let scene = harness
        .state_mut()
        .rig
        .live
        .scene
        .as_mut()
        .expect("a scene");
    scene.layers[1].opacity = 0.0;
    harness.run_steps(4);
    harness.get_by_label("Show Sky").click();
    harness.run_steps(4);
    harness.get_by_label("Show Trees").click();
    harness.run_steps(4);
    let asked = harness.state_mut().asked();
    assert_eq!(asked, [opacity(2, 0.6), opacity(3, 1.0)]);
}

#[test]
fn a_hidden_layer_is_shown_as_hidden_at_once_and_that_its_picture_comes() {
    let mut harness = panel();
    let comes = |harness: &Harness<'static, Bench<LayersPanel>>| {
        harness
            .query_all_by_role(Role::ProgressIndicator)
            .next()
            .is_some()
    };
    let is_shown = |harness: &Harness<'static, Bench<LayersPanel>>| {
        let eye = harness.get_by_label("Show Sky");
        eye.accesskit_node().toggled() == Some(Toggled::True)
    };
    assert!(!comes(&harness) && is_shown(&harness));
    harness.get_by_label("Show Sky").click();
    harness.run_steps(3);
    assert!(
        comes(&harness) && !is_shown(&harness),
        "the rig has not answered"
    );
    let rig = &mut harness.state_mut().rig;
    rig.live.scene.as_mut().expect("a scene").layers[1].opacity = 0.0;
    let status = &mut rig.live.paint.as_mut().expect("a node").status;
    (status.baking, status.baked) = (100, 20);
    harness.run_steps(3);
    assert!(comes(&harness), "it is computed");
    let status = &mut harness
        .state_mut()
        .rig
        .live
        .paint
        .as_mut()
        .expect("a node")
        .status;
    status.baked = 100;
    harness.run_steps(3);
    assert!(!comes(&harness) && !is_shown(&harness));
}

#[test]
fn an_opacity_is_sent_when_it_is_let_go_and_shown_while_it_is_dragged() {
    let mut harness = panel();
    let slider = harness.get_by_role_and_label(Role::Slider, "Opacity of Sky");
    let place = slider.rect();
    let at = |share: f32| place.left_center() + vec2(share * WAY, 0.0);
    harness.drag_at(at(0.6));
    harness.hover_at(at(0.4));
    harness.hover_at(at(0.25));
    harness.run_steps(4);
    assert!(harness.state_mut().asked().is_empty(), "still in the hand");
    let shown = harness.get_by_role_and_label(Role::Slider, "Opacity of Sky");
    let value = shown.accesskit_node().numeric_value().expect("a number");
    assert!((10.0..40.0).contains(&value), "{value}");
    harness.drop_at(at(0.25));
    harness.run_steps(4);
    let asked = harness.state_mut().asked();
    assert_eq!(asked, [opacity(2, (value * 1e-2) as f32)]);
}

#[test]
fn a_click_on_a_name_gives_another_one() {
    let mut harness = panel();
    harness.get_by_label("Sky").click();
    harness.run_steps(4);
    let field = harness.get_by_label("Name of the layer");
    assert!(field.is_focused());
    field.type_text(" at dusk");
    harness.run_steps(4);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    let named = Command::from(NameLayer {
        layer: 2,
        name: LayerName::new("Sky at dusk").expect("valid"),
    });
    assert_eq!(harness.state_mut().asked(), [named]);
    harness.get_by_label("Trees").click();
    harness.run_steps(4);
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.state_mut().asked().is_empty(), "left as it was");
    assert!(harness.query_by_label("Name of the layer").is_none());
}

#[test]
fn paint_dries_at_once_in_time_or_becomes_wet_again() {
    let mut harness = panel();
    let share = harness.get_by_role_and_label(Role::Slider, "How much");
    share.set_value_accesskit(40.0);
    harness.run_steps(4);
    harness
        .get_by_role_and_label(Role::TextInput, "Name")
        .focus();
    harness.run_steps(4);
    harness
        .get_by_role_and_label(Role::TextInput, "Name")
        .type_text("Fog");
    harness.run_steps(4);
    harness.get_by_label("Dry").click();
    harness.run_steps(4);
    harness.get_by_label("Start").click();
    harness.run_steps(4);
    harness.get_by_label("Stop").click();
    harness.run_steps(4);
    harness.get_by_label("Wet again").click();
    harness.run_steps(4);
    harness.get_by_label("Satin").click();
    harness.run_steps(4);
    let surface = CANVAS;
    let expected = [
        Command::from(Dry {
            share: Share::new(0.4).expect("in range"),
            layer: LayerName::new("Fog").ok(),
            ..Dry::whole(surface)
        }),
        Command::from(Dry {
            over: Some(Ticks::new(120 * 60).expect("in range")),
            ..Dry::whole(surface)
        }),
        Command::from(StopDrying { surface }),
        Command::from(Wet {
            layers: Some(1),
            region: None,
            surface,
        }),
        Command::from(Varnish {
            finish: Finish::Satin,
            region: None,
        }),
    ];
    assert_eq!(harness.state_mut().asked(), expected);
}

#[test]
fn a_part_is_drawn_and_one_that_is_none_is_told() {
    let mut harness = panel();
    harness
        .get_by_role_and_label(Role::ComboBox, "Where")
        .click();
    harness.run_steps(4);
    harness.get_by_label("A part").click();
    harness.run_steps(4);
    let map = harness.get_by_label("Map of the canvas").rect();
    let at = |x: f32, y: f32| map.left_bottom() + vec2(x * map.width(), -y * map.height());
    harness.drag_at(at(0.25, 0.25));
    harness.hover_at(at(0.5, 0.5));
    harness.hover_at(at(0.75, 0.5));
    harness.drop_at(at(0.75, 0.5));
    harness.run_steps(4);
    harness.get_by_label("Dry").click();
    harness.run_steps(4);
    let asked = harness.state_mut().asked();
    let dry: Dry = asked[0].edit().expect("a drying");
    let region = dry.region.expect("of a part");
    let canvas = harness.state().rig.live.canvas().expect("a canvas");
    let size = canvas.cells.map(|cells| f64::from(cells) * canvas.cell_m);
    let expected = Region {
        corner_m: size.map(|side| 0.25 * side),
        size_m: [0.5 * size[0], 0.25 * size[1]],
    };
    let near = |one: [f64; 2], other: [f64; 2]| (0..2).all(|i| (one[i] - other[i]).abs() < 2e-4);
    assert!(near(region.corner_m, expected.corner_m), "{region}");
    assert!(near(region.size_m, expected.size_m), "{region}");
    harness
        .get_by_role_and_label(Role::SpinButton, "Width")
        .set_value_accesskit(-3.0);
    harness.run_steps(4);
    harness.get_by_label("Dry").click();
    harness.run_steps(4);
    assert!(harness.state_mut().asked().is_empty());
    let told = harness.state().notifications.shown();
    assert!(
        told[0].what.contains("region") && told[0].what.contains("X,Y,WxH"),
        "{told:?}"
    );
}

#[test]
fn the_panel_looks_as_it_did() {
    let part = |harness: &mut Harness<'static, Bench<LayersPanel>>| {
        harness
            .get_by_role_and_label(Role::ComboBox, "Where")
            .click();
        harness.run_steps(4);
        harness.get_by_label("A part").click();
        harness.run_steps(4);
        harness.remove_cursor();
    };
    picture::<LayersPanel>("layers", &layered(), part, |rig| {
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.layers[1].opacity = 0.1;
    });
}
