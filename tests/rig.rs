//! Rigs of real processes.

mod support;

use std::time::{Duration, Instant};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Class, Queue, Wake};
use maulstick_types::stylus::StylusSample;
use nix::sys::signal::Signal;
use support::display::Display;
use support::{Launcher, PATIENCE, Place, assert_same, signal, wait_for};

const LOADS: [&str; 4] = [
    "--load",
    "Ultramarine Blue",
    "--load",
    "Pyrrole Red=0.6,Titanium White=0.4",
];

/// Renders `take` as `offline.png`.
fn render(place: &Place, take: &str) {
    let mut args = vec!["render", take, "-o", "offline.png"];
    args.extend(LOADS);
    place.done(&args);
}

/// A rig that plays `take` and writes `live.png`.
fn play(place: &Place, take: &str, extra: &[&str]) -> Launcher {
    let mut args = vec![
        "up",
        "--play",
        take,
        "--snapshot",
        "live.png",
        "--ledger",
        "live.json",
    ];
    args.extend(LOADS);
    args.extend(extra);
    Launcher::start(place.maulstick(&args))
}

/// Waits for a rig that plays, and compares its picture with the rendered one.
fn finish(place: &Place, launcher: &mut Launcher, what: &str) {
    let status = launcher.wait(PATIENCE);
    assert_eq!(status.code(), Some(0), "{what}: {}", launcher.said());
    assert_same(&place.bytes("live.png"), &place.bytes("offline.png"), what);
    let ledger: serde_json::Value =
        serde_json::from_slice(&place.bytes("live.json")).expect("JSON");
    assert_eq!(ledger["quanta_missing"], 0, "{what}");
    place.wait_empty(Duration::from_secs(2));
}

#[test]
fn playing_paints_what_rendering_paints_at_every_rate() {
    let place = Place::new();
    place.short_demo("take.mcap", 4.0);
    render(&place, "take.mcap");
    for rate in ["0.5", "1", "4", "max"] {
        let mut launcher = play(&place, "take.mcap", &["--headless", "--rate", rate]);
        finish(&place, &mut launcher, &format!("rate {rate}"));
    }
}

#[test]
fn a_stopped_window_holds_nothing_up() {
    let display = Display::start();
    let place = Place::new();
    place.short_demo("take.mcap", 4.0);
    render(&place, "take.mcap");
    let mut args = vec![
        "up",
        "--play",
        "take.mcap",
        "--snapshot",
        "live.png",
        "--ledger",
        "live.json",
    ];
    args.extend(LOADS);
    let mut command = place.maulstick(&args);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    signal(
        place.pid("maulstick-ui").expect("a window"),
        Signal::SIGSTOP,
    );
    finish(&place, &mut launcher, "the window stopped");
}

#[test]
fn a_node_that_runs_by_fits_and_starts_changes_nothing() {
    let place = Place::new();
    place.short_demo("take.mcap", 3.0);
    render(&place, "take.mcap");
    for program in ["maulstick-paint", "maulstick-brush", "maulstick-player"] {
        let mut launcher = play(&place, "take.mcap", &["--headless", "--rate", "4"]);
        launcher.wait_says("is up");
        let pid = wait_for(PATIENCE, || place.pid(program)).expect("the node");
        for _ in 0..5 {
            let stopped = Instant::now();
            if place.pid(program) != Some(pid) {
                break;
            }
            signal(pid, Signal::SIGSTOP);
            wait_for(Duration::from_millis(120), || None::<()>);
            assert!(stopped.elapsed() >= Duration::from_millis(100));
            signal(pid, Signal::SIGCONT);
            wait_for(Duration::from_millis(60), || None::<()>);
        }
        finish(&place, &mut launcher, program);
    }
}

#[test]
fn a_take_is_played_again_when_a_node_is_killed_in_mid_stroke() {
    let place = Place::new();
    place.short_demo("take.mcap", 5.0);
    render(&place, "take.mcap");
    for program in ["maulstick-paint", "maulstick-brush", "maulstick-player"] {
        let mut launcher = play(&place, "take.mcap", &["--headless", "--rate", "4"]);
        launcher.wait_says("is up");
        let player = wait_for(PATIENCE, || place.pid("maulstick-player")).expect("a player");
        // Half a second into a take at rate 4 it is in its first stroke.
        wait_for(Duration::from_millis(500), || None::<()>);
        let pid = place.pid(program).expect("the node");
        signal(pid, Signal::SIGKILL);
        launcher.wait_says("is started again");
        finish(&place, &mut launcher, program);
        assert_ne!(place.pid("maulstick-player"), Some(player));
    }
}

#[test]
fn a_node_that_does_not_stay_up_ends_the_rig_with_words() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    let mut last = None;
    for _ in 0..3 {
        let pid = wait_for(PATIENCE, || {
            place
                .pid("maulstick-paint")
                .filter(|pid| Some(*pid) != last)
        });
        let pid = pid.expect("a paint node");
        last = Some(pid);
        signal(pid, Signal::SIGKILL);
    }
    let status = launcher.wait(PATIENCE);
    assert_eq!(status.code(), Some(1));
    let said = launcher.said();
    assert!(
        said.contains("node 'paint' does not stay up") && said.contains("help:"),
        "{said}"
    );
    place.wait_empty(Duration::from_secs(2));
}

#[test]
fn signals_stop_everything_with_the_right_code() {
    let place = Place::new();
    for (which, code) in [(Signal::SIGINT, 130), (Signal::SIGTERM, 143)] {
        let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
        launcher.wait_says("is up");
        assert!(place.processes().len() >= 3);
        launcher.signal(which);
        assert_eq!(launcher.wait(PATIENCE).code(), Some(code));
        place.wait_empty(Duration::ZERO);
    }
}

