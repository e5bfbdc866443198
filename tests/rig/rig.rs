//! Rigs of real processes.

#[path = "../support/mod.rs"]
mod support;

use std::process::Command;
use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus as _, Qos};
use maulstick_types::Message;
use maulstick_types::paint::PaintStatus;
use maulstick_types::stylus::{StylusSample, TakeStatus};
use nix::sys::signal::Signal;
use support::display::{Display, over};
use support::{
    COARSE, Launcher, PATIENCE, Place, account, assert_same, drain, hear, listen, pressed, signal,
    wait_for,
};

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
    args.extend(COARSE);
    place.done(&args);
}

/// The command of a rig that plays `take` and writes `live.png`.
fn playing(place: &Place, take: &str, extra: &[&str]) -> Command {
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
    args.extend(COARSE);
    args.extend(extra);
    place.maulstick(&args)
}

/// That rig without a window.
fn play(place: &Place, take: &str, rate: &str) -> Launcher {
    Launcher::start(playing(place, take, &["--headless", "--rate", rate]))
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
    place.short_demo("take.mcap", 3.0);
    render(&place, "take.mcap");
    // Others play at 1 and at 4.
    for rate in ["0.5", "max"] {
        let mut launcher = play(&place, "take.mcap", rate);
        finish(&place, &mut launcher, &format!("rate {rate}"));
    }
}

#[test]
fn a_stopped_window_holds_nothing_up() {
    let display = Display::start();
    let place = Place::new();
    place.short_demo("take.mcap", 4.0);
    render(&place, "take.mcap");
    let mut command = playing(&place, "take.mcap", &[]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    signal(
        place.pid("maulstick-ui").expect("a window"),
        Signal::SIGSTOP,
    );
    finish(&place, &mut launcher, "the window stopped");
}

/// True if messages come, by the times of sending, for so long, ns.
fn hears_for<M: Message>(heard: &mut Receiver<M>, length_ns: u64) -> bool {
    let mut first_ns = None;
    let passed = || {
        let sent_ns = heard.try_recv()?.header.sent_ns;
        (sent_ns >= *first_ns.get_or_insert(sent_ns) + length_ns).then_some(())
    };
    wait_for(PATIENCE, passed).is_some()
}

#[test]
fn a_node_that_runs_by_fits_and_starts_changes_nothing() {
    let place = Place::new();
    place.short_demo("take.mcap", 5.0);
    render(&place, "take.mcap");
    for program in ["maulstick-paint", "maulstick-brush", "maulstick-player"] {
        let mut launcher = play(&place, "take.mcap", "1");
        launcher.wait_says("is up");
        let (bus, topics) = support::join(&place);
        let class = Qos::Background;
        let mut take = listen::<TakeStatus>(&bus, &topics.take_status("player"), class);
        let mut paint = listen::<PaintStatus>(&bus, &topics.paint_status(), class);
        let pid = wait_for(PATIENCE, || place.pid(program)).expect("the node");
        let (mut stops, mut position_ns) = (0, 0);
        // Each time until the take goes on, and five times at most.
        while stops < 5 {
            let told = hear(&mut take, |told| told.position_ns > position_ns)
                .unwrap_or_else(|| panic!("{program}, {stops} stops: {}", launcher.said()));
            position_ns = told.position_ns;
            if position_ns + 1_000_000_000 > told.length_ns {
                break;
            }
            signal(pid, Signal::SIGSTOP);
            stops += 1;
            // The first time for as long as a loaded machine stands still. What is heard meanwhile comes twice a second, and
            // late on such a machine: together that is less than the 4.5 s after which a node is taken for frozen.
            let still_ns = if stops == 1 {
                2_000_000_000
            } else {
                300_000_000
            };
            drain(&mut take);
            drain(&mut paint);
            let alive = if program == "maulstick-paint" {
                hears_for(&mut take, still_ns)
            } else {
                hears_for(&mut paint, still_ns)
            };
            assert!(alive, "all stand still: {}", launcher.said());
            signal(pid, Signal::SIGCONT);
        }
        assert!(stops > 0, "{program} was never stopped");
        bus.close();
        finish(&place, &mut launcher, program);
    }
}

#[test]
fn a_take_is_played_again_when_a_node_ends_in_mid_stroke() {
    let place = Place::new();
    place.short_demo("take.mcap", 5.0);
    render(&place, "take.mcap");
    for (program, which) in [
        ("maulstick-paint", Signal::SIGKILL),
        ("maulstick-player", Signal::SIGKILL),
        ("maulstick-brush", Signal::SIGTERM),
        ("maulstick-player", Signal::SIGTERM),
    ] {
        let mut launcher = play(&place, "take.mcap", "4");
        launcher.wait_says("is up");
        let (bus, topics) = support::join(&place);
        let class = Qos::Background;
        let mut take = listen::<TakeStatus>(&bus, &topics.take_status("player"), class);
        // After half a second the take is in its first stroke.
        let told = hear(&mut take, |told| told.position_ns > 500_000_000).expect("a take");
        assert!(told.end.is_none(), "it is over already");
        let player = place.pid("maulstick-player").expect("a player");
        signal(place.pid(program).expect("the node"), which);
        launcher.wait_says("is started again");
        let anew = wait_for(PATIENCE, || {
            place.pid("maulstick-player").filter(|anew| *anew != player)
        });
        assert!(anew.is_some(), "no other player: {}", launcher.said());
        bus.close();
        finish(&place, &mut launcher, &format!("{program} {which}"));
    }
}

#[test]
fn a_stopped_paint_node_comes_back_with_loaded_brushes() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    let is_loaded = |launcher: &Launcher| {
        let carried = wait_for(PATIENCE, || (account(&place, "brush") > 0.0).then_some(()));
        assert!(carried.is_some(), "it is clean: {}", launcher.said());
    };
    is_loaded(&launcher);
    let pid = place.pid("maulstick-paint").expect("a paint node");
    signal(pid, Signal::SIGTERM);
    launcher.wait_says("is started again");
    let anew = wait_for(PATIENCE, || {
        place.pid("maulstick-paint").filter(|anew| *anew != pid)
    });
    assert!(anew.is_some(), "no paint node: {}", launcher.said());
    is_loaded(&launcher);
}

