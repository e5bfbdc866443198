//! `maulstick take`: takes changed, and an outline filled by example.

#[path = "../../../tests/support/place.rs"]
mod place;

use clap::{FromArgMatches as _, Subcommand as _};
use maulstick::commands::take::{self, TakeCommand};
use maulstick_device::Take;
use place::{COARSE, Place, fault, has};
use serde_json::Value;

/// A leaf of 60 mm about the middle of the desk.
const LEAF: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">
<path d="M20 50 C 35 25 65 25 80 50 C 65 75 35 75 20 50 Z"/></svg>"#;

/// Carries out a command of `maulstick take` itself.
fn carry_out(place: &Place, words: &[&str]) {
    let is_file = |word: &str| word.contains('.') && !word.starts_with(char::is_numeric);
    let whole = words.iter().map(|word| {
        if is_file(word) {
            place.path(word).display().to_string()
        } else {
            (*word).to_owned()
        }
    });
    let program = TakeCommand::augment_subcommands(clap::Command::new("take"));
    let matches = program.get_matches_from(std::iter::once("take".to_owned()).chain(whole));
    let command = TakeCommand::from_arg_matches(&matches).expect("read");
    take::run(&command).expect("carried out");
}

/// Strokes of a take as `take strokes` lists them.
fn listed(place: &Place, take: &str) -> Vec<Value> {
    let told = place.done(&["take", "strokes", take, "--json"]).stdout;
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    told["strokes"].as_array().expect("strokes").clone()
}

fn number(stroke: &Value, key: &str) -> f64 {
    stroke[key].as_f64().expect("a number")
}

fn samples(place: &Place, take: &str) -> usize {
    Take::read(&place.path(take)).expect("a take").samples.len()
}

/// A take, and its first two strokes as another one.
fn cut(place: &Place) {
    place.short_demo("hand.mcap", 10.0);
    place.done(&[
        "take",
        "cut",
        "hand.mcap",
        "--strokes",
        "1-2",
        "-o",
        "one.mcap",
    ]);
}

#[test]
fn a_take_is_cut_and_joined() {
    let place = Place::new();
    cut(&place);
    let all = listed(&place, "hand.mcap");
    assert!(all.len() >= 4, "{all:?}");
    let motion = |words: &[&str]| place.done(&[&["take"], words].concat());
    let rest = format!("3-{}", all.len());
    motion(&["cut", "hand.mcap", "--strokes", &rest, "-o", "two.mcap"]);
    let parts = [samples(&place, "one.mcap"), samples(&place, "two.mcap")];
    assert_eq!(parts[0] + parts[1], samples(&place, "hand.mcap"));
    motion(&["join", "one.mcap", "two.mcap", "-o", "joined.mcap"]);
    let joined = listed(&place, "joined.mcap");
    assert_eq!(joined.len(), all.len());
    for (own, before) in joined.iter().zip(&all) {
        assert_eq!(own["box_mm"], before["box_mm"]);
    }
}

#[test]
fn a_take_is_placed_mirrored_and_retimed() {
    let place = Place::new();
    cut(&place);
    let motion = |words: &[&str]| place.done(&[&["take"], words].concat());
    motion(&["scale", "one.mcap", "--by", "0.5", "-o", "small.mcap"]);
    motion(&["scale", "small.mcap", "--by", "2", "-o", "again.mcap"]);
    motion(&["rotate", "one.mcap", "--by", "-90", "-o", "turned.mcap"]);
    motion(&["move", "one.mcap", "--by", "-5,2.5", "-o", "moved.mcap"]);
    motion(&[
        "mirror",
        "one.mcap",
        "--about",
        "0,0",
        "-o",
        "mirrored.mcap",
    ]);
    motion(&["retime", "one.mcap", "--rate", "0.5", "-o", "slow.mcap"]);
    let [one, small, again, slow] =
        ["one.mcap", "small.mcap", "again.mcap", "slow.mcap"].map(|take| listed(&place, take));
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6 * b.abs().max(1.0), "{a} {b}");
    for stroke in 0..2 {
        close(
            number(&small[stroke], "way_mm"),
            0.5 * number(&one[stroke], "way_mm"),
        );
        close(
            number(&again[stroke], "way_mm"),
            number(&one[stroke], "way_mm"),
        );
        close(
            number(&slow[stroke], "seconds"),
            2.0 * number(&one[stroke], "seconds"),
        );
    }
    let edges = |take: &str| -> [f64; 4] {
        let stroke = listed(&place, take).remove(0);
        [0, 1, 2, 3].map(|edge| stroke["box_mm"][edge].as_f64().expect("a number"))
    };
    let [x0, y0, x1, y1] = edges("one.mcap");
    for (take, wanted) in [
        ("moved.mcap", [x0 - 5.0, y0 + 2.5, x1 - 5.0, y1 + 2.5]),
        ("mirrored.mcap", [-x1, y0, -x0, y1]),
    ] {
        edges(take)
            .iter()
            .zip(wanted)
            .for_each(|(got, wanted)| close(*got, wanted));
    }
    let [a0, b0, a1, b1] = edges("turned.mcap");
    close(a1 - a0, y1 - y0);
    close(b1 - b0, x1 - x0);
}

