//! Light and dry layers of a running rig.

#[path = "../support/mod.rs"]
mod support;

use std::path::Path;

use maulstick_bus::Qos;
use maulstick_bus::typed::Receiver;
use maulstick_device::{Take, TakeSample};
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use support::{Launcher, Place, assert_same, hear, listen};

/// A take of a hand that draws one stroke, lifts the brush and rests.
fn one_stroke(path: &Path) {
    let samples = (0..300u64).map(|number| TakeSample {
        time_ns: number * 10_000_000,
        sample: match number {
            0..100 => StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    point_m: [4e-4 * number as f64 - 0.02, 0.0, 0.0],
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: 0.0,
                    pressure: 1.0,
                },
                in_range: true,
                ..StylusSample::away()
            },
            _ => StylusSample::away(),
        },
    });
    let take = Take {
        setup: None,
        device: "hand".into(),
        samples: samples.collect(),
    };
    take.write(path).expect("written");
}

/// A rig in which a hand has painted a stroke and rests.
fn painted(place: &Place) -> Launcher {
    one_stroke(&place.path("stroke.mcap"));
    place.write_settings(&[("# hand = \"demo.mcap\"", "hand = \"stroke.mcap\"")]);
    let mut launcher = Launcher::up(place, &["--rig", "rig.toml"]);
    launcher.wait_says("is up");
    // It is done when paint lies there and no more comes.
    let mut before = 0.0;
    let rests = support::wait_for(support::PATIENCE, || {
        let now = support::on_canvas(place);
        let same = now > 0.0 && now == before;
        before = now;
        same.then_some(())
    });
    assert!(rests.is_some(), "nothing painted: {}", launcher.said());
    launcher
}

/// The picture of the rig.
fn picture(place: &Place, name: &str) -> Vec<u8> {
    place.done(&["snapshot", "-o", name]);
    place.bytes(name)
}

/// Dries the stroke as a layer, with all of its paint.
fn dry_as_sky(place: &Place, scenes: &mut Receiver<Scene>) {
    place.done(&["layer", "dry", "--layer", "sky"]);
    let dried = hear(scenes, |scene| !scene.layers.is_empty()).expect("a layer");
    let layer = &dried.layers[0];
    assert_eq!((layer.name.as_str(), layer.number), ("sky", 1));
    assert!(support::account(place, "dry") > 0.0);
}

/// Lights the painting with a lamp, without adaptation.
fn light_by_a_lamp(place: &Place) {
    let lamp = ["canvas", "light", "--illuminant", "A", "--adapt", "false"];
    let told = place.json(&[&lamp[..], &["--json"]].concat());
    assert_eq!(
        (told["illuminant"].as_str(), told["adapted"].as_bool()),
        (Some("A"), Some(false))
    );
    // Under another spectrum the exposure is chosen anew, as for a painting that begins under it.
    assert!(told["exposure"].as_f64() < Some(0.8), "{told}");
}

fn expose_by_hand(place: &Place) {
    let told = place.json(&["canvas", "light", "--exposure", "0.5", "--json"]);
    assert_eq!(told["exposure"].as_f64(), Some(0.5));
}

/// Writes a picture that is brighter from pixel to pixel.
fn grey_ramp(place: &Place, name: &str, [width, height]: [u32; 2]) {
    let file = std::fs::File::create(place.path(name)).expect("a file");
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    let row = (0..width).map(|x| (4 * x) as u8);
    let pixels: Vec<u8> = (0..height).flat_map(|_| row.clone()).collect();
    let written = encoder
        .write_header()
        .and_then(|mut to| to.write_image_data(&pixels));
    written.expect("written");
}

/// Surroundings by name and from a picture change what the gloss shows.
fn mirror_surroundings(place: &Place, day: &[u8]) {
    grey_ramp(place, "hall.png", [64, 32]);
    let mut before = day.to_vec();
    for (name, known) in [("room", "room"), ("hall.png", "hall")] {
        let told = place.json(&["canvas", "light", "--environment", name, "--json"]);
        assert_eq!(told["environment"].as_str(), Some(known));
        let after = picture(place, "around.png");
        assert!(before != after, "{name}");
        before = after;
    }
    place.done(&["canvas", "light", "--environment", "even"]);
}

