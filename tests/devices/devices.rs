//! Devices of a real rig: several at once, and those that are not there. Tablets are played from
//! recordings.

#[path = "../support/mod.rs"]
mod support;

use maulstick_bus::{Bus as _, Qos, ZenohBus};
use maulstick_types::brush::BrushState;
use maulstick_types::name_hash;
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::stylus::{StylusInfo, StylusSample, StylusStatus};
use maulstick_types::wire::topics::Topics;
use support::{Launcher, PATIENCE, Place, hear, listen, wait_for};

/// A pen that draws a wave again and again, for a minute and a half.
fn waves(place: &Place, name: &str) {
    let wave = include_str!("../../docs/examples/pen.hid");
    let (head, events): (Vec<&str>, Vec<&str>) =
        wave.lines().partition(|line| !line.starts_with("E:"));
    let mut text = head.join("\n") + "\n";
    for turn in 0..45 {
        for event in &events {
            let (time, report) = event["E: ".len()..].split_once(' ').expect("an event");
            let seconds: f64 = time.parse().expect("a time");
            text += &format!("E: {:.6} {report}\n", seconds + 2.0 * f64::from(turn));
        }
    }
    place.write(name, text);
}

/// The built-in settings with other devices, each `(name, brush, priority, lines of its own)`, and a
/// second brush.
fn settings(place: &Place, devices: &[(&str, &str, i32, &str)]) {
    let config = place.text(&["up", "--print-config"]);
    let start = config.find("[[device]]").expect("a device");
    let end = start + config[start..].find("\n\n").expect("its end");
    let mut sections = String::new();
    for (name, brush, priority, own) in devices {
        sections += &format!(
            "[[device]]\nname = \"{name}\"\nbrush = \"{brush}\"\npriority = {priority}\n{own}\n"
        );
    }
    sections += "[[brush]]\nname = \"second\"\nkind = \"flat\"\n";
    let (before, after) = (&config[..start], &config[end..]);
    place.write("rig.toml", format!("{before}{sections}{after}"));
}

const PEN: &str = "driver = \"pen\"\nreplay = \"waves.hid\"\n";

fn touches(state: &BrushState) -> bool {
    state.solves.iter().any(|solve| solve.stroke != 0)
}

#[test]
fn a_second_stylus_drives_a_second_brush() {
    let place = Place::new();
    waves(&place, "waves.hid");
    // The other tablet lies turned: its waves go up the canvas.
    let turned = format!("{PEN}scale = 1.0\norientation = [0, 0, 0.7071068, 0.7071068]\n");
    settings(
        &place,
        &[("left", "main", 0, PEN), ("right", "second", 0, &turned)],
    );
    let launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let (bus, topics) = support::join(&place);
    for (device, brush) in [("left", "main"), ("right", "second")] {
        let mut states = listen::<BrushState>(&bus, &topics.brush_state(brush), Qos::RealTime);
        let moved = |state: &BrushState| touches(state) && state.device == name_hash(device);
        assert!(
            hear(&mut states, moved).is_some(),
            "{brush}: {}",
            launcher.said()
        );
    }
    place.done(&["load", "Pyrrole Red", "--brush", "second"]);
    let painted = wait_for(PATIENCE, || {
        (support::on_canvas(&place) > 0.0).then_some(())
    });
    assert!(painted.is_some(), "{}", launcher.said());
    bus.close();
}

/// Whether a pen that draws waves paints beside one that only hovers, by their priorities: what the brush
/// does between two leaves of the drawing one, once the other is near.
fn paints_beside_a_hovering_pen(drawing: i32, hovering: i32) -> bool {
    let place = Place::new();
    waves(&place, "waves.hid");
    let text = String::from_utf8(place.bytes("waves.hid")).expect("text");
    // The tip is bit 0 of the second byte: this pen never touches, and never leaves.
    let hovers = text.lines().filter(|line| !line.contains(" 10 01 00 "));
    let hovers = hovers.map(|line| line.replace(" 10 01 11 ", " 10 01 10 "));
    let hovers: Vec<String> = hovers
        .filter(|line| !line.starts_with("E:") || line.contains(" 10 01 10 "))
        .collect();
    place.write("hovers.hid", hovers.join("\n") + "\n");
    let still = PEN.replace("waves.hid", "hovers.hid");
    settings(
        &place,
        &[
            ("draws", "main", drawing, PEN),
            ("hovers", "main", hovering, &still),
        ],
    );
    let launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let (bus, topics) = support::join(&place);
    let mut hovers = listen::<StylusSample>(&bus, &topics.sample("hovers"), Qos::RealTime);
    let mut draws = listen::<StylusSample>(&bus, &topics.sample("draws"), Qos::RealTime);
    let mut states = listen::<BrushState>(&bus, &topics.brush_state("main"), Qos::RealTime);
    assert!(
        hear(&mut hovers, |sample| sample.in_range).is_some(),
        "{}",
        launcher.said()
    );
    // A stroke that began before goes on until its pen is lifted; after that two more are drawn.
    let mut strokes = 0;
    for drawn in 0..3 {
        assert!(
            hear(&mut draws, |sample| !sample.in_air()).is_some(),
            "{}",
            launcher.said()
        );
        assert!(
            hear(&mut draws, |sample| sample.in_air()).is_some(),
            "{}",
            launcher.said()
        );
        // What is drawn is solved by the time the brush knows of the next hover.
        let since = bus.now_ns();
        let solved = |state: &BrushState| state.solves.iter().any(|solve| solve.event_ns > since);
        let mut its = 0;
        let known = hear(&mut states, |state| {
            its += usize::from(touches(state) && state.device == name_hash("draws"));
            solved(state)
        });
        assert!(known.is_some(), "{}", launcher.said());
        if drawn > 0 {
            strokes += its;
        }
    }
    bus.close();
    strokes > 0
}

