//! The recorder of `[record]`, recordings that were damaged, and takes of what a painting was painted with.

#[path = "../support/mod.rs"]
mod support;

use std::os::unix::process::ExitStatusExt as _;
use std::path::PathBuf;
use std::process::Command;

use nix::sys::signal::Signal;
use serde_json::Value;
use support::{
    Launcher, MAULSTICK, PATIENCE, Place, assert_same, fault, has, printed, signal, wait_for,
};

/// Small cells would take long.
const CANVAS: [&str; 4] = ["--size", "320x256", "--cell-mm", "0.5"];

/// The recordings of the rig in a place, the oldest first.
fn recordings(place: &Place) -> Vec<PathBuf> {
    let files = std::fs::read_dir(place.path("kept"));
    let files = files.into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = files.map(|file| file.path()).collect();
    paths.sort_by_key(|path| path.metadata().and_then(|data| data.created()).ok());
    paths
}

/// What `recording info` says of a file, once it can be read.
fn info(place: &Place, file: &str) -> Option<Value> {
    let said = place.run(&["recording", "info", file, "--json"]).stdout;
    serde_json::from_slice(&said).ok()
}

/// Waits until a recording has the painting.
fn wait_for_painting(place: &Place, file: &str) {
    let has_painting = || {
        let info = info(place, file)?;
        let files = info["files"].as_array()?;
        files.contains(&"painting.maul".into()).then_some(())
    };
    assert!(wait_for(PATIENCE, has_painting).is_some(), "{file}");
}

/// A stroke of the hand that lies in the place.
fn stroke(place: &Place) {
    let topic = "stylus/*/sample";
    place.done(&[
        "recording",
        "replay",
        "hand.mcap",
        "-t",
        topic,
        "--as",
        "left",
        "--start",
        "3",
    ]);
}

fn snapshot(place: &Place, file: &str) -> Vec<u8> {
    place.done(&["snapshot", "-o", file]);
    place.bytes(file)
}

/// Settings of a rig that keeps recordings.
fn settings(place: &Place, more: &str) {
    let text = format!("[record]\nfolder = \"kept\"\n{more}\n");
    std::fs::write(place.path("rig.toml"), text).expect("written");
}

fn text(path: &std::path::Path) -> &str {
    path.to_str().expect("text")
}

#[test]
fn each_run_has_a_recording_whose_process_may_die_and_the_rig_paints_on() {
    let place = Place::new();
    place.short_demo("hand.mcap", 6.0);
    settings(&place, "quota_mb = 500");
    let up = [&["sea.maul", "--rig", "rig.toml"], CANVAS.as_slice()].concat();
    let mut launcher = Launcher::up(&place, &up);
    launcher.wait_says("recording into");
    let first = wait_for(PATIENCE, || recordings(&place).first().cloned()).expect("a file");
    let name = first.file_name().expect("a name").to_string_lossy();
    assert!(
        name.starts_with("studio 20") && name.ends_with(".mcap"),
        "{name}"
    );
    wait_for_painting(&place, text(&first));
    place.done(&["load", "Ultramarine Blue=0.6,Titanium White=0.4"]);
    stroke(&place);
    let recorder = place.pid("maulstick-recorder").expect("a recorder");
    signal(recorder, Signal::SIGKILL);
    launcher.wait_says("'recorder' failed and is started again");
    let second = wait_for(PATIENCE, || recordings(&place).get(1).cloned()).expect("another file");
    wait_for_painting(&place, text(&second));
    stroke(&place);
    place.done(&["layer", "dry"]);
    let painted = snapshot(&place, "painted.png");
    assert!(launcher.is_running());
    launcher.close(&place);

    // The one that was killed is read as it is, and mended.
    let killed = info(&place, text(&first)).expect("read");
    has(killed["damage"].as_str().expect("damage"), &["no index"]);
    let said = place.done(&["take", "recover", text(&first), "-o", "mended.mcap"]);
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    has(&said, &["mended.mcap", "2 files", "byte"]);
    let mended = info(&place, "mended.mcap").expect("read");
    assert_eq!(mended["damage"], Value::Null);
    assert_eq!(mended["streams"], killed["streams"]);
    place.done(&["render", "mended.mcap", "-o", "mended.png"]);
    place.done(&["render", text(&first), "-o", "killed.png"]);
    assert_same(
        &place.bytes("mended.png"),
        &place.bytes("killed.png"),
        "mended",
    );

    // The other one ended with the rig, and has its last stroke.
    let whole = info(&place, text(&second)).expect("read");
    assert_eq!(whole["damage"], Value::Null);
    assert_eq!(whole["notes"]["counts"]["dropped"], "0");
    place.done(&["render", text(&second), "-o", "again.png"]);
    assert_same(&place.bytes("again.png"), &painted, "the second file");

    let mut launcher = Launcher::up(&place, &["sea.maul", "--rig", "rig.toml"]);
    launcher.wait_says("recording into");
    let third = wait_for(PATIENCE, || recordings(&place).get(2).cloned());
    assert!(third.is_some(), "{}", launcher.said());
    launcher.wait_says("is up");
    assert_eq!(&recordings(&place)[..2], [first, second]);
    launcher.close(&place);
}

