//! The rack: its brushes, and the requests of a click.

use std::cell::Cell;

use eframe::egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maulstick_types::command::BrushCommand;
use maulstick_types::command::Command;

use maulstick_client::request::Request as Asked;

use super::*;
use crate::test_support::context_bench::{Bench, differ, pictures, window};

fn rack<'a>(bench: Bench) -> Harness<'a, Bench> {
    let mut harness = window(vec2(240.0, 700.0), bench, |ui, work| {
        show(ui.ctx(), work);
    });
    harness.run();
    harness
}

#[test]
fn a_click_takes_a_brush_into_the_hand_at_its_width() {
    let mut bench = Bench::new();
    bench
        .preferences
        .brushes
        .widths_mm
        .insert("flat".into(), 30.0);
    let mut harness = rack(bench);
    harness.get_by_label("Flat, 30 mm").click();
    harness.run();
    let requests = harness.state_mut().requests.take();
    let [
        Asked::Command {
            node,
            command: Command::Brush(BrushCommand::Define { brush, toml }),
        },
    ] = &requests[..]
    else {
        panic!("{requests:?}")
    };
    assert_eq!((node.as_str(), brush.as_str()), ("main", "main"));
    let file = BrushFile::parse(toml).expect("a brush");
    assert_eq!((file.kind.as_str(), file.head.width_mm), ("flat", 30.0));
}

#[test]
fn the_keyboard_reaches_it_and_the_other_brush_of_the_rig() {
    let mut harness = rack(Bench::new());
    harness.get_by_label("other").click();
    harness.run();
    assert_eq!(harness.state().rig.in_hand, 1);
    harness.get_by_label("Liner, 2.5 mm").focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    let requests = harness.state_mut().requests.take();
    let [Asked::Command { node, .. }] = &requests[..] else {
        panic!("{requests:?}")
    };
    assert_eq!(node, "other");
}

#[test]
fn it_covers_a_strip_at_the_side_of_the_hand() {
    for left_handed in [false, true] {
        let mut bench = Bench::new();
        bench.preferences.window.left_handed = left_handed;
        let covered = Cell::new(Rect::NOTHING);
        let mut harness = window(vec2(400.0, 300.0), bench, |ui, work| {
            covered.set(show(ui.ctx(), work));
        });
        harness.run();
        let edges = if left_handed {
            (0.0, WIDTH)
        } else {
            (400.0 - WIDTH, 400.0)
        };
        let covered = covered.get();
        assert_eq!((covered.left(), covered.right()), edges);
        assert_eq!((covered.top(), covered.bottom()), (0.0, 300.0));
    }
}

#[test]
fn files_of_ones_own_join_it_and_a_lost_one_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rake.toml");
    let text = BrushFile::library_text("fan").expect("fan");
    let text = text.replace("kind = \"fan\"", "kind = \"rake\"");
    std::fs::write(&path, text).expect("written");
    let mut bench = Bench::new();
    bench.preferences.brushes.own_brushes = vec![folder.path().join("lost.toml"), path];
    let mut harness = rack(bench);
    harness.get_by_label("Rake, 40 mm").click_accesskit();
    harness.run();
    let commands = harness.state_mut().commands();
    assert!(
        matches!(&commands[..], [Command::Brush(BrushCommand::Define { .. })]),
        "{commands:?}"
    );
    harness.get_by_label("Lost").click_accesskit();
    harness.run();
    assert_eq!(harness.state().told().len(), 1);
}

#[test]
fn it_looks_as_it_should() {
    let mut harness = rack(Bench::new());
    harness.snapshot_options("rack", &pictures());
    let mut other = Bench::new();
    other.rig.in_hand = 1;
    assert!(differ(&mut harness, &mut rack(other)), "a fault would pass");
}
