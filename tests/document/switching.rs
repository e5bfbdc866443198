//! Another painting, another file and exports in a running rig.

#[path = "../support/mod.rs"]
mod support;

use std::process::Stdio;

use maulstick_bus::Qos;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::Scene;
use nix::sys::signal::Signal;
use support::{
    COARSE, Launcher, PATIENCE, Place, account, assert_same, fault, has, hear, info, join, listen,
    signal, wait_for,
};

/// Cells of the canvas.
fn cells(place: &Place) -> [u32; 2] {
    let (bus, topics) = join(place);
    let mut scenes = listen::<Scene>(&bus, &topics.scene(), Qos::Cached);
    let cells = hear(&mut scenes, |_| true).expect("a scene").surfaces[0].cells;
    bus.close();
    cells
}

fn status(place: &Place, wanted: impl FnMut(&PaintStatus) -> bool) -> PaintStatus {
    let (bus, topics) = join(place);
    let mut heard = listen::<PaintStatus>(&bus, &topics.paint_status(), Qos::Background);
    let status = hear(&mut heard, wanted).expect("a status");
    bus.close();
    status
}

/// Processes of paint and brush.
fn nodes(place: &Place) -> [Option<u32>; 2] {
    ["maulstick-paint", "maulstick-brush"].map(|name| place.pid(name))
}

/// Begins another painting in the running rig, with the same brush, and paints on it.
fn paint_another(place: &Place) {
    let begun = nodes(place);
    let new = ["painting", "new", "b.maul", "--cm", "4x3"];
    place.done(&[&new[..], &["--tooth", "cotton"]].concat());
    assert_eq!(cells(place), [160, 120]);
    let there = nodes(place);
    assert!(there[0] != begun[0], "another paint node");
    assert_eq!(there[1], begun[1], "the same brush");
    assert_eq!(account(place, "canvas"), 0.0);
    let carries = || (account(place, "brush") > 0.0).then_some(());
    assert!(wait_for(PATIENCE, carries).is_some());
    place.done(&["canvas", "fill", "Pyrrole Red", "--um", "40"]);
    let told = status(place, |told| told.all_committed);
    assert!(told.path.ends_with("/b.maul") && !told.blank, "{told:?}");
    assert!(
        !told.backend.is_empty() && told.committed_ns > 0,
        "{told:?}"
    );
}

/// Opens the first painting again, of which `yellow` was painted before the newest step.
fn open_the_first_again(place: &Place, yellow: f64) {
    place.done(&["painting", "open", "a.maul"]);
    assert_eq!(cells(place), [256, 256]);
    assert!(account(place, "canvas") > yellow, "the black is there too");
    let opened = nodes(place);
    place.done(&["painting", "open", "./a.maul"]);
    assert_eq!(nodes(place), opened, "it is open already");
    place.done(&["undo"]);
    assert_eq!(account(place, "canvas"), yellow, "its history is there");
}

/// What cannot be opened, begun or saved to, and what is said of it.
const REFUSED: [(&[&str], &[&str]); 15] = [
    (&["open", "none.maul"], &["no such file", "none.maul"]),
    (
        &["open", "list.maul"],
        &["not a Maulstick painting", "list.maul"],
    ),
    (&["open", "newer.maul"], &["format 99", "newer"]),
    (&["open", "torn.maul"], &["damaged", "recover"]),
    (&["open", "."], &["not a Maulstick painting"]),
    (&["new", "b.maul"], &["already", "b.maul"]),
    (&["new", "list.maul"], &["already", "another name"]),
    (&["new", "no/c.maul"], &["no/c.maul"]),
    (&["new", "c.maul", "--cm", "0x10"], &["0×10 cm", "choose"]),
    (
        &["new", "c.maul", "--cm", "1000000x10"],
        &["choose", "1638 cm"],
    ),
    (&["new", "c.maul", "--tooth", "silk"], &["silk"]),
    (&["new", "c.maul", "--ground", "none.csv"], &["none.csv"]),
    (&["save-as", "b.maul"], &["already", "--replace"]),
    (
        &["save-as", "list.maul", "--replace"],
        &["not a Maulstick painting"],
    ),
    (&["save-as", "no/c.maul"], &["folder"]),
];

/// All that is refused leaves the painting and the files as they are.
fn refuse_other_files(place: &Place) {
    let before = (nodes(place), account(place, "canvas"));
    let closed = place.bytes("b.maul");
    let mut newer = closed.clone();
    newer[63] = 99;
    place.write("newer.maul", &newer);
    place.write("torn.maul", &closed[..closed.len() / 2]);
    let list = "a shopping list, and much more than sixteen bytes of it";
    place.write("list.maul", list);
    for (args, words) in REFUSED {
        has(&fault(place, &[&["painting"], args].concat(), 2), words);
    }
    assert!(!place.path("c.maul").exists());
    let after = (nodes(place), account(place, "canvas"));
    assert_eq!(after, before, "nothing was started again");
    assert_same(&place.bytes("newer.maul"), &newer, "a newer painting");
    assert_same(&place.bytes("b.maul"), &closed, "the other painting");
}

