//! What a hand feels when processes of the rig die.

#[path = "../support/mod.rs"]
mod support;

use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Bus as _, Qos};
use maulstick_haptics::Limits;
use maulstick_types::haptics::{ContactModel, FluidForce, ForceLaw};
use maulstick_types::stylus::{StylusSample, StylusStatus};
use maulstick_types::{Origin, Pose, name_hash};
use nix::sys::signal::Signal;
use support::{
    Launcher, PATIENCE, Place, drain, hear, listen, pressed, printed, python, signal, wait_for,
};

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

/// A rig whose simulated hand presses for minutes, with other lines in its settings.
fn pressing_rig(place: &Place, others: &[(&str, &str)]) -> Launcher {
    support::press_for_minutes(&place.path("press.mcap"));
    let hand = ("# hand = \"demo.mcap\"", "hand = \"press.mcap\"");
    place.write_settings(&[&[hand], others].concat());
    Launcher::up(place, &["--rig", "rig.toml"])
}

#[test]
fn whichever_of_brush_and_paint_dies_the_force_fades_without_a_leap_and_comes_back() {
    let place = Place::new();
    let brush = BrushFile::library("round").expect("a brush");
    let head_length_m = brush.scaled_to(10.0).expect("a size").length_m();
    let mut launcher = pressing_rig(&place, &[]);
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

/// The largest force of a device in four seconds of samples, N, and whether it leaped. `meanwhile` is done over and over.
fn strongest(samples: &mut Receiver<StylusSample>, mut meanwhile: impl FnMut()) -> (f64, bool) {
    let (mut first_ns, mut last, mut most, mut leaped) = (None, None, 0.0f64, false);
    let ended = wait_for(PATIENCE, || {
        meanwhile();
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
    let launcher = pressing_rig(&place, &[]);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let felt = |sample: &StylusSample| size(sample) > 0.1;
    assert!(hear(&mut samples, felt).is_some(), "{}", launcher.said());
    let (live, _) = strongest(&mut samples, || {});
    place.done(&[
        "recording",
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
    let refused = support::fault(
        &place,
        &["recording", "replay", "s.mcap", "-t", "haptics/*/model"],
        2,
    );
    support::has(&refused, &["--drive"]);
    let replay = [
        "recording",
        "replay",
        "s.mcap",
        "--drive",
        "phantom",
        "--loop",
    ];
    let mut player = Launcher::start(place.maulstick(&replay));
    let pushes = |model: &ContactModel| !matches!(model.law, ForceLaw::None);
    assert!(hear(&mut models, pushes).is_some(), "{}", player.said());
    drain(&mut samples);
    assert!(hear(&mut samples, felt).is_some(), "{}", player.said());
    let (most, leaped) = strongest(&mut samples, || {});
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

#[test]
fn a_second_sender_neither_takes_the_wall_away_nor_kicks() {
    let place = Place::new();
    let launcher = pressing_rig(&place, &[]);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let status = topics.stylus_status("phantom");
    let mut statuses = listen::<StylusStatus>(&bus, &status, Qos::Background);
    let pressed = hear(&mut samples, |sample| size(sample) > 0.1);
    assert!(pressed.is_some(), "no force: {}", launcher.said());
    let (live, _) = strongest(&mut samples, || {});
    let refused = hear(&mut statuses, |_| true).map(|status| status.refused_senders);
    assert_eq!(
        refused,
        Some(0),
        "the brush is refused: {}",
        launcher.said()
    );
    let device = wait_for(PATIENCE, || {
        samples.try_recv().map(|received| received.header.origin())
    });
    let device = device.expect("a sample");
    let model = |law: ForceLaw, height_m: f64| ContactModel {
        device: device.source,
        device_epoch: device.epoch,
        plane_point_m: [0.0, 0.0, height_m],
        ..ContactModel::bare(law, 0.025)
    };
    let hard = ForceLaw::Rigid {
        stiffness_n_m: 400.0,
    };
    // One by a name of its own and one in the place of the brush: no wall, and a wall above the hand.
    let topic = topics.contact_model("phantom");
    let mut others = [
        (7, model(ForceLaw::None, 0.0)),
        (name_hash("main"), model(hard, 0.05)),
    ]
    .map(|(source, model)| {
        let me = Origin { source, epoch: 1 };
        let sender = Sender::new(&bus, &topic, Qos::RealTime, me);
        (sender.expect("a sender"), model)
    });
    let (most, leaped) = strongest(&mut samples, || {
        for (sender, model) in &mut others {
            let now_ns = bus.now_ns();
            sender.send(now_ns, now_ns, model).expect("sent");
        }
    });
    assert!(
        most > 0.8 * live && most < 1.25 * live,
        "{most} N, {live} N without them: {}",
        launcher.said()
    );
    assert!(!leaped, "the force leaps");
    let counted = hear(&mut statuses, |status| status.refused_senders > 100);
    assert!(counted.is_some_and(|status| status.faults.is_empty()));
    let told = launcher.said().matches(&topic).count();
    assert_eq!(told, others.len(), "{}", launcher.said());
    bus.close();
}

/// A force of paint on a hand at rest, along x, whose Jacobian brakes or drives.
fn paint(device: Origin, along_n: f64, damping_n_s_m: f64) -> FluidForce {
    let mut jacobian = [[0.0; 6]; 6];
    jacobian[0][0] = -damping_n_s_m;
    FluidForce {
        device: device.source,
        device_epoch: device.epoch,
        pose: Pose::IDENTITY,
        velocity: [0.0; 6],
        wrench: [along_n, 0.0, 0.0, 0.0, 0.0, 0.0],
        jacobian,
        time_to_live_ns: 200_000_000,
        recovery_ns: 20_000_000,
    }
}

/// Sends a force until it is felt; at no tick does the force on the hand leap.
fn push_until_felt(samples: &mut Receiver<StylusSample>, mut send: impl FnMut()) -> Option<()> {
    let mut last = None;
    wait_for(PATIENCE, || {
        send();
        while let Some(received) = samples.try_recv() {
            let (event_ns, force_n) = (received.header.event_ns, received.message.force_n);
            if let Some((before_ns, before)) = last.replace((event_ns, force_n)) {
                let s = (event_ns - before_ns) as f64 * 1e-9;
                let stood = s > Limits::default().longest_tick_s;
                assert!(
                    stood || !leaps(&before, &force_n, s),
                    "{before:?} {force_n:?}"
                );
            }
            if force_n[0] > 0.5 {
                return Some(());
            }
        }
        None
    })
}

/// Sends a force until more than twenty of them are counted as foreign.
fn push_until_refused(statuses: &mut Receiver<StylusStatus>, mut send: impl FnMut()) -> Option<()> {
    let before = hear(statuses, |_| true)?.foreign_models;
    wait_for(PATIENCE, || {
        send();
        let newest = statuses.newest()?.message;
        (newest.foreign_models > before + 20).then_some(())
    })
}

#[test]
fn a_force_of_paint_is_felt_without_a_leap_and_one_that_pushes_is_dropped() {
    let place = Place::new();
    let consents = ("# driven_by = [\"lesson\"]", "driven_by = [\"tester\"]");
    let launcher = pressing_rig(&place, &[consents]);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let status = topics.stylus_status("phantom");
    let mut statuses = listen::<StylusStatus>(&bus, &status, Qos::Background);
    let pressed = hear(&mut samples, |sample| size(sample) > 0.1);
    assert!(pressed.is_some(), "no force: {}", launcher.said());
    let device = wait_for(PATIENCE, || {
        samples.try_recv().map(|received| received.header.origin())
    });
    let device = device.expect("a sample");
    let me = Origin {
        source: name_hash("tester"),
        epoch: 1,
    };
    let topic = topics.fluid_force("phantom");
    let mut sender = Sender::new(&bus, &topic, Qos::RealTime, me).expect("a sender");
    let mut send = |damping_n_s_m: f64| {
        let now_ns = bus.now_ns();
        // Across the stroke, where no friction is: friction along x is less than this.
        let force = paint(device, 0.9, damping_n_s_m);
        sender.send(now_ns, now_ns, &force).expect("sent");
    };
    let felt = push_until_felt(&mut samples, || send(0.1));
    assert!(felt.is_some(), "the paint is not felt: {}", launcher.said());
    let refused = push_until_refused(&mut statuses, || send(-0.1));
    assert!(refused.is_some(), "one that pushes is taken");
    drain(&mut samples);
    let gone = hear(&mut samples, |sample| {
        size(sample) > 0.1 && sample.force_n[0] < 0.3
    });
    assert!(gone.is_some(), "the last good one is held");
    bus.close();
}

#[test]
fn the_documents_program_plots_force_against_depth() {
    let place = Place::new();
    let launcher = pressing_rig(&place, &[]);
    let (bus, topics) = support::join(&place);
    let mut samples = listen::<StylusSample>(&bus, &topics.sample("phantom"), Qos::RealTime);
    let felt = hear(&mut samples, |sample| size(sample) > 0.1);
    assert!(felt.is_some(), "nothing is felt: {}", launcher.said());
    place.done(&["recording", "record", "-o", "s.mcap", "--seconds", "2"]);
    bus.close();
    let [recording, plot] = ["s.mcap", "force.png"].map(|name| place.path(name));
    let words = [&recording, &plot].map(|path| path.to_str().expect("text"));
    let program = "../../docs/examples/plot_force.py";
    let said = printed(&mut python(&place, program, &words), b"");
    // "900 contact models, 5.1 mm at most, 0.52 N at most"
    let numbers: Vec<f64> = said
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    assert_eq!(numbers.len(), 3, "{said}");
    assert!(numbers[0] > 100.0, "{said}");
    assert!((1.0..30.0).contains(&numbers[1]), "{said}");
    assert!((0.1..3.3).contains(&numbers[2]), "{said}");
    assert!(place.bytes("force.png").starts_with(b"\x89PNG"));
}

/// The seeded fault: a force that goes at once is a leap.
#[test]
fn a_force_that_goes_at_once_is_found_out() {
    assert!(leaps(&[0.0, 0.0, 1.0], &[0.0; 3], 1e-3));
    assert!(!leaps(&[0.0, 0.0, 1.0], &[0.0, 0.0, 0.7], 1e-3));
}
