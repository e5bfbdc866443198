//! A day at the easel as a script.

mod support;

use support::{Place, assert_same, fault, has};

const LOAD: &str = "Ultramarine Blue";

fn script(place: &Place, name: &str, steps: &str) {
    let text = format!("step = [\n{steps}\n]\n");
    std::fs::write(place.path(name), text).expect("written");
}

#[test]
fn a_script_of_a_take_is_the_take_and_more_steps_are_more() {
    let place = Place::new();
    place.short_demo("flower.mcap", 4.0);
    let size = ["--size", "640x600"];
    let take = ["render", "flower.mcap", "-o", "take.png", "--load", LOAD];
    place.done(&[&take[..], &size].concat());
    let paint = |steps: &str, picture: &str| {
        script(&place, "day.toml", steps);
        place.done(
            &[
                &["render", "--script", "day.toml", "-o", picture],
                &size[..],
            ]
            .concat(),
        );
        place.bytes(picture)
    };
    let painted = format!(
        "{{ brush = \"round\", size_mm = 10 }},\n{{ take = \"flower.mcap\", loads = [\"{LOAD}\"] }},"
    );
    let same = paint(&painted, "script.png");
    assert_same(
        &place.bytes("take.png"),
        &same,
        "a take, and a script of it",
    );
    let glazed = format!(
        "{painted}\n{{ dry = 1.0, layer = \"drawing\" }},\n{{ fill = \"Yellow Ochre\", um = 20 }},"
    );
    let more = paint(&glazed, "more.png");
    assert!(more != same);
    let veiled = paint(
        &format!("{glazed}\n{{ opacity = 0.2, layer = \"drawing\" }},"),
        "veiled.png",
    );
    assert!(veiled != more);
    let undone = paint(&format!("{glazed}\n{{ undo = 2 }},"), "undone.png");
    assert_same(&same, &undone, "the fill and the drying taken back");
    let lamp = paint(
        &format!("{painted}\n{{ light = {{ direction = [1, 0, 0.4] }} }},"),
        "lamp.png",
    );
    assert!(lamp != same);
}

#[test]
fn two_takes_are_two_strokes_in_a_document_and_a_fault_keeps_what_was_painted() {
    let place = Place::new();
    place.short_demo("flower.mcap", 3.0);
    let file = ["--document", "day.maul"];
    script(
        &place,
        "day.toml",
        "{ load = \"Bone Black\" },\n{ take = \"flower.mcap\" },\n{ keep = \"one\" },\n{ opacity = 0.5, layer = \"sky\" },",
    );
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    let said = fault(&place, &[&render[..], &file].concat(), 2);
    has(&said, &["'sky'", "day.toml:5"]);
    assert!(!place.path("day.png").exists());
    let kept = place
        .done(&["painting", "info", "--json", "day.maul"])
        .stdout;
    let kept: serde_json::Value = serde_json::from_slice(&kept).expect("JSON");
    assert_eq!(kept["versions"][0], "one");
    assert!(kept["undo"].as_u64() >= Some(2), "{kept}");
    assert_eq!(kept["ledger"]["quanta_missing"], 0);
}

#[test]
fn what_is_wrong_is_told_before_anything_is_painted() {
    let place = Place::new();
    script(&place, "day.toml", "{ dyr = 1.0 },");
    let render = ["render", "--script", "day.toml", "-o", "day.png"];
    has(
        &fault(&place, &render, 2),
        &["day.toml:2", "'dyr'", "'dry'"],
    );
    let over = ["render", "--script", "day.toml", "-o", "day.toml"];
    script(&place, "day.toml", "{ fill = \"Bone Black\" },");
    has(&fault(&place, &over, 2), &["overwritten", "day.toml"]);
    has(&fault(&place, &["render", "-o", "day.png"], 2), &["<TAKE>"]);
}
