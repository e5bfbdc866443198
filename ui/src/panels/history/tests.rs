use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_painting::edits::{Branch, Forget, GoTo, Keep, Redo, ReturnTo, Undo};
use maulstick_types::command::Command;
use maulstick_types::paint::{HistoryStep, StepName};
use maulstick_types::values::VersionName;

use maulstick_client::state::PaintNode;

use super::*;
use crate::rig::state::RigState;
use crate::test_support::panel_bench::{Bench, harness, picture, rig, steps};

fn landscape([red, green, blue]: [u8; 3]) -> Picture {
    let pixel = |i: usize| {
        if i / 40 < 18 {
            [150, 190, 230]
        } else {
            [red, green, blue]
        }
    };
    let rgb: Vec<u8> = (0..40 * 30).flat_map(pixel).collect();
    Picture::new([40, 30], rgb).expect("three bytes a pixel")
}

fn versioned() -> RigState {
    let mut rig = rig();
    let scene = rig.live.scene.as_mut().expect("a scene");
    for (name, parent, here) in [
        ("Cold evening", "Sketch", false),
        ("Sketch", "", false),
        ("Warm", "Sketch", true),
    ] {
        scene.versions.push(NamedVersion {
            name: name.to_owned(),
            parent: parent.to_owned(),
            here,
        });
    }
    rig.live.paint = Some(PaintNode {
        status: steps(12, 0),
        heard_ns: 1,
    });
    for (name, colour) in [("Sketch", [90, 120, 60]), ("Warm", [200, 120, 60])] {
        assert!(rig.live.thumbnails.of(name, 0).is_none());
        rig.live.thumbnails.came(name, Some(landscape(colour)), 0);
    }
    rig
}

/// A rig whose steps 5 to 7 are done and 8 undone.
fn stepped() -> RigState {
    let mut rig = versioned();
    let status = &mut rig.live.paint.as_mut().expect("a node").status;
    (status.undo, status.redo) = (3, 1);
    let stroke = |kind: &str, on_palette| StepName::Stroke {
        kind: kind.to_owned(),
        on_palette,
    };
    let names = [
        StepName::Dry,
        stroke("flat", false),
        stroke("round", true),
        StepName::Load {
            paints: vec!["Yellow Ochre".to_owned()],
        },
    ];
    let steps = (5..9).rev().zip(names);
    status.history = steps
        .map(|(id, what)| HistoryStep {
            id,
            what,
            done: id < 8,
        })
        .collect();
    for (step, blue) in [(8, 60), (7, 60), (6, 0), (0, 0)] {
        let step = Pictured::Step(step);
        assert!(rig.live.thumbnails.of(step.clone(), 0).is_none());
        rig.live
            .thumbnails
            .came(step, Some(landscape([90, 120, blue])), 0);
    }
    rig
}

fn panel() -> Harness<'static, Bench<HistoryPanel>> {
    harness(versioned())
}

fn click(harness: &mut Harness<'static, Bench<HistoryPanel>>, label: &str) {
    harness.get_by_role_and_label(Role::Button, label).click();
    harness.run();
}

fn write(harness: &mut Harness<'static, Bench<HistoryPanel>>, field: &str, text: &str) {
    harness
        .get_by_role_and_label(Role::TextInput, field)
        .focus();
    harness.run();
    harness
        .get_by_role_and_label(Role::TextInput, field)
        .type_text(text);
    harness.run();
}

#[test]
fn steps_go_back_and_forth_where_there_are_some() {
    let mut harness = panel();
    click(&mut harness, "Undo (12)");
    click(&mut harness, "Redo (0)");
    let undo = Command::from(Undo { brush: None });
    assert_eq!(
        harness.state_mut().asked(),
        [undo],
        "there is nothing to redo"
    );
    let paint = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    paint.status = steps(11, 1);
    harness.run();
    click(&mut harness, "Redo (1)");
    let redo = Command::from(Redo { brush: None });
    assert_eq!(harness.state_mut().asked(), [redo]);
}

