//! A session of a rig that paints in a file: recorded, made a take, rendered, played again, to the same picture.

#[path = "../support/mod.rs"]
mod support;

use std::io::{BufRead as _, BufReader};
use std::process::Stdio;

use nix::sys::signal::Signal;
use serde_json::Value;
use support::replay::Replay;
use support::{Launcher, PATIENCE, Place, assert_same, fault, has, signal, wait_for};

/// Small cells would take long.
const CANVAS: [&str; 4] = ["--size", "320x256", "--cell-mm", "0.5"];

/// A recorder that has the painting already.
fn recorder(place: &Place, file: &str) -> Launcher {
    let recorder = Launcher::start(place.maulstick(&["recording", "record", "-o", file]));
    wait_for_painting(place, file, &recorder);
    recorder
}

/// Waits until a file has the painting.
fn wait_for_painting(place: &Place, file: &str, recorder: &Launcher) {
    let has_painting = || {
        let info = place.run(&["recording", "info", file, "--json"]).stdout;
        let info: Value = serde_json::from_slice(&info).ok()?;
        let files = info["files"].as_array()?;
        let is_painting = |name: &Value| name == "painting.maul";
        files.iter().any(is_painting).then_some(())
    };
    let found = wait_for(PATIENCE, has_painting);
    assert!(found.is_some(), "{}", recorder.said());
}

/// Plays a hand's samples after `start` as those of a live device.
fn stroke(place: &Place, device: &str, start: &str) {
    let device = ["--as", device, "--start", start];
    place.done(
        &[
            &["recording", "replay", "hand.mcap", "-t", "stylus/*/sample"],
            device.as_slice(),
        ]
        .concat(),
    );
}

/// Paints with two styluses and commands in between, until nothing is wet.
fn paint(place: &Place) {
    let stroke = |device| stroke(place, device, "3");
    place.done(&["load", "Ultramarine Blue=0.6,Titanium White=0.4"]);
    stroke("left");
    place.done(&["load", "Cadmium Red Light"]);
    stroke("right");
    place.done(&["undo"]);
    place.done(&["brush", "clean"]);
    place.done(&["brush", "take", "flat"]);
    place.done(&["load", "Hansa Yellow Opaque"]);
    stroke("left");
    place.done(&["canvas", "light", "--direction=-0.4,0.5,0.8"]);
    place.done(&["layer", "dry"]);
}

/// The picture of the rig.
fn snapshot(place: &Place, file: &str) -> Vec<u8> {
    place.done(&["snapshot", "-o", file]);
    place.bytes(file)
}

/// Orders to a replay.
struct Orders {
    /// Rate at which it begins.
    rate: &'static str,
    /// Time at which it is paused, s.
    pause_s: f64,
    /// Earlier time that it goes back to, s.
    seek_s: f64,
}

/// Replays a session as `name` with orders, each once the one before has been carried out: paused, a step, back to where it is
/// painted anew, and on.
fn ordered(place: &Place, name: &str, orders: &Orders) {
    let (rate, pause_s) = (orders.rate, orders.pause_s);
    let options = ["--rate", rate, "--json", "--document", name];
    let replay = [&["recording", "replay", "t.mcap"], options.as_slice()].concat();
    let mut replay = Replay::start(place.maulstick(&replay));
    let mut paintings = 0;
    let mut until = |replay: &mut Replay, is_so: &dyn Fn(&Value) -> bool| {
        replay.until(|line| {
            paintings += u32::from(line["painting"] == name);
            is_so(line)
        });
    };
    let position = |line: &Value| line["position_s"].as_f64().unwrap_or(0.0);
    until(&mut replay, &|line| position(line) > pause_s);
    replay.order("pause");
    until(&mut replay, &|line| line["paused"] == true);
    replay.order("step");
    replay.order("skip 0.5");
    replay.order("pause");
    until(&mut replay, &|line| {
        line["paused"] == false && position(line) > pause_s + 1.0
    });
    replay.order(&format!("seek {}", orders.seek_s));
    until(&mut replay, &|line| line["painting"] == name);
    replay.order("rate 4");
    until(&mut replay, &|line| {
        line["rate"] == "4" && position(line) > orders.seek_s + 2.0
    });
    replay.order("rate max");
    replay.finish();
    assert_eq!(paintings, 2, "it was begun anew once");
}

/// Records how a rig paints, as `s.mcap`; the picture.
fn recorded(place: &Place) -> Vec<u8> {
    let blank = snapshot(place, "blank.png");
    let mut recorder = recorder(place, "s.mcap");
    let another = ["recording", "record", "-o", "s.mcap", "--seconds", "1"];
    has(
        &fault(place, &another, 1),
        &["another program records into it"],
    );
    paint(place);
    let painted = snapshot(place, "painted.png");
    assert_ne!(painted, blank);
    recorder.signal(Signal::SIGINT);
    recorder.wait(PATIENCE);
    painted
}