#[test]
fn what_a_take_is_painted_with_stays_and_its_strokes_keep_their_loads() {
    let place = Place::new();
    place.short_demo("bare.mcap", 10.0);
    let kit = [
        "--brush",
        "filbert",
        "--load",
        "Bone Black",
        "--load",
        "Cobalt Blue",
    ];
    let embed = ["embed", "bare.mcap", "-o", "hand.mcap"];
    carry_out(&place, &[&embed[..], &kit, &COARSE].concat());
    let loads = |take: &str| {
        let take = Take::read(&place.path(take)).expect("a take");
        take.setup.expect("a setup").loads
    };
    place.done(&[
        "take",
        "cut",
        "hand.mcap",
        "--strokes",
        "2-3",
        "-o",
        "later.mcap",
    ]);
    let [bone, cobalt]: [String; 2] = loads("hand.mcap").try_into().expect("two loads");
    assert_eq!(loads("later.mcap"), [cobalt.clone(), bone.clone()]);
    place.done(&[
        "take",
        "cut",
        "hand.mcap",
        "--strokes",
        "1",
        "-o",
        "first.mcap",
    ]);
    place.done(&["take", "join", "later.mcap", "first.mcap", "-o", "all.mcap"]);
    assert_eq!(loads("all.mcap"), [cobalt, bone.clone(), bone]);
    let other = [
        "embed",
        "first.mcap",
        "--brush",
        "round",
        "-o",
        "other.mcap",
    ];
    carry_out(&place, &other);
    let said = fault(
        &place,
        &["take", "join", "later.mcap", "other.mcap", "-o", "no.mcap"],
        2,
    );
    has(&said, &["different", "maulstick take embed"]);
    assert!(!place.path("no.mcap").exists());
}

#[test]
fn an_outline_is_filled_by_example_always_alike_by_its_seed() {
    let place = Place::new();
    place.short_demo("hand.mcap", 10.0);
    std::fs::write(place.path("leaf.svg"), LEAF).expect("written");
    // Three broad sweeps beside each other, drawn together to hatching.
    place.done(&[
        "take",
        "cut",
        "hand.mcap",
        "--strokes",
        "1-3",
        "-o",
        "sweeps.mcap",
    ]);
    place.done(&[
        "take",
        "scale",
        "sweeps.mcap",
        "--by",
        "0.15",
        "-o",
        "hatching.mcap",
    ]);
    let fill = [
        "take",
        "fill",
        "--example",
        "hatching.mcap",
        "--into",
        "leaf.svg",
    ];
    let with = |more: &[&str]| place.done(&[&fill[..], &["--inset-mm", "2"], more].concat());
    with(&[]);
    with(&["-o", "again.mcap"]);
    with(&["-o", "other.mcap", "--seed", "2"]);
    let is_same = place.bytes("leaf-fill.mcap") == place.bytes("again.mcap");
    assert!(is_same, "one seed, two takes");
    assert_ne!(place.bytes("leaf-fill.mcap"), place.bytes("other.mcap"));
    let strokes = listed(&place, "leaf-fill.mcap");
    assert!(strokes.len() > 5, "{strokes:?}");
    for stroke in &strokes {
        let edge = |edge: usize| stroke["box_mm"][edge].as_f64().expect("a number");
        assert!(
            edge(0) > -30.0 && edge(2) < 30.0 && edge(1) > -19.0 && edge(3) < 19.0,
            "{stroke}"
        );
    }
    let load = ["--load", "Cobalt Blue", COARSE[0], COARSE[1]];
    let render = ["render", "leaf-fill.mcap", "-o", "leaf.png"];
    carry_out(&place, &[&render[..], &load].concat());
    let wide = [&fill[..], &["--inset-mm", "40", "-o", "no.mcap"]].concat();
    has(&fault(&place, &wide, 2), &["no room", "--inset-mm"]);
    assert!(!place.path("no.mcap").exists());
}

#[test]
fn what_motions_cannot_do_is_said() {
    let place = Place::new();
    place.short_demo("hand.mcap", 10.0);
    std::fs::write(place.path("none.svg"), "<svg").expect("written");
    for (words, told) in [
        (
            &["cut", "hand.mcap", "--strokes", "90", "-o", "a.mcap"][..],
            "no stroke 90",
        ),
        (
            &["cut", "hand.mcap", "--start", "900", "-o", "a.mcap"],
            "no sample lies between",
        ),
        (
            &["scale", "hand.mcap", "--by", "-2", "-o", "a.mcap"],
            "is not within 0.01 and 100",
        ),
        (
            &["retime", "hand.mcap", "--rate", "0", "-o", "a.mcap"],
            "a rate of 0",
        ),
        (
            &["move", "hand.mcap", "--by", "20000,0", "-o", "a.mcap"],
            "-10 and 10",
        ),
        (
            &["scale", "hand.mcap", "--by", "2", "-o", "hand.mcap"],
            "would take the place of",
        ),
        (
            &[
                "fill",
                "--example",
                "hand.mcap",
                "--into",
                "none.svg",
                "-o",
                "a.mcap",
            ],
            "save it as plain SVG",
        ),
    ] {
        has(&fault(&place, &[&["take"], words].concat(), 2), &[told]);
        assert!(!place.path("a.mcap").exists());
    }
}