/// A painting that another rig has open is refused.
fn refuse_what_is_open_elsewhere(place: &Place) {
    let before = nodes(place);
    let other = Launcher::up(place, &["--name", "other", "b.maul"]);
    has(
        &fault(place, &["painting", "open", "b.maul"], 2),
        &["open in another program", "b.maul"],
    );
    drop(other);
    assert_eq!(nodes(place), before, "nothing was started again");
}

#[test]
fn a_rig_goes_from_painting_to_painting_and_nothing_is_lost() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["a.maul", "--size", "256x256"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    let yellow = account(&place, "canvas");
    // What is filled just now is not committed yet.
    place.done(&["canvas", "fill", "Bone Black", "--um", "20"]);
    paint_another(&place);
    open_the_first_again(&place, yellow);
    refuse_other_files(&place);
    refuse_what_is_open_elsewhere(&place);
    launcher.close(&place);
    for file in ["a.maul", "b.maul"] {
        assert_eq!(info(&place, file)["ledger"]["quanta_missing"], 0);
    }
    assert_eq!(info(&place, "a.maul")["redo"], 1);
}

#[test]
fn what_is_in_memory_alone_is_not_forgotten_unasked_and_becomes_a_file() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["--size", "256x256"]);
    status(&place, |told| told.path.is_empty());
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    place.done(&["painting", "versions", "--keep", "first"]);
    place.done(&["canvas", "fill", "Bone Black", "--um", "20"]);
    status(&place, |told| !told.blank);
    for args in [&["painting", "new", "b.maul"][..], &["painting", "new"]] {
        has(
            &fault(&place, args, 2),
            &["in memory alone", "save-as", "--forget"],
        );
    }
    assert!(!place.path("b.maul").exists());
    let held = account(&place, "canvas");
    let pid = place.pid("maulstick-paint");
    place.done(&["painting", "save-as", "a.maul"]);
    assert_eq!(
        place.pid("maulstick-paint"),
        pid,
        "it is painted on all the time"
    );
    // It is the rig's painting from now on, whoever dies.
    signal(pid.expect("a paint node"), Signal::SIGKILL);
    let again = wait_for(PATIENCE, || {
        place
            .pid("maulstick-paint")
            .filter(|anew| Some(*anew) != pid)
    });
    assert!(again.is_some(), "{}", launcher.said());
    assert_eq!(account(&place, "canvas"), held);
    place.done(&["undo"]);
    place.done(&["painting", "new"]);
    assert_eq!(account(&place, "canvas"), 0.0);
    place.done(&["canvas", "fill", "Pyrrole Red", "--um", "40"]);
    place.done(&["painting", "new", "--cm", "5x5", "--forget"]);
    assert_eq!(cells(&place), [200, 200]);
    launcher.close(&place);
    let there = info(&place, "a.maul");
    assert_eq!(
        (&there["redo"], &there["versions"][0]),
        (&1.into(), &"first".into())
    );
}

#[test]
fn a_take_that_is_played_meanwhile_paints_the_same_in_the_other_file() {
    let place = Place::new();
    place.short_demo("take.mcap", 8.0);
    let load = ["--load", "Cobalt Blue", COARSE[0], COARSE[1]];
    place.done(&[&["render", "take.mcap", "-o", "whole.png"], &load[..]].concat());
    let play = [
        "up",
        "--headless",
        "a.maul",
        "--play",
        "take.mcap",
        "--rate",
        "1",
        "--snapshot",
        "p.png",
    ];
    let mut launcher = Launcher::start(place.maulstick(&[&play, &load[..]].concat()));
    launcher.wait_says("is up");
    let begun = status(&place, |told| told.steps > 30);
    assert!(begun.take, "{begun:?}");
    for args in [
        &["painting", "open", "b.maul"][..],
        &["painting", "new", "b.maul"],
    ] {
        has(&fault(&place, args, 2), &["take is being played"]);
    }
    place.done(&["painting", "export", "-o", "half.png"]);
    place.done(&["painting", "save-as", "b.maul"]);
    let then = status(&place, |_| true);
    assert!(then.take && then.path.ends_with("/b.maul"), "{then:?}");
    assert!(launcher.wait(PATIENCE).success(), "{}", launcher.said());
    assert_same(
        &place.bytes("whole.png"),
        &place.bytes("p.png"),
        "all of it",
    );
    place.wait_empty(PATIENCE);
    place.done(&["painting", "export", "b.maul", "-o", "b.png"]);
    assert_same(
        &place.bytes("whole.png"),
        &place.bytes("b.png"),
        "the other file",
    );
    let [first, second] = ["a.maul", "b.maul"].map(|file| info(&place, file));
    assert_eq!(first["ledger"]["quanta_missing"], 0);
    assert!(first["journal"].as_u64() < second["journal"].as_u64());
    assert_ne!(
        place.bytes("half.png"),
        place.bytes("whole.png"),
        "a fault would pass"
    );
}

