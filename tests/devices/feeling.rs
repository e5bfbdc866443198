//! What a hand feels when processes of the rig die.

#[path = "../support/mod.rs"]
mod support;

use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_bus::Qos;
use maulstick_bus::typed::Receiver;
use maulstick_haptics::Limits;
use maulstick_types::haptics::{ContactModel, ForceLaw};
use maulstick_types::stylus::StylusSample;
use nix::sys::signal::Signal;
use support::{Launcher, PATIENCE, Place, drain, hear, listen, pressed, signal, wait_for};

fn size(sample: &StylusSample) -> f64 {
    sample.force_n.iter().map(|f| f * f).sum::<f64>().sqrt()
}

/// Whether two forces, `s` seconds apart, are farther apart than the servo may change its force.
fn leaps(from: &[f64; 3], to: &[f64; 3], s: f64) -> bool {
    let change = (0..3)
        .map(|i| (to[i] - from[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    change > Limits::default().slew_n_s * s + 1e-9
}

/// Follows the samples until the hand has pressed without force for fifty of them; at no tick does the
/// force leap.
fn fades(samples: &mut Receiver<StylusSample>, head_length_m: f64) -> Option<()> {
    let (mut last, mut without) = (None, 0);
    wait_for(PATIENCE, || {
        while let Some(received) = samples.try_recv() {
            let (event_ns, sample) = (received.header.event_ns, received.message);
            assert!(sample.in_range, "the hand has let go");
            if let Some((before_ns, before)) = last.replace((event_ns, sample.force_n)) {
                let s = (event_ns - before_ns) as f64 * 1e-9;
                // A tick that stood still has no force at once: a suspended servo must not kick.
                let stood = s > Limits::default().longest_tick_s && size(&sample) == 0.0;
                assert!(
                    stood || !leaps(&before, &sample.force_n, s),
                    "{before:?} {sample:?}"
                );
            }
            if pressed(&sample, head_length_m) {
                without = if size(&sample) == 0.0 { without + 1 } else { 0 };
            }
        }
        (without >= 50).then_some(())
    })
}

#[test]
fn whichever_of_brush_and_paint_dies_the_force_fades_without_a_leap_and_comes_back() {
    let place = Place::new();
    support::press_for_minutes(&place.path("press.mcap"));
    let brush = BrushFile::library("round").expect("a brush");
    let head_length_m = brush.scaled_to(10.0).expect("a size").length_m();
    let config = String::from_utf8(place.done(&["up", "--print-config"]).stdout).expect("UTF-8");
    let hand = config.replace("# hand = \"demo.mcap\"", "hand = \"press.mcap\"");
    assert_ne!(hand, config);
    std::fs::write(place.path("rig.toml"), hand).expect("written");
    let mut launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let felt = |sample: &StylusSample| size(sample) > 0.1;
    for (program, node) in [
        ("maulstick-brush", "brush-main"),
        ("maulstick-paint", "paint"),
    ] {
        let pressed = hear(&mut samples, felt);
        assert!(pressed.is_some(), "no force: {}", launcher.said());
        let pid = wait_for(Duration::from_secs(20), || place.pid(program)).expect(program);
        drain(&mut samples);
        signal(pid, Signal::SIGKILL);
        assert!(
            fades(&mut samples, head_length_m).is_some(),
            "{program}: the force is held"
        );
        launcher.wait_says(&format!("node '{node}' failed and is started again"));
    }
    assert!(hear(&mut samples, felt).is_some(), "{}", launcher.said());
    bus.close();
}

/// The largest force of a device in four seconds of samples, N, and whether it leaped.
fn strongest(samples: &mut Receiver<StylusSample>) -> (f64, bool) {
    let (mut first_ns, mut last, mut most, mut leaped) = (None, None, 0.0f64, false);
    let ended = wait_for(PATIENCE, || {
        while let Some(received) = samples.try_recv() {
            let (event_ns, force_n) = (received.header.event_ns, received.message.force_n);
            most = most.max(size(&received.message));
            if let Some((before_ns, before)) = last.replace((event_ns, force_n)) {
                let s = (event_ns - before_ns) as f64 * 1e-9;
                leaped |= s <= Limits::default().longest_tick_s && leaps(&before, &force_n, s);
            }
            if event_ns > *first_ns.get_or_insert(event_ns) + 4_000_000_000 {
                return Some(());
            }
        }
        None
    });
    assert!(ended.is_some(), "no samples");
    (most, leaped)
}

#[test]
fn recorded_models_drive_a_device_by_the_rules_of_its_servo() {
    let place = Place::new();
    support::press_for_minutes(&place.path("press.mcap"));
    let config = String::from_utf8(place.done(&["up", "--print-config"]).stdout).expect("UTF-8");
    let hand = config.replace("# hand = \"demo.mcap\"", "hand = \"press.mcap\"");
    std::fs::write(place.path("rig.toml"), &hand).expect("written");
    let mut launcher = Launcher::up(&place, &["--rig", "rig.toml"]);
    launcher.wait_says("is up");
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let felt = |sample: &StylusSample| size(sample) > 0.1;
    assert!(hear(&mut samples, felt).is_some(), "{}", launcher.said());
    let (live, _) = strongest(&mut samples);
    place.done(&[
        "record",
        "-o",
        "s.mcap",
        "--topic",
        "haptics/**",
        "--seconds",
        "6",
    ]);
    place.done(&["device", "use", "phantom", "--force", "none"]);
    let topic = topics.contact_model("phantom");
    let mut models = listen::<ContactModel>(&bus, &topic, Qos::RealTime);
    let is_free = |model: &ContactModel| matches!(model.law, ForceLaw::None);
    assert!(hear(&mut models, is_free).is_some(), "a law without force");
    let refused = support::fault(&place, &["replay", "s.mcap", "-t", "haptics/*/model"], 2);
    support::has(&refused, &["--drive"]);
    let replay = ["replay", "s.mcap", "--drive", "phantom", "--loop"];
    let mut player = Launcher::start(place.maulstick(&replay));
    let pushes = |model: &ContactModel| !matches!(model.law, ForceLaw::None);
    assert!(hear(&mut models, pushes).is_some(), "{}", player.said());
    drain(&mut samples);
    assert!(hear(&mut samples, felt).is_some(), "{}", player.said());
    let (most, leaped) = strongest(&mut samples);
    // The same hand presses; it is elsewhere in its stroke than when the models were recorded.
    assert!(
        most > 0.5 * live && most < 1.5 * live,
        "{most} N, live {live} N"
    );
    assert!(!leaped, "the force leaps");
    player.signal(Signal::SIGINT);
    player.wait(PATIENCE);
    assert!(
        hear(&mut models, is_free).is_some(),
        "the live brush has it again"
    );
    bus.close();
}

/// The seeded fault: a force that goes at once is a leap.
#[test]
fn a_force_that_goes_at_once_is_found_out() {
    assert!(leaps(&[0.0, 0.0, 1.0], &[0.0; 3], 1e-3));
    assert!(!leaps(&[0.0, 0.0, 1.0], &[0.0, 0.0, 0.7], 1e-3));
}