#[test]
fn of_two_pens_in_range_the_one_of_higher_priority_has_the_brush() {
    assert!(!paints_beside_a_hovering_pen(1, 2));
    assert!(
        paints_beside_a_hovering_pen(2, 1),
        "the same with priorities turned round"
    );
}

/// A SpaceNavigator, by its descriptor's layout: three pushes, three turns, two buttons.
const PUCK: &str = "\
D: 0
R: 78 05 01 09 08 a1 01 a1 00 85 01 16 a2 fe 26 5e 01 36 88 fa 46 78 05 09 30 09 31 09 32 75 10 95 03 81 02 c0 \
a1 00 85 02 09 33 09 34 09 35 75 10 95 03 81 02 c0 \
a1 02 85 03 05 09 19 01 29 02 15 00 25 01 75 01 95 02 81 02 95 0e 81 03 c0 c0
N: a puck
P: none
I: 3 046d c626
";

#[test]
fn the_free_hand_moves_the_canvas() {
    let place = Place::new();
    // Pushed to the right for a minute: the stop is 350.
    let mut text = PUCK.to_owned();
    for report in 0..7500 {
        let seconds = f64::from(report) * 0.008;
        text += &format!("E: {seconds:.6} 7 01 5e 01 00 00 00 00\n");
    }
    place.write("puck.hid", text);
    let puck = "driver = \"spacemouse\"\nreplay = \"puck.hid\"\n";
    settings(&place, &[("puck", "main", 0, puck)]);
    let launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let (bus, topics) = support::join(&place);
    let mut scenes = listen::<Scene>(&bus, &topics.scene(), Qos::Cached);
    let canvas = |scene: &Scene| {
        let surface = scene.surfaces.iter().find(|surface| surface.id == CANVAS);
        surface.map(|surface| surface.pose.position_m)
    };
    // At rest the canvas of 256 mm lies with its lower left corner at -128 mm.
    let moved = hear(&mut scenes, |scene| {
        canvas(scene).is_some_and(|at| at[0] > -0.05)
    });
    let at = moved
        .as_ref()
        .and_then(canvas)
        .unwrap_or_else(|| panic!("{}", launcher.said()));
    assert!((at[1] + 0.128).abs() < 1e-9 && at[2] == 0.0, "{at:?}");
    bus.close();
}

/// Devices that are not there: name, priority, lines of its own, and a word of its trouble.
const ABSENT: [(&str, i32, &str, &str); 5] = [
    (
        "phantom",
        9,
        "driver = \"openhaptics\"\nlibrary = \"/nowhere/libHD.so\"\n",
        "libhd",
    ),
    (
        "wooden",
        8,
        "driver = \"polhem\"\naddress = \"/dev/nothing\"\n",
        "/dev/nothing",
    ),
    (
        "haply",
        7,
        "driver = \"inverse3\"\naddress = \"ws://127.0.0.1:9\"\n",
        "127.0.0.1:9",
    ),
    ("tablet", 6, "driver = \"pen\"\n", "pen"),
    ("puck", 5, "driver = \"spacemouse\"\n", "mouse"),
];

/// The trouble that a device of the rig tells.
fn trouble_of(bus: &ZenohBus, topics: &Topics, name: &str) -> Option<String> {
    let topic = topics.stylus_status(name);
    let mut statuses = listen::<StylusStatus>(bus, &topic, Qos::Background);
    let told = hear(&mut statuses, |status| status.trouble().is_some())?;
    told.trouble().map(|trouble| trouble.to_string())
}

#[test]
fn devices_that_are_not_there_are_told_once_and_the_rig_goes_on_with_the_others() {
    let place = Place::new();
    waves(&place, "waves.hid");
    let absent = ABSENT.map(|(name, priority, own, _)| (name, "main", priority, own));
    settings(
        &place,
        &[&absent[..], &[("played", "main", 0, PEN)]].concat(),
    );
    let mut launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let (bus, topics) = support::join(&place);
    let troubles = ABSENT.map(|(name, _, _, word)| {
        let trouble = trouble_of(&bus, &topics, name);
        let trouble = trouble.unwrap_or_else(|| panic!("{name}: {}", launcher.said()));
        assert!(trouble.to_lowercase().contains(word), "{name}: {trouble}");
        (name, trouble)
    });
    let mut states = listen::<BrushState>(&bus, &topics.brush_state("main"), Qos::RealTime);
    let played = |state: &BrushState| touches(state) && state.device == name_hash("played");
    assert!(hear(&mut states, played).is_some(), "{}", launcher.said());
    assert!(launcher.is_running());
    for (name, trouble) in troubles {
        let said = launcher.said().matches(&trouble).count();
        assert_eq!(said, 1, "{name}: {}", launcher.said());
    }
    let mut infos = listen::<StylusInfo>(&bus, &topics.stylus_info("played"), Qos::Cached);
    let info = hear(&mut infos, |_| true).expect("what it is");
    assert_eq!((info.driver.as_str(), info.priority), ("pen", 0));
    bus.close();
}