/// Kills a node as often as the rig starts it, and sees that the rig gives up with words.
fn kill_until_the_rig_gives_up(place: &Place, launcher: &mut Launcher, program: &str, node: &str) {
    let (mut last, mut killed) = (None, 0);
    // Three within ten seconds are too many: a machine that is slow takes some more.
    while launcher.is_running() && killed < 12 {
        let next = place.pid(program).filter(|pid| Some(*pid) != last);
        if let Some(pid) = next {
            signal(pid, Signal::SIGKILL);
            (last, killed) = (next, killed + 1);
        }
        std::thread::yield_now();
    }
    assert!(killed >= 3, "after {killed}: {}", launcher.said());
    let status = launcher.wait(PATIENCE);
    assert_eq!(status.code(), Some(1), "{}", launcher.said());
    let said = launcher.said();
    assert!(
        said.contains(&format!("node '{node}' does not stay up")) && said.contains("help:"),
        "{said}"
    );
    place.wait_empty(Duration::from_secs(2));
}

#[test]
fn a_node_that_does_not_stay_up_ends_the_rig_with_words() {
    let place = Place::new();
    let mut launcher = Launcher::up(&place, &[]);
    kill_until_the_rig_gives_up(&place, &mut launcher, "maulstick-paint", "paint");
}

#[test]
fn a_player_that_does_not_stay_up_ends_the_rig_with_words() {
    let place = Place::new();
    place.short_demo("take.mcap", 60.0);
    let mut launcher = play(&place, "take.mcap", "1");
    launcher.wait_says("is up");
    kill_until_the_rig_gives_up(&place, &mut launcher, "maulstick-player", "player");
}

#[test]
fn signals_stop_everything_with_the_right_code() {
    let place = Place::new();
    for (which, code) in [(Signal::SIGINT, 130), (Signal::SIGTERM, 143)] {
        let mut launcher = Launcher::up(&place, &[]);
        assert!(place.processes().len() >= 2, "brush and paint");
        launcher.signal(which);
        assert_eq!(launcher.wait(PATIENCE).code(), Some(code));
        place.wait_empty(Duration::ZERO);
    }
}

/// A rig whose paint node hears nothing any more.
fn rig_with_a_stopped_node(place: &Place) -> Launcher {
    let launcher = Launcher::up(place, &[]);
    let paint = place.pid("maulstick-paint").expect("a node");
    signal(paint, Signal::SIGSTOP);
    launcher
}

#[test]
fn a_stopped_node_does_not_survive_the_rig() {
    let place = Place::new();
    let mut launcher = rig_with_a_stopped_node(&place);
    launcher.signal(Signal::SIGTERM);
    launcher.wait(PATIENCE);
    place.wait_empty(Duration::ZERO);
}