#[test]
fn a_painting_dries_and_is_seen_under_another_light() {
    let place = Place::new();
    let launcher = painted(&place);
    let (bus, topics) = support::join(&place);
    let mut scenes = listen::<Scene>(&bus, &topics.scene(), Qos::Cached);
    let mut statuses = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    dry_as_sky(&place, &mut scenes);
    let day = picture(&place, "day.png");

    light_by_a_lamp(&place);
    let baked = hear(&mut statuses, |status| {
        status.baking > 0 && status.baked == status.baking
    });
    assert!(baked.is_some(), "no tile is baked: {}", launcher.said());
    assert!(day != picture(&place, "lamp.png"));
    expose_by_hand(&place);
    place.done(&["canvas", "light", "--illuminant", "D65", "--adapt", "true"]);
    mirror_surroundings(&place, &day);
    let again = picture(&place, "again.png");
    assert_same(&day, &again, "back under daylight");

    place.done(&["layer", "opacity", "1", "0.2"]);
    assert!(day != picture(&place, "glaze.png"));
    place.done(&["undo"]);
    assert_same(&day, &picture(&place, "opaque.png"), "opaque again");
    place.done(&["undo"]);
    assert_eq!(support::account(&place, "dry"), 0.0);
    assert!(support::on_canvas(&place) > 0.0, "wet again");
    bus.close();
}

fn refused(place: &Place, args: &[&str], words: &[&str]) {
    let output = place.run(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{args:?}: no '{word}' in: {said}");
    }
}

fn refuse_surroundings(place: &Place) {
    grey_ramp(place, "narrow.png", [40, 30]);
    for (name, words) in [
        ("rom", ["'rom'", "'room'"]),
        ("bad.csv", ["bad.csv", "PNG"]),
        ("narrow.png", ["narrow.png", "40×30"]),
    ] {
        refused(place, &["canvas", "light", "--environment", name], &words);
    }
}

#[test]
fn what_a_rig_cannot_do_with_light_it_refuses_with_words() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let refused = |args: &[&str], words: &[&str]| refused(&place, args, words);
    place.write("bad.csv", "nm,power\n380,1\n400,-3\n");
    refused(
        &["canvas", "light", "--illuminant", "D56"],
        &["'D56'", "did you mean 'D5"],
    );
    refused(
        &["canvas", "light", "--illuminant", "bad.csv"],
        &["bad.csv:3", "column 2", "-3"],
    );
    refused(
        &["canvas", "light", "--illuminant", "none.csv"],
        &["none.csv", "check the path"],
    );
    refuse_surroundings(&place);
    refused(&["canvas", "light", "--samples", "3"], &["4 to 16"]);
    refused(
        &["canvas", "light", "--rule", "simpson"],
        &["gauss, fitted, reference"],
    );
    refused(
        &["canvas", "light", "--exposure", "bright"],
        &["a number, or auto"],
    );
    refused(
        &["canvas", "light", "--intensity", "-1"],
        &["intensity", "-1"],
    );
    refused(&["canvas", "light", "--direction", "0,0,-1"], &["z > 0"]);
    refused(
        &["canvas", "light", "--direction", "1,2"],
        &["three numbers"],
    );
    refused(&["layer", "dry"], &["nothing is wet"]);
    refused(&["layer", "dry", "--share", "0"], &["share"]);
    refused(
        &["layer", "opacity", "3", "0.5"],
        &["no dry layer 3", "maulstick layer dry"],
    );
    refused(&["layer", "opacity", "3", "1.5"], &["1.5", "0 to 1"]);
    refused(&["load", "Colbat Blue"], &["did you mean 'Cobalt Blue'"]);
    place.write("mine.csv", "nm,power\n380,1\n780,2\n");
    let told = place.text(&["canvas", "light", "--illuminant", "mine.csv"]);
    assert_eq!(told.split(' ').next(), Some("mine"), "{told}");
    drop(launcher);
}