#[test]
fn a_click_or_a_key_goes_to_a_step() {
    let mut harness = harness::<HistoryPanel>(stepped());
    click(&mut harness, "Now: Flat stroke");
    assert!(
        harness.state_mut().asked().is_empty(),
        "it is there already"
    );
    click(&mut harness, "Back to: Load Yellow Ochre");
    click(&mut harness, "Forward to: Dry");
    harness
        .get_by_role_and_label(Role::Button, "Back to: Beginning")
        .focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    let asked = [5, 8, 0].map(|step| Command::from(GoTo { step }));
    assert_eq!(harness.state_mut().asked(), asked);
    // If older steps are left out, the list does not reach back to the beginning.
    let paint = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    paint.status.undo = 40;
    harness.run();
    assert!(harness.query_by_label("Back to: Beginning").is_none());
}

#[test]
fn pictures_of_steps_that_are_gone_go() {
    let mut harness = harness::<HistoryPanel>(stepped());
    assert_eq!(harness.state().panel.textures.len(), 2 + 4);
    let paint = harness.state_mut().rig.live.paint.as_mut().expect("a node");
    paint.status.history.remove(0);
    harness.run();
    assert_eq!(harness.state().panel.textures.len(), 2 + 3);
}

#[test]
fn versions_are_kept_returned_to_and_branched_from() {
    let mut harness = panel();
    click(&mut harness, "Keep");
    assert!(harness.state_mut().asked().is_empty(), "it has no name yet");
    write(&mut harness, "Name of a version", " Trees ");
    click(&mut harness, "Keep");
    click(&mut harness, "Go back to Sketch");
    click(&mut harness, "New branch from Warm");
    write(&mut harness, "Name of the new version", "Hot");
    harness.key_press(Key::Enter);
    harness.run();
    let name = |name: &str| name.to_owned();
    let expected = [
        Command::from(Keep {
            name: VersionName::new(name("Trees")).expect("valid"),
        }),
        Command::from(ReturnTo {
            name: VersionName::new(name("Sketch")).expect("valid"),
        }),
        Command::from(Branch {
            from: VersionName::new(name("Warm")).expect("valid"),
            name: VersionName::new(name("Hot")).expect("valid"),
        }),
    ];
    assert_eq!(harness.state_mut().asked(), expected);
    assert!(harness.query_by_label("Name of the new version").is_none());
}

#[test]
fn a_version_is_forgotten_after_a_question() {
    let mut harness = panel();
    click(&mut harness, "Delete Warm?");
    click(&mut harness, "Keep Warm");
    assert!(harness.state_mut().asked().is_empty());
    click(&mut harness, "Delete Warm?");
    click(&mut harness, "Delete Warm");
    let name = "Warm".to_owned();
    assert_eq!(
        harness.state_mut().asked(),
        [Command::from(Forget {
            name: VersionName::new(name).expect("valid")
        })]
    );
}

#[test]
fn a_name_that_no_version_can_have_is_told() {
    let mut harness = panel();
    write(&mut harness, "Name of a version", &"x".repeat(200));
    click(&mut harness, "Keep");
    assert!(harness.state_mut().asked().is_empty());
    let told = harness.state().notifications.shown();
    assert!(told[0].what.contains("128"), "{told:?}");
}

#[test]
fn pictures_of_forgotten_versions_go() {
    let mut harness = panel();
    assert_eq!(harness.state().panel.textures.len(), 2);
    let scene = harness
        .state_mut()
        .rig
        .live
        .scene
        .as_mut()
        .expect("a scene");
    scene.versions.retain(|version| version.name != "Warm");
    harness.run();
    assert_eq!(harness.state().panel.textures.len(), 1);
}

#[test]
fn the_panel_looks_as_it_did() {
    let ask = |harness: &mut Harness<'static, Bench<HistoryPanel>>| {
        click(harness, "Delete Cold evening?");
        click(harness, "New branch from Warm");
        harness.remove_cursor();
    };
    picture::<HistoryPanel>("history", &stepped(), ask, |rig| {
        let scene = rig.live.scene.as_mut().expect("a scene");
        scene.versions[2].here = false;
        scene.versions[0].here = true;
    });
}
