//! Mixing colours on the command line: what `mix`, `match` and `paints` print, draw and refuse.

#[path = "../support/mod.rs"]
mod support;

use std::fmt::Write as _;

use serde_json::Value;
use support::{Place, fault, has};

fn json(place: &Place, args: &[&str]) -> Value {
    let mut args = args.to_vec();
    args.push("--json");
    serde_json::from_slice(&place.done(&args).stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list").iter();
    list.map(|number| number.as_f64().expect("a number"))
        .collect()
}

/// A paint file of one's own: a white, a grey, a black.
fn own_paints() -> String {
    let mut text = String::from("# mine\n");
    for (name, k, s) in [
        ("Chalk", 0.0001, 1.0),
        ("Slate", 0.3, 0.5),
        ("Soot", 5.0, 0.01),
    ] {
        for (quantity, value) in [("K", k), ("S", s)] {
            let values = format!(",{value}").repeat(101);
            writeln!(text, "{name},PX,me,{quantity}{values}").expect("written");
        }
    }
    text
}

#[test]
fn a_mix_is_printed_as_spectrum_and_colour() {
    let place = Place::new();
    let green = "Cobalt Blue=0.5,Hansa Yellow Opaque=0.5";
    let mixed = json(&place, &["colour", "mix", green]);
    let lists = ["reflectance", "xyz", "lab", "srgb"].map(|key| numbers(&mixed[key]));
    assert_eq!(lists.each_ref().map(Vec::len), [101, 3, 3, 3]);
    let [reflectance, xyz, lab, srgb] = lists;
    assert!(reflectance.iter().all(|r| (0.0..=1.0).contains(r)));
    assert!(srgb.iter().all(|channel| (0.0..=1.0).contains(channel)));
    assert!(xyz[1] > 1.0 && lab[1] < -20.0, "a green: {xyz:?} {lab:?}");
    assert_eq!(mixed["in_gamut"], true);
    // The surface darkens what is inside and adds its gloss.
    let seen = json(&place, &["colour", "mix", green, "--saunderson"]);
    let outside = numbers(&seen["reflectance"]);
    for (r, outside) in reflectance.iter().zip(outside) {
        let expected = 0.03 + 0.97 * 0.35 * r / (1.0 - 0.65 * r);
        assert!((outside - expected).abs() < 1e-12);
    }
    let orange = json(&place, &["colour", "mix", "Cadmium Orange"]);
    assert_eq!(orange["in_gamut"], false);
    let text = place.done(&["colour", "mix", green]).stdout;
    has(
        &String::from_utf8_lossy(&text),
        &[green, "#", "L*", "in gamut", "▁"],
    );
    assert!(!text.contains(&0x1b), "no colours in a pipe");
}

#[test]
fn a_mix_in_a_film_lies_between_its_ground_and_its_masstone() {
    let place = Place::new();
    let white = |args: &[&str]| {
        let mut all = vec!["colour", "mix", "Titanium White"];
        all.extend(args);
        numbers(&json(&place, &all)["reflectance"])[60]
    };
    let film = white(&["--film-um", "25", "--over", "black"]);
    assert!((film - 0.79).abs() < 0.01, "{film}");
    let thinned = white(&["--film-um", "50", "--over", "black", "--thinner", "0.5"]);
    assert!((film - thinned).abs() < 1e-12);
    assert!(white(&["--film-um", "25", "--over", "0.5"]) > film);
    assert!(white(&["--film-um", "25"]) > white(&["--film-um", "25", "--over", "0.5"]));
    // What is given is a reading: it comes back as one, and less lies inside the paint.
    let read = white(&["--film-um", "0", "--over", "0.25", "--saunderson"]);
    assert!((read - 0.25).abs() < 1e-12, "{read}");
    let inside = white(&["--film-um", "0", "--over", "0.25"]);
    assert!(
        (inside - 0.22 / (0.97 * 0.35 + 0.22 * 0.65)).abs() < 1e-12,
        "{inside}"
    );
    assert_eq!(white(&["--thinner", "0.9"]), white(&[]));
}

#[test]
fn a_mix_is_seen_under_any_light_by_either_observer() {
    let place = Place::new();
    std::fs::write(place.path("mine.csv"), "nm,power\n380,1\n780,1\n").expect("written");
    std::fs::write(place.path("paints.csv"), own_paints()).expect("written");
    let xyz = |args: &[&str]| {
        let mut all = vec!["colour", "mix", "Chalk", "--paints", "paints.csv"];
        all.extend(args);
        json(&place, &all)
    };
    // CIE 15: the white of each light, of which chalk reflects nearly all.
    for (args, white) in [
        (
            ["--illuminant", "D65", "--observer", "1931"],
            [95.043, 100.0, 108.880],
        ),
        (
            ["--illuminant", "A", "--observer", "1964"],
            [111.144, 100.0, 35.200],
        ),
        (
            ["--illuminant", "mine.csv", "--observer", "1931"],
            [100.0, 100.0, 100.0],
        ),
    ] {
        let seen = xyz(&args);
        let got = numbers(&seen["xyz"]);
        let chalk = got[1] / 100.0;
        assert!((0.97..1.0).contains(&chalk));
        for (got, white) in got.iter().zip(white) {
            assert!((got / chalk - white).abs() < 0.1, "{args:?}: {got} {white}");
        }
        let spread = |seen: &Value| {
            let srgb = numbers(&seen["srgb"]);
            (srgb[0] - srgb[2]).abs()
        };
        assert!(spread(&seen) < 1e-3, "adapted to the light");
        let mut cast = args.to_vec();
        cast.push("--no-adapt");
        if args[1] == "A" {
            assert!(spread(&xyz(&cast)) > 0.2, "the light's cast");
        }
    }
    for rule in [
        &["--rule", "gauss", "--samples", "8"][..],
        &["--rule", "reference"],
        &["--samples", "4"],
    ] {
        let lab = numbers(&xyz(rule)["lab"]);
        assert!(
            lab[0] > 98.0 && lab[1].abs() < 1.0 && lab[2].abs() < 1.0,
            "{rule:?}"
        );
    }
}

#[test]
fn bad_mixes_are_refused() {
    let place = Place::new();
    let refused = |args: &[&str], words: &[&str]| {
        let mut all = vec!["colour", "mix"];
        all.extend(args);
        has(&fault(&place, &all, 2), words);
    };
    refused(&[], &["MIX"]);
    refused(
        &["Cobalt Blue=0,Bone Black=0.4"],
        &["'Cobalt Blue' is '0'", "help:"],
    );
    refused(
        &["Colbat Blue"],
        &["'Colbat Blue'", "'Cobalt Blue'", "maulstick colour paints"],
    );
    refused(&["Cobalt Blue=a,Bone Black=1"], &["'a'", "Cobalt Blue"]);
    refused(&["Cobalt Blue", "Bone Black"], &["more than one", "comma"]);
    let blue = |extra: &[&str], words: &[&str]| {
        let mut all = vec!["Cobalt Blue"];
        all.extend(extra);
        refused(&all, words);
    };
    blue(&["--illuminant", "D66"], &["'D66'", "'D65'", "FL11"]);
    blue(
        &["--illuminant", "none.csv"],
        &["none.csv", "check the path"],
    );
    blue(&["--observer", "1932"], &["1931", "1964"]);
    blue(&["--rule", "simpson"], &["simpson", "gauss"]);
    blue(&["--samples", "3"], &["4..=16"]);
    blue(&["--samples", "17"], &["4..=16"]);
    blue(&["--film-um", "-1"], &["-1", "thickness"]);
    blue(&["--film-um", "nan"], &["nan", "thickness"]);
    blue(
        &["--film-um", "9", "--over", "grey"],
        &["grey", "white", "black"],
    );
    blue(&["--over", "black"], &["--film-um"]);
    blue(&["--film-um", "9", "--thinner", "1.5"], &["1.5", "share"]);
    blue(&["--paints", "none.csv"], &["none.csv", "check the path"]);
    std::fs::write(place.path("light.csv"), "nm,power\n380,1\n390,x\n").expect("written");
    blue(&["--illuminant", "light.csv"], &["light.csv:3", "'x'"]);
    let broken = own_paints().replacen("0.3,", "bad,", 1);
    std::fs::write(place.path("paints.csv"), broken).expect("written");
    blue(
        &["--paints", "paints.csv"],
        &["paints.csv:4", "'bad'", "column 5"],
    );
}

#[test]
fn a_match_is_a_mixture_that_can_be_loaded() {
    let place = Place::new();
    let matched = json(&place, &["colour", "match", "#8a5a3c"]);
    let rows = matched["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 10);
    let parts = |row: &Value| row["mixture"].as_str().expect("text").split(',').count();
    assert!(rows[..5].iter().all(|row| parts(row) == 2));
    assert!(rows[5..].iter().all(|row| parts(row) == 3));
    for row in [&rows[0], &rows[5]] {
        assert!(row["delta_e"].as_f64() < Some(2.0), "{row}");
        let mixture = row["mixture"].as_str().expect("text");
        let mixed = json(&place, &["colour", "mix", mixture, "--saunderson"]);
        assert_eq!(mixed["srgb"], row["srgb"]);
        let asked = [0x8a, 0x5a, 0x3c].map(|byte| f64::from(byte) / 255.0);
        for (got, asked) in numbers(&row["srgb"]).iter().zip(asked) {
            assert!((got - asked).abs() < 0.02, "{mixture}");
        }
    }
    // A mixture's own colour finds it.
    let known = "Yellow Ochre=0.6,Ultramarine Blue=0.4";
    let lab = numbers(&json(&place, &["colour", "mix", known, "--saunderson"])["lab"]);
    let lab = format!("{},{},{}", lab[0], lab[1], lab[2]);
    let only = ["--paint", "yellow ochre", "--paint", "Ultramarine Blue"];
    let found = json(
        &place,
        &[&["colour", "match", "--lab", &lab][..], &only].concat(),
    );
    assert_eq!(found["rows"][0]["mixture"], known);
    assert!(found["rows"][0]["delta_e"].as_f64() < Some(0.1));
    let text = place.done(&["colour", "match", "8a5a3c"]).stdout;
    has(
        &String::from_utf8_lossy(&text),
        &["two paints", "three paints", "ΔE₀₀", "\""],
    );
    let far = place.done(&["colour", "match", "#00ff00"]).stderr;
    has(&String::from_utf8_lossy(&far), &["do not reach"]);
}

#[test]
fn bad_matches_are_refused() {
    let place = Place::new();
    let refused = |args: &[&str], words: &[&str]| {
        let mut all = vec!["colour", "match"];
        all.extend(args);
        has(&fault(&place, &all, 2), words);
    };
    refused(&[], &["HEX"]);
    refused(&["#8a5a3"], &["'#8a5a3'", "six", "--lab"]);
    refused(&["brown"], &["'brown'"]);
    refused(&["--lab", "44,17"], &["'44,17'", "L*"]);
    refused(&["--lab", "-1,0,0"], &["'-1,0,0'"]);
    refused(
        &["#8a5a3c", "--paint", "Colbat Blue"],
        &["'Cobalt Blue'", "--paint"],
    );
    refused(
        &["#8a5a3c", "--paint", "Cobalt Blue"],
        &["one paint", "two paints"],
    );
}

#[test]
fn paints_to_mix_are_listed_with_masstone_and_tint() {
    let place = Place::new();
    let listed = json(&place, &["colour", "paints"]);
    let paints = listed["paints"].as_array().expect("paints");
    assert_eq!(paints.len(), 28);
    let lightness = |colour: &Value| numbers(colour).iter().sum::<f64>();
    for paint in paints {
        let (masstone, tint) = (&paint["masstone_srgb"], &paint["tint_srgb"]);
        let white = paint["name"] == "Titanium White";
        assert!(lightness(tint) > lightness(masstone) || white, "{paint}");
    }
    std::fs::write(place.path("paints.csv"), own_paints()).expect("written");
    let text = place
        .done(&["colour", "paints", "--paints", "paints.csv"])
        .stdout;
    has(
        &String::from_utf8_lossy(&text),
        &["Chalk", "Slate", "Soot", "PX"],
    );
}