/// Makes the recording a take, `t.mcap`, of all that was done; its length, s.
fn take_from_recording(place: &Place) -> f64 {
    place.done(&["take", "from", "s.mcap", "-o", "t.mcap"]);
    let info = place.json(&["take", "info", "t.mcap", "--json"]);
    assert_eq!(info["painted"]["commands"].as_u64(), Some(8), "{info}");
    assert!(info["painted"]["states"].as_u64() > Some(100), "{info}");
    assert!(info["samples"]["left"].as_u64() > Some(100), "{info}");
    assert!(info["samples"]["right"].as_u64() > Some(100), "{info}");
    info["seconds"].as_f64().expect("a number")
}

/// Recording and take are rendered to the picture, on either backend.
fn check_rendered(place: &Place, painted: &[u8]) {
    for file in ["s.mcap", "t.mcap"] {
        place.done(&["render", file, "-o", "again.png", "--overwrite"]);
        assert_same(&place.bytes("again.png"), painted, file);
    }
    // What is decided of the backend is an entry of the journal.
    let gpu = ["render", "s.mcap", "--backend", "gpu", "-o", "gpu.png"];
    has(&place.text(&gpu), &["8 commands"]);
}

/// The second half is rendered to the picture, the first one is not.
fn check_halves(place: &Place, half_s: f64, painted: &[u8]) {
    let half = format!("{half_s:.2}");
    let from = ["take", "from", "s.mcap", "-o"];
    place.done(&[&from[..], &["half.mcap", "--start", &half]].concat());
    let render = ["render", "half.mcap", "-o", "half.png"];
    place.done(&[&render[..], &["--document", "half.maul"]].concat());
    assert_same(&place.bytes("half.png"), painted, "the second half");
    place.done(&[&from[..], &["less.mcap", "--end", &half]].concat());
    place.done(&["render", "less.mcap", "-o", "less.png"]);
    let less = place.bytes("less.png");
    assert_ne!(less, painted, "the first half is not all");
}

/// The take is replayed to the picture, with another brush in hand by now.
fn check_replayed(place: &Place, painted: &[u8]) {
    place.done(&["brush", "take", "filbert"]);
    place.done(&["recording", "replay", "t.mcap", "--rate", "max"]);
    assert_same(&snapshot(place, "max.png"), painted, "as fast as can be");
    let orders = Orders {
        rate: "1",
        pause_s: 2.0,
        seek_s: 0.5,
    };
    ordered(place, "r.maul", &orders);
    assert_same(&snapshot(place, "ordered.png"), painted, "with orders");
    let again = ["recording", "replay", "t.mcap", "--document", "r.maul"];
    has(&fault(place, &again, 1), &["never written over"]);
}

fn refuse_what_does_not_fit(place: &Place) {
    for (command, words) in [
        ("recording replay t.mcap --rate 0", &["rate"][..]),
        ("recording replay t.mcap --start 1e6", &["s long"]),
        (
            "recording replay t.mcap -t none/*",
            &["no topic none/*", "paint/journal"],
        ),
        ("recording replay s.mcap -t haptics/*/model", &["no topic"]),
        ("take from hand.mcap -o x.mcap", &["no journal"]),
        ("take from s.mcap -o x.mcap --start 9 --end 3", &["--start"]),
    ] {
        let args: Vec<&str> = command.split(' ').collect();
        has(&fault(place, &args, 2), words);
    }
    let loaded = ["render", "t.mcap", "-o", "x.png", "--load", "Bone Black"];
    has(&fault(place, &loaded, 2), &["leave out"]);
}

#[test]
fn a_session_is_painted_again_to_the_same_picture() {
    let place = Place::new();
    place.short_demo("hand.mcap", 6.0);
    let mut launcher = Launcher::up(&place, &[&["sea.maul"], CANVAS.as_slice()].concat());
    launcher.wait_says("is up");
    let painted = recorded(&place);
    let length_s = take_from_recording(&place);
    check_rendered(&place, &painted);
    check_halves(&place, length_s / 2.0, &painted);
    check_replayed(&place, &painted);
    refuse_what_does_not_fit(&place);
    launcher.close(&place);
}