#[test]
fn a_stopped_node_does_not_survive_the_rig() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    signal(
        place.pid("maulstick-paint").expect("a node"),
        Signal::SIGSTOP,
    );
    launcher.signal(Signal::SIGTERM);
    launcher.wait(PATIENCE);
    place.wait_empty(Duration::ZERO);
}

#[test]
fn nothing_survives_a_killed_launcher() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    signal(
        place.pid("maulstick-paint").expect("a node"),
        Signal::SIGSTOP,
    );
    launcher.signal(Signal::SIGKILL);
    launcher.wait(PATIENCE);
    place.wait_empty(PATIENCE);
    // Its name is free again.
    let mut again = Launcher::start(place.maulstick(&["up", "--headless"]));
    again.wait_says("is up");
}

#[test]
fn a_closed_window_ends_the_rig_with_success() {
    let display = Display::start();
    let place = Place::new();
    let mut command = place.maulstick(&["up"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let window = display.window("Maulstick");
    display.close(window);
    assert_eq!(
        launcher.wait(PATIENCE).code(),
        Some(0),
        "{}",
        launcher.said()
    );
    place.wait_empty(Duration::from_secs(2));
}

#[test]
fn a_rig_has_its_name_to_itself() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless", "--name", "one"]));
    launcher.wait_says("is up");
    let second = place.run(&["up", "--headless", "--name", "one"]);
    let said = String::from_utf8_lossy(&second.stderr).into_owned();
    assert_eq!(second.status.code(), Some(1), "{said}");
    assert!(
        said.contains("already running") && said.contains("pid"),
        "{said}"
    );
    let mut other = Launcher::start(place.maulstick(&["up", "--headless", "--name", "two"]));
    other.wait_says("is up");
}

#[test]
fn commands_reach_a_running_rig() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    place.done(&["load", "Cobalt Blue=0.5,Titanium White=0.5"]);
    let unknown = place.run(&["load", "Cobalt Bleu"]);
    assert_eq!(unknown.status.code(), Some(2));
    place.done(&["undo"]);
    place.done(&["redo"]);
    place.done(&["clean"]);
    place.done(&["snapshot", "-o", "p.png", "--ledger", "l.json"]);
    let ledger: serde_json::Value = serde_json::from_slice(&place.bytes("l.json")).expect("JSON");
    assert_eq!(ledger["quanta_missing"], 0);
    assert!(ledger["accounts_m3"]["cleaner"].as_f64() > Some(0.0));
    let refused = place.run(&["snapshot", "-o", "no/p.png"]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        refused.status.code() != Some(0) && said.contains("no/p.png"),
        "{said}"
    );
}

#[test]
fn a_mouse_stroke_in_the_window_is_painted_and_shown() {
    let display = Display::start();
    let place = Place::new();
    let mut command = place.maulstick(&["up", "--load", "Bone Black"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let window = display.window("Maulstick");
    // The canvas is light before anything is painted.
    let light = |pixel: [u8; 3]| pixel.iter().all(|channel| *channel > 180);
    let dark = |pixel: [u8; 3]| pixel.iter().all(|channel| *channel < 140);
    let shown = wait_for(PATIENCE, || {
        light(display.pixel(window, 550, 500)).then_some(())
    });
    assert!(shown.is_some(), "the canvas is not shown");
    display.drag(
        &(0..60)
            .map(|i| [350 + 7 * i, 400 + 4 * i])
            .collect::<Vec<_>>(),
    );
    let painted = wait_for(PATIENCE, || {
        (400..700)
            .any(|y| dark(display.pixel(window, 550, y)))
            .then_some(())
    });
    assert!(painted.is_some(), "the stroke is not shown");
    place.done(&["undo"]);
    let undone = wait_for(PATIENCE, || {
        (400..700)
            .all(|y| light(display.pixel(window, 550, y)))
            .then_some(())
    });
    assert!(undone.is_some(), "the undone stroke is still shown");
}

#[test]
fn a_simulated_hand_paints_and_feels_the_canvas() {
    let place = Place::new();
    place.done(&["demo", "-o", "demo.mcap"]);
    let config = String::from_utf8(place.done(&["up", "--print-config"]).stdout).expect("UTF-8");
    let config = config.replace("# hand = ", "hand = ");
    std::fs::write(place.path("rig.toml"), config).expect("written");
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless", "--rig", "rig.toml"]));
    launcher.wait_says("is up");
    let (bus, topics) = support::join(&place);
    let wake = Wake::new();
    let (topic, class) = (topics.sample("phantom"), Class::RealTime);
    let mut samples =
        Receiver::<StylusSample>::new(&bus, &topic, class, Queue::Ring(1024), &wake).expect("one");
    // The hand presses and the canvas presses back, upward and never above the limit.
    let felt = wait_for(PATIENCE, || {
        let force = samples.try_recv()?.message.force_n;
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        assert!(size <= 3.0 + 1e-9, "{size} N");
        (force[2] > 0.1).then_some(())
    });
    assert!(felt.is_some(), "no force: {}", launcher.said());
    let painted = wait_for(PATIENCE, || {
        (support::on_canvas(&place) > 0.0).then_some(())
    });
    assert!(painted.is_some(), "nothing painted");
    // Without its brush the force fades, and comes back with it.
    signal(
        place.pid("maulstick-brush").expect("a brush"),
        Signal::SIGKILL,
    );
    let faded = wait_for(PATIENCE, || {
        let sample = samples.try_recv()?.message;
        (sample.in_range && sample.force_n == [0.0; 3]).then_some(())
    });
    assert!(faded.is_some(), "the force is held");
    bus.close();
}
