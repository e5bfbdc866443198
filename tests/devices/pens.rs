//! A pen in a rig of real processes, played from a recording, for no machine of a test has a tablet.

#[path = "../support/mod.rs"]
mod support;

use std::path::Path;
use std::process::{Command, Stdio};

use maulstick_bus::Qos;
use maulstick_types::stylus::{StylusSample, StylusStatus, switch};
use nix::sys::signal::Signal;
use support::{Launcher, PATIENCE, Place, hear, join, listen, on_canvas, signal, wait_for};

/// A rig whose only device is a tablet that is not there.
fn rig(place: &Place) -> Launcher {
    let config = "[[device]]\nname = \"tablet\"\ndriver = \"pen\"\nbrush = \"main\"\n\
                  address = \"0001:0001\"\n\n[[brush]]\nname = \"main\"\nkind = \"round\"\n";
    std::fs::write(place.path("rig.toml"), config).expect("written");
    Launcher::up(place, &["--rig", "rig.toml"])
}

#[test]
fn a_recorded_pen_paints_and_is_recorded_as_it_was() {
    let place = Place::new();
    let launcher = rig(&place);
    let (bus, topics) = join(&place);
    let topic = topics.stylus_status("tablet");
    let mut status = listen::<StylusStatus>(&bus, &topic, Qos::Background);
    let trouble = hear(&mut status, |told| !told.trouble.is_empty())
        .expect("told")
        .trouble;
    assert!(trouble.contains("0001:0001"), "{trouble}");
    place.done(&["load", "Bone Black"]);
    let recording = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/pen.hid");
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("tablet"), Qos::RealTime);
    let pen = Command::new(support::MAULSTICK)
        .args(["node", "hid", "--folder"])
        .arg(place.path("maulstick/studio"))
        .args(["--node", "hand", "--device", "tablet"])
        .arg("--replay")
        .arg(&recording)
        .args(["--record", "again.hid"])
        .current_dir(place.path("."))
        .stderr(Stdio::null())
        .spawn();
    let mut pen = pen.expect("started");
    // It leaves twice, once to be turned round; samples may be lost, so they are not counted.
    let erases = hear(&mut samples, |sample| sample.switches & switch::ERASER != 0);
    let left = erases.and_then(|_| hear(&mut samples, |sample| !sample.in_range));
    assert!(left.is_some(), "{}", launcher.said());
    let painted = wait_for(PATIENCE, || (on_canvas(&place) > 0.0).then_some(()));
    assert!(painted.is_some(), "{}", launcher.said());
    // What is recorded is whole once the daemon was asked to end.
    signal(pen.id(), Signal::SIGTERM);
    pen.wait().expect("ended");
    let events = |text: &str| {
        let lines = text.lines().filter(|line| line.starts_with("E:"));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    let wanted = std::fs::read_to_string(&recording).expect("read");
    let again = String::from_utf8(place.bytes("again.hid")).expect("text");
    assert_eq!(events(&again), events(&wanted));
    bus.close();
}

#[test]
fn a_recorder_runs_beside_the_daemon_of_its_device() {
    let place = Place::new();
    let launcher = rig(&place);
    let (bus, topics) = join(&place);
    let topic = topics.sample("tablet-recorder");
    let mut samples = listen::<StylusSample>(&bus, &topic, Qos::RealTime);
    let recording = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/pen.hid");
    let mut recorder = Command::new(support::MAULSTICK)
        .args(["node", "hid", "--folder"])
        .arg(place.path("maulstick/studio"))
        .args(["--device", "tablet", "--record", "beside.hid", "--replay"])
        .arg(&recording)
        .current_dir(place.path("."))
        .stderr(Stdio::null())
        .spawn()
        .expect("started");
    let heard = hear(&mut samples, |sample| sample.in_range);
    assert!(heard.is_some(), "{}", launcher.said());
    signal(recorder.id(), Signal::SIGTERM);
    recorder.wait().expect("ended");
    let text = String::from_utf8(place.bytes("beside.hid")).expect("text");
    assert!(text.lines().any(|line| line.starts_with("E:")), "{text}");
    bus.close();
}