#[test]
fn exports_of_a_running_rig_are_those_of_its_file() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["a.maul", "--size", "320x256"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    place.done(&["layer", "dry", "--layer", "first"]);
    place.done(&["canvas", "fill", "Bone Black", "--um", "5"]);
    let formats: [(&str, &[&str]); 7] = [
        ("x.png", &[]),
        ("deep.png", &["--bits", "16"]),
        ("x.exr", &[]),
        ("x.ora", &[]),
        ("height.png", &["--format", "height"]),
        ("gloss.png", &["--format", "gloss"]),
        ("x.stl", &["--step", "2", "--base-mm", "3"]),
    ];
    for (name, more) in formats {
        place.done(&[&["painting", "export", "-o", name], more].concat());
    }
    has(
        &fault(&place, &["painting", "export", "-o", "x.jpg"], 2),
        &["'jpg'", ".png, .exr, .ora, .stl or .glb"],
    );
    has(
        &fault(
            &place,
            &["painting", "export", "-o", "a.maul", "--format", "png"],
            2,
        ),
        &["the painting"],
    );
    has(
        &fault(&place, &["painting", "export", "--stop"], 2),
        &["nothing is being exported"],
    );
    launcher.close(&place);
    for (name, more) in formats {
        let other = format!("file-{name}");
        place.done(&[&["painting", "export", "a.maul", "-o", &other], more].concat());
        assert_same(&place.bytes(&other), &place.bytes(name), name);
    }
}

#[test]
fn a_paint_node_that_is_killed_as_it_opens_gives_the_painting_before_back() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["b.maul", "--size", "128x128"]);
    launcher.close(&place);
    let launcher = Launcher::up(&place, &["a.maul", "--size", "256x256"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    let held = account(&place, "canvas");
    let other = place.bytes("b.maul");
    let pid = place.pid("maulstick-paint");
    // Paint is not ready before it knows its brushes.
    let brush = place.pid("maulstick-brush").expect("a brush node");
    signal(brush, Signal::SIGSTOP);
    let opening = place
        .maulstick(&["painting", "open", "b.maul"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    let anew = wait_for(PATIENCE, || {
        place
            .pid("maulstick-paint")
            .filter(|anew| Some(*anew) != pid)
    });
    signal(anew.expect("another paint node"), Signal::SIGKILL);
    signal(brush, Signal::SIGCONT);
    let output = opening.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    has(&said, &["b.maul could not be opened", "open again"]);
    assert_eq!(account(&place, "canvas"), held);
    assert!(status(&place, |_| true).path.ends_with("/a.maul"));
    assert_eq!(other.len(), place.bytes("b.maul").len());
    assert!(!launcher.said().contains("failed"), "{}", launcher.said());
    place.done(&["painting", "open", "b.maul"]);
    assert_eq!(cells(&place), [128, 128]);
    launcher.close(&place);
    assert_eq!(info(&place, "a.maul")["ledger"]["quanta_missing"], 0);
}

#[test]
fn a_paint_node_that_ends_as_it_saves_has_no_blank_painting_saved() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &["a.maul", "--size", "128x128"]);
    place.done(&["canvas", "fill", "Yellow Ochre", "--um", "40"]);
    launcher.close(&place);
    let kept = place.bytes("a.maul");
    let mut launcher = Launcher::up(&place, &["--size", "256x256"]);
    place.done(&["canvas", "fill", "Bone Black", "--um", "40"]);
    let pid = place.pid("maulstick-paint").expect("a paint node");
    signal(pid, Signal::SIGSTOP);
    let saving = place
        .maulstick(&["painting", "save-as", "a.maul", "--replace"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    launcher.wait_says("saving in");
    signal(pid, Signal::SIGKILL);
    let output = saving.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    has(&said, &["paint node ended", "a.maul"]);
    assert_eq!(account(&place, "canvas"), 0.0, "another one is begun");
    assert_same(&place.bytes("a.maul"), &kept, "the painting that is there");
    place.done(&["painting", "save-as", "b.maul"]);
    launcher.close(&place);
    assert_same(&place.bytes("a.maul"), &kept, "the painting that is there");
}