#[test]
fn a_recorder_that_cannot_write_ends_and_the_rig_goes_on() {
    let place = Place::new();
    settings(&place, "");
    let kept = place.path("kept");
    std::fs::write(&kept, "my diary").expect("written");
    let refused = fault(&place, &["up", "--headless", "--rig", "rig.toml"], 1);
    has(&refused, &["kept"]);
    std::fs::remove_file(&kept).expect("removed");
    let mut launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let running = wait_for(PATIENCE, || place.pid("maulstick-recorder")).expect("a recorder");
    std::fs::remove_dir_all(&kept).expect("removed");
    std::fs::write(&kept, "my diary").expect("written");
    signal(running, Signal::SIGKILL);
    launcher.wait_says("'recorder' failed and is not started again");
    has(&launcher.said(), &["kept"]);
    place.done(&["load", "Bone Black"]);
    assert_eq!(std::fs::read(&kept).expect("there"), b"my diary");
    launcher.close(&place);
}

#[test]
fn settings_of_the_recorder_are_refused_with_their_line() {
    let place = Place::new();
    for (more, words) in [
        ("quota_mb = 0", "quota_mb"),
        ("last = \"5\"", "5m"),
        ("minutes = 5", "unknown key 'minutes'"),
    ] {
        settings(&place, more);
        let refused = fault(&place, &["up", "--headless", "--rig", "rig.toml"], 2);
        has(&refused, &[words, "rig.toml:3"]);
    }
}

#[test]
fn a_take_of_what_a_painting_was_painted_with_is_painted_to_the_same_bytes() {
    let place = Place::new();
    place.short_demo("hand.mcap", 6.0);
    let up = [&["sea.maul"], CANVAS.as_slice()].concat();
    let launcher = Launcher::up(&place, &up);
    place.done(&["load", "Ultramarine Blue=0.6,Titanium White=0.4"]);
    stroke(&place);
    launcher.close(&place);
    let launcher = Launcher::up(&place, &["sea.maul"]);
    place.done(&["load", "Cadmium Red Light"]);
    stroke(&place);
    place.done(&["undo"]);
    stroke(&place);
    place.done(&["layer", "dry"]);
    let painted = snapshot(&place, "painted.png");
    has(
        &fault(&place, &["take", "from", "sea.maul", "-o", "t.mcap"], 1),
        &["sea.maul"],
    );
    launcher.close(&place);

    let before = place.bytes("sea.maul");
    place.done(&["take", "from", "sea.maul", "-o", "t.mcap"]);
    assert!(place.bytes("sea.maul") == before, "the painting stays");
    let take = place.done(&["take", "info", "t.mcap", "--json"]).stdout;
    let take: Value = serde_json::from_slice(&take).expect("JSON");
    assert!(take["painted"]["states"].as_u64() > Some(100), "{take}");
    place.done(&["render", "t.mcap", "-o", "again.png"]);
    assert_same(&place.bytes("again.png"), &painted, "all of it");
    let half = take["seconds"].as_f64().expect("a number") / 2.0;
    let half = format!("{half:.2}");
    let from = ["take", "from", "sea.maul", "-o"];
    place.done(&[&from[..], &["late.mcap", "--start", &half]].concat());
    place.done(&["render", "late.mcap", "-o", "late.png"]);
    assert_same(&place.bytes("late.png"), &painted, "the second half");
    place.done(&[&from[..], &["early.mcap", "--end", &half]].concat());
    place.done(&["render", "early.mcap", "-o", "early.png"]);
    assert_ne!(place.bytes("early.png"), painted, "the first half");

    let refused = fault(&place, &["take", "from", "sea.maul", "-o", "sea.maul"], 2);
    has(&refused, &["sea.maul"]);
    let late = [&from[..], &["x.mcap", "--start", "1e6"]].concat();
    has(&fault(&place, &late, 2), &["s long"]);
    place.done(&["painting", "pack", "sea.maul", "--forget-record"]);
    has(
        &fault(&place, &["take", "from", "sea.maul", "-o", "x.mcap"], 2),
        &["nothing was painted in it since its beginning"],
    );
}