#[test]
fn a_paint_node_that_dies_begins_another_file_and_each_is_painted_again() {
    let place = Place::new();
    place.short_demo("hand.mcap", 6.0);
    let mut launcher = Launcher::up(&place, &[&["sea.maul"], CANVAS.as_slice()].concat());
    launcher.wait_says("is up");
    let mut recorder = recorder(&place, "s.mcap");
    place.done(&["load", "Bone Black"]);
    stroke(&place, "left", "3");
    // While it levels each moment has a picture of its own, and its place in the journal says which.
    let levelling = place.json(&["snapshot", "-o", "levelling.png", "--json"]);
    stroke(&place, "left", "3");
    let paint = place.pid("maulstick-paint").expect("a paint node");
    signal(paint, Signal::SIGKILL);
    launcher.wait_says("'paint' failed and is started again");
    wait_for_painting(&place, "s-2.mcap", &recorder);
    place.done(&["load", "Cadmium Red Light"]);
    stroke(&place, "right", "3");
    place.done(&["layer", "dry"]);
    let painted = snapshot(&place, "painted.png");
    recorder.signal(Signal::SIGINT);
    recorder.wait(PATIENCE);

    let until = levelling["place"].to_string();
    place.done(&["render", "s.mcap", "-o", "then.png", "--until", &until]);
    let levelling = place.bytes("levelling.png");
    assert_same(&place.bytes("then.png"), &levelling, "while it levels");
    place.done(&["take", "from", "s.mcap", "-o", "first.mcap"]);
    place.done(&["render", "first.mcap", "-o", "first.png"]);
    assert_ne!(place.bytes("first.png"), levelling, "a stroke more");
    place.done(&["render", "s-2.mcap", "-o", "again.png"]);
    assert_same(&place.bytes("again.png"), &painted, "after the crash");
    let late = ["--start", "0.5", "-o", "late.mcap"];
    place.done(&[&["take", "from", "s-2.mcap"], late.as_slice()].concat());
    place.done(&["render", "late.mcap", "-o", "late.png"]);
    assert_same(&place.bytes("late.png"), &painted, "the end of it");
    let behind = ["take", "from", "s.mcap", "-o", "x.mcap", "--start", "1e6"];
    has(&fault(&place, &behind, 2), &["s-2.mcap"]);
    let elsewhere = ["render", "s-2.mcap", "-o", "x.png", "--until", "999999"];
    has(&fault(&place, &elsewhere, 2), &["999999"]);
    launcher.close(&place);
}

#[test]
fn a_painting_in_memory_only_is_recorded_without_it() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &CANVAS);
    launcher.wait_says("is up");
    let mut command = place.maulstick(&["recording", "record", "-o", "s.mcap"]);
    let mut recorder = command.stdout(Stdio::piped()).spawn().expect("started");
    let has_journal = || {
        place.done(&["load", "Bone Black"]);
        let info = place.run(&["recording", "info", "s.mcap"]).stdout;
        let info = String::from_utf8_lossy(&info).into_owned();
        info.contains("paint/journal").then_some(())
    };
    assert!(wait_for(PATIENCE, has_journal).is_some());
    let said = BufReader::new(recorder.stdout.take().expect("piped"));
    let mut lines = said.lines().map_while(Result::ok);
    let refused = "without the painting, a painting in memory only";
    assert!(lines.any(|line| line.contains(refused)), "it ended");
    signal(recorder.id(), Signal::SIGINT);
    recorder.wait().expect("ended");
    has(
        &fault(&place, &["take", "from", "s.mcap", "-o", "t.mcap"], 2),
        &["lacks the painting", "in a file"],
    );
    launcher.close(&place);
}

/// Five minutes of two styluses with four commands every half minute.
fn paint_long(place: &Place) {
    let rounds = ["Cadmium Red Light", "Hansa Yellow Opaque", "Bone Black"];
    for (round, paint) in rounds.iter().cycle().take(10).enumerate() {
        place.done(&["load", &format!("{paint}=0.7,Titanium White=0.3")]);
        stroke(place, ["left", "right"][round % 2], "0");
        if round % 3 == 2 {
            place.done(&["undo"]);
            place.done(&["painting", "redo"]);
        } else {
            place.done(&[
                "canvas",
                "light",
                &format!("--direction=-0.4,0.{},0.8", round % 9),
            ]);
            place.done(&["brush", "clean"]);
        }
        place.done(&["layer", "dry"]);
    }
}

#[test]
#[ignore = "takes half an hour"]
fn five_minutes_with_forty_commands_are_painted_again_ten_times_out_of_ten() {
    let place = Place::new();
    place.short_demo("hand.mcap", 30.0);
    let mut launcher = Launcher::up(&place, &[&["sea.maul"], CANVAS.as_slice()].concat());
    launcher.wait_says("is up");
    let mut recorder = recorder(&place, "s.mcap");
    paint_long(&place);
    let painted = snapshot(&place, "painted.png");
    recorder.signal(Signal::SIGINT);
    recorder.wait(PATIENCE);
    place.done(&["take", "from", "s.mcap", "-o", "t.mcap"]);
    let info = place.json(&["take", "info", "t.mcap", "--json"]);
    assert_eq!(info["painted"]["commands"].as_u64(), Some(40), "{info}");
    place.done(&["render", "t.mcap", "-o", "rendered.png"]);
    assert_same(&place.bytes("rendered.png"), &painted, "rendered");
    for rate in ["0.5", "1", "4", "max"] {
        place.done(&["recording", "replay", "t.mcap", "--rate", rate]);
        assert_same(&snapshot(&place, &format!("{rate}.png")), &painted, rate);
    }
    for round in 0..6_u8 {
        let orders = Orders {
            rate: ["4", "10"][usize::from(round % 2)],
            pause_s: 30.0 + 17.0 * f64::from(round),
            seek_s: 11.0 * f64::from(round),
        };
        ordered(&place, &format!("r{round}.maul"), &orders);
        let name = format!("ordered{round}.png");
        assert_same(&snapshot(&place, &name), &painted, &name);
    }
    launcher.close(&place);
}