#[test]
fn nothing_survives_a_killed_launcher() {
    let place = Place::new();
    let mut launcher = rig_with_a_stopped_node(&place);
    launcher.signal(Signal::SIGKILL);
    launcher.wait(PATIENCE);
    place.wait_empty(PATIENCE);
    // Its name is free again.
    Launcher::up(&place, &[]);
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
    let code = launcher.wait(PATIENCE).code();
    assert_eq!(code, Some(0), "{}", launcher.said());
    place.wait_empty(Duration::from_secs(2));
}

#[test]
fn a_rig_has_its_name_to_itself() {
    let place = Place::new();
    let first = Launcher::up(&place, &["--name", "one"]);
    let second = place.run(&["up", "--headless", "--name", "one"]);
    let said = String::from_utf8_lossy(&second.stderr).into_owned();
    assert_eq!(second.status.code(), Some(1), "{said}");
    assert!(said.contains(&first.pid().to_string()), "{said}");
    Launcher::up(&place, &["--name", "two"]);
}

#[test]
fn commands_reach_a_running_rig() {
    let place = Place::new();
    let _rig = Launcher::up(&place, &[]);
    place.done(&["load", "Cobalt Blue=0.5,Titanium White=0.5"]);
    let unknown = place.run(&["load", "Cobalt Bleu"]);
    assert_eq!(unknown.status.code(), Some(2));
    place.done(&["undo"]);
    place.done(&["painting", "redo"]);
    place.done(&["brush", "clean"]);
    assert!(account(&place, "cleaner") > 0.0);
    let refused = place.run(&["snapshot", "-o", "no/p.png"]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("no/p.png"), "{said}");
}

/// Waits until the window shows the wood of a handle to the lower right of a point of it, which is where a mouse holds a
/// brush, more or less steeply by where the eye sees it from; whether it did.
fn shows_brush(display: &Display, window: u32, [x, y]: [i16; 2]) -> bool {
    let wood = |[red, _, blue]: [u8; 3]| red > blue.saturating_add(35);
    let around = || {
        let steps = (5..20).flat_map(|i| (8..20).map(move |j| [5 * i, 5 * j]));
        steps.map(|[right, down]| display.pixel(window, x + right, y + down))
    };
    wait_for(PATIENCE, || around().any(wood).then_some(())).is_some()
}

#[test]
fn the_mouse_paints_on_the_palette_with_the_brush_that_is_shown() {
    let display = Display::start();
    let place = Place::new();
    let mut command = place.maulstick(&["up", "--load", "Titanium White"]);
    command.env("DISPLAY", &display.name);
    let mut launcher = Launcher::start(command);
    launcher.wait_says("is up");
    let window = display.window("Maulstick");
    let (bus, topics) = support::join(&place);
    let mut mouse = listen::<StylusSample>(&bus, &topics.sample("mouse"), Qos::RealTime);
    // On the palette, which lies to the left of the canvas.
    let points: Vec<_> = (0..40)
        .map(|i| over(-245.0 + 1.5 * f64::from(i), -10.0 + 0.3 * f64::from(i)))
        .collect();
    let [x, y] = points[20];
    let column = || (y - 40..y + 40).map(|y| display.pixel(window, x, y));
    let white = |pixel: [u8; 3]| pixel.iter().all(|channel| *channel > 180);
    let grey = |pixel: [u8; 3]| pixel.iter().all(|channel| (90..140).contains(channel));
    let bare = wait_for(PATIENCE, || column().all(grey).then_some(()));
    assert!(bare.is_some(), "the palette is not shown");
    display.drag(&points, &mut mouse);
    bus.close();
    assert!(
        shows_brush(&display, window, points[39]),
        "the brush is not shown"
    );
    let painted = wait_for(PATIENCE, || column().any(white).then_some(()));
    assert!(painted.is_some(), "the stroke is not shown");
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
    let points: Vec<_> = (0..60)
        .map(|i| over(-100.0 + 2.0 * f64::from(i), 30.0 - f64::from(i)))
        .collect();
    let [x, y] = points[20];
    // The canvas is light before anything is painted.
    let light = |pixel: [u8; 3]| pixel.iter().all(|channel| *channel > 180);
    let dark = |pixel: [u8; 3]| pixel.iter().all(|channel| *channel < 140);
    let shown = wait_for(PATIENCE, || {
        light(display.pixel(window, x, y)).then_some(())
    });
    assert!(shown.is_some(), "the canvas is not shown");
    let (bus, topics) = support::join(&place);
    let mut mouse = listen::<StylusSample>(&bus, &topics.sample("mouse"), Qos::RealTime);
    display.drag(&points, &mut mouse);
    bus.close();
    assert!(
        shows_brush(&display, window, points[59]),
        "the brush is not shown"
    );
    // The tip trails behind the pointer: the stroke crosses this column somewhere.
    let column = || (y - 100..y + 200).map(|y| display.pixel(window, x, y));
    let painted = wait_for(PATIENCE, || column().any(dark).then_some(()));
    assert!(painted.is_some(), "the stroke is not shown");
    place.done(&["undo"]);
    let undone = wait_for(PATIENCE, || column().all(light).then_some(()));
    assert!(undone.is_some(), "the undone stroke is still shown");
}