/// Runs a command with so much memory, bytes; it may refuse, but neither panic nor be killed.
fn survives(place: &Place, memory: u64, args: &[&str]) {
    let mut command = Command::new("sh");
    command.current_dir(place.path(""));
    command
        .args([
            "-c",
            "ulimit -v $0; exec \"$@\"",
            &(memory >> 10).to_string(),
        ])
        .arg(MAULSTICK)
        .args(args);
    let output = command.output().expect("started");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("panicked"), "{args:?}: {said}");
    assert_eq!(output.status.signal(), None, "{args:?}: {said}");
    let code = output.status.code();
    assert!(matches!(code, Some(0..=2)), "{args:?}: {code:?}, {said}");
}

#[test]
fn no_byte_of_a_recording_makes_a_command_panic_or_ask_for_the_memory_that_it_states() {
    let place = Place::new();
    place.short_demo("hand.mcap", 6.0);
    let launcher = Launcher::up(&place, &[&["sea.maul"], CANVAS.as_slice()].concat());
    let mut recorder = Launcher::start(place.maulstick(&["recording", "record", "-o", "s.mcap"]));
    wait_for_painting(&place, "s.mcap");
    place.done(&["load", "Bone Black"]);
    stroke(&place);
    recorder.signal(Signal::SIGINT);
    recorder.wait(PATIENCE);
    launcher.close(&place);
    let whole = place.bytes("s.mcap");
    // What a whole one takes, with room for the threads of a process.
    let memory = 4 << 30;
    let commands: [&[&str]; 6] = [
        &["recording", "info", "m.mcap"],
        &[
            "recording",
            "export",
            "m.mcap",
            "-o",
            "m.csv",
            "--overwrite",
        ],
        &["take", "info", "m.mcap"],
        &["take", "from", "m.mcap", "-o", "x.mcap", "--overwrite"],
        &["take", "recover", "m.mcap", "-o", "y.mcap", "--overwrite"],
        &[
            "render",
            "m.mcap",
            "-o",
            "m.png",
            "--backend",
            "cpu",
            "--overwrite",
        ],
    ];
    let places = (0..24).map(|step| whole.len() * step / 24);
    let ends = (1..16).map(|step| whole.len() - 9 * step);
    for (round, at) in places.chain(ends).enumerate() {
        let mut bytes = whole.clone();
        match round % 3 {
            0 => bytes.truncate(at),
            1 => bytes[at..(at + 8).min(whole.len())].fill(0xff),
            _ => bytes[at] ^= 1 << (round % 8),
        }
        std::fs::write(place.path("m.mcap"), &bytes).expect("written");
        let command = commands[round % commands.len()];
        survives(&place, memory, command);
        survives(&place, memory, commands[4]);
    }
    let said = printed(
        &mut place.maulstick(&["take", "recover", "s.mcap", "-o", "y.mcap", "--overwrite"]),
        b"",
    );
    has(&said, &["nothing was damaged"]);
}