/// True if the hand presses and no force is on it.
fn is_unforced(sample: &StylusSample, head_length_m: f64) -> bool {
    pressed(sample, head_length_m) && sample.force_n == [0.0; 3]
}

/// True if the hand presses and the canvas presses back, upward and never above the limit.
fn presses_back(sample: &StylusSample, head_length_m: f64) -> bool {
    let size = sample.force_n.iter().map(|f| f * f).sum::<f64>().sqrt();
    assert!(size <= 3.0 + 1e-9, "{size} N");
    pressed(sample, head_length_m) && sample.force_n[2] > 0.1
}

/// A rig whose simulated hand presses for minutes: its device stands turned and beside the desk, and its brush comes from
/// a file.
fn pressing_rig(place: &Place, brush: &BrushFile) -> Launcher {
    support::press_for_minutes(&place.path("press.mcap"));
    place.write("file.toml", brush.to_toml().expect("a file"));
    place.write_settings(&[
        ("# hand = \"demo.mcap\"", "hand = \"press.mcap\""),
        ("position_m = [0, 0, 0]", "position_m = [0.1, -0.2, 0.15]"),
        (
            "orientation = [0, 0, 0, 1]",
            "orientation = [0.48, 0.36, 0, 0.8]",
        ),
        ("kind = \"round\"", "kind = \"file.toml\""),
    ]);
    Launcher::up(place, &["--rig", "rig.toml"])
}

/// Gives orders of force, each of which the hand feels.
fn order_force(place: &Place, samples: &mut Receiver<StylusSample>, head_length_m: f64) {
    for (order, gives, told) in [
        (&["off"][..], false, "force off"),
        (&["on"], true, "force on, 100 %"),
        (&["strength", "0%"], false, "force on, 0 %"),
        (&["strength", "60%"], true, "force on, 60 %"),
        (&["rearm", "--device", "phantom"], true, "force on, 60 %"),
    ] {
        let said = place.text(&[&["device", "force"], order].concat());
        assert_eq!(said, format!("phantom: {told}\n"));
        let is_felt = if gives { presses_back } else { is_unforced };
        let heard = hear(samples, |sample| is_felt(sample, head_length_m));
        assert!(heard.is_some(), "{order:?}");
    }
}

/// Waits until the hand has pressed without force for fifty samples, none of which is from the future.
fn fades(
    samples: &mut Receiver<StylusSample>,
    head_length_m: f64,
    now_ns: impl Fn() -> u64,
) -> Option<()> {
    let mut without = 0;
    wait_for(PATIENCE, || {
        while let Some(received) = samples.try_recv() {
            let (stamp_ns, sample) = (received.header.event_ns, received.message);
            assert!(stamp_ns <= now_ns(), "a stamp from the future");
            if is_unforced(&sample, head_length_m) {
                without += 1;
            } else if pressed(&sample, head_length_m) {
                without = 0;
            }
        }
        (without >= 50).then_some(())
    })
}

#[test]
fn a_simulated_hand_paints_and_feels_the_canvas() {
    let place = Place::new();
    let brush = BrushFile::library("round").expect("a brush");
    let head_length_m = brush.scaled_to(10.0).expect("a size").length_m();
    let mut launcher = pressing_rig(&place, &brush);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let presses_back = |sample: &StylusSample| presses_back(sample, head_length_m);
    let felt = hear(&mut samples, presses_back);
    assert!(felt.is_some(), "no force: {}", launcher.said());
    order_force(&place, &mut samples, head_length_m);
    let painted = || (support::on_canvas(&place) > 0.0).then_some(());
    wait_for(PATIENCE, painted).expect("painted");
    // Without its brush the force fades though the hand still presses, and comes back with it.
    let brush = place.pid("maulstick-brush").expect("a brush");
    signal(brush, Signal::SIGSTOP);
    drain(&mut samples);
    let faded = fades(&mut samples, head_length_m, || bus.now_ns());
    assert!(faded.is_some(), "the force is held");
    signal(brush, Signal::SIGKILL);
    launcher.wait_says("is started again");
    let again = hear(&mut samples, presses_back);
    assert!(again.is_some(), "no force any more: {}", launcher.said());
    bus.close();
}
