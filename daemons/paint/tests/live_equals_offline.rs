//! A take played through the nodes, over a network that loses, delays and reorders, with nodes that
//! turn in any order, paints what the same take paints offline: byte for byte.

mod support;

use std::sync::Arc;

use maulstick_bus::credit::Stamp;
use maulstick_bus::{Bus, Faults, MemoryNet};
use maulstick_models::model_names;
use maulstick_painting::edits::Load;
use maulstick_painting::picture::picture;
use maulstick_session::Offline;
use maulstick_types::command::Command;
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Origin, name_hash};
use proptest::prelude::*;
use support::{
    Device, Live, START_NS, file, loads, offline, offline_on, painting, painting_of, pen, settings,
    take, turns,
};

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn over_any_network_in_any_order(
        seed in any::<u64>(),
        loss in 0.0..0.3f64,
        delay_ms in 0u64..40,
    ) {
        let faults = Faults { loss, delay_ns: delay_ms * 1_000_000 };
        let mut live = Live::new(MemoryNet::new(seed, START_NS, faults));
        live.announce(1);
        live.play(&mut turns(seed), 200_000);
        prop_assert!(picture(live.paint.painting_mut(), 0).rgb == offline());
        prop_assert_eq!(live.paint.painting_mut().report().quanta_missing, 0);
    }

    #[test]
    fn also_when_paint_dies_in_the_middle_and_the_take_is_played_again(
        seed in any::<u64>(),
        loss in 0.0..0.2f64,
        dies_after in 50usize..1500,
    ) {
        let faults = Faults { loss, delay_ns: 5_000_000 };
        let mut live = Live::new(MemoryNet::new(seed, START_NS, faults));
        live.announce(1);
        let mut order = turns(seed);
        live.play(&mut order, dies_after);
        let bus: Arc<dyn Bus> = Arc::new(live.net.bus());
        live.paint = Live::paint_node(&bus, &live.topics, 6);
        // The brush is still sending the take that died with the paint.
        live.play(&mut order, 40);
        live.epoch = 4;
        live.announce(2);
        live.player.restart(4);
        live.sent = 0;
        live.play(&mut order, 200_000);
        prop_assert!(picture(live.paint.painting_mut(), 0).rgb == offline());
    }
}

#[test]
fn with_every_paint_model_and_no_two_paint_alike() {
    let mut pictures = Vec::new();
    for model in model_names() {
        let faults = Faults {
            loss: 0.2,
            delay_ns: 5_000_000,
        };
        let mut live = Live::new(MemoryNet::new(3, START_NS, faults));
        let bus: Arc<dyn Bus> = Arc::new(live.net.bus());
        live.paint = Live::paint_node_on(&bus, &live.topics, 6, painting_of(model));
        live.announce(1);
        live.play(&mut turns(3), 200_000);
        let painting = live.paint.painting_mut();
        assert_eq!(painting.report().quanta_missing, 0, "{model}");
        let painted = picture(painting, 0).rgb;
        assert!(painted == offline_on(painting_of(model)), "{model}");
        assert!(!pictures.contains(&painted), "a fault would pass: {model}");
        pictures.push(painted);
    }
}

/// A second device that presses all over the canvas while a take is announced and played.
struct Intruder {
    mouse: Device,
    step: u32,
    /// It sends nothing new, but answers for what was lost.
    rests: bool,
}

impl Intruder {
    fn of(live: &Live) -> Self {
        Self {
            mouse: live.device("mouse", 5),
            step: 0,
            rests: false,
        }
    }

    fn turn(&mut self) {
        if self.rests {
            return self.mouse.serve();
        }
        self.step += 1;
        let angle = 0.1 * f64::from(self.step);
        let (x, y) = (0.02 * libm::cos(angle), 0.02 * libm::sin(angle));
        self.mouse.send(&pen(x, y, 0.6));
    }
}

/// Turns of all, with the take up to sample `until`.
fn turns_of_all(
    live: &mut Live,
    intruder: &mut Intruder,
    until: usize,
    steps: usize,
    order: &mut impl FnMut() -> u8,
) {
    let samples = take();
    for _ in 0..steps {
        match order() % 4 {
            0 => live.player_turn(&samples[..until]),
            1 => drop(live.brush.poll().expect("turned")),
            2 => drop(live.paint.poll().expect("turned")),
            _ => intruder.turn(),
        }
        live.net.advance(700_000);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    #[test]
    fn no_other_device_cuts_into_a_take_however_long_it_is_silent(
        seed in any::<u64>(),
        loss in 0.0..0.2f64,
    ) {
        let faults = Faults { loss, delay_ns: 5_000_000 };
        let mut live = Live::new(MemoryNet::new(seed, START_NS, faults));
        let mut intruder = Intruder::of(&live);
        let mut order = turns(seed);
        live.announce(1);
        // Before the first sample, while it plays, and while the player is silent for a second.
        turns_of_all(&mut live, &mut intruder, 0, 300, &mut order);
        turns_of_all(&mut live, &mut intruder, 60, 600, &mut order);
        turns_of_all(&mut live, &mut intruder, 60, 1500, &mut order);
        // Its last samples arrive before the take goes on: after the take they may paint.
        intruder.rests = true;
        turns_of_all(&mut live, &mut intruder, 60, 4000, &mut order);
        live.play(&mut order, 200_000);
        prop_assert!(picture(live.paint.painting_mut(), 0).rgb == offline());
    }
}

#[test]
fn after_a_take_its_brush_is_free_again() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let mut intruder = Intruder::of(&live);
    let mut order = turns(1);
    live.announce(1);
    live.play(&mut order, 20_000);
    let before = live.paint.painting_mut().report().steps;
    turns_of_all(&mut live, &mut intruder, 0, 1000, &mut order);
    assert!(live.paint.painting_mut().report().steps > before);
}

#[test]
fn a_take_whose_player_is_gone_holds_nothing() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let mut intruder = Intruder::of(&live);
    let mut order = turns(1);
    let player = live
        .net
        .bus()
        .token(&live.topics.node("player"))
        .expect("one");
    live.announce(1);
    turns_of_all(&mut live, &mut intruder, 20, 1000, &mut order);
    let before = live.paint.painting_mut().report().steps;
    turns_of_all(&mut live, &mut intruder, 20, 1000, &mut order);
    assert_eq!(live.paint.painting_mut().report().steps, before);
    drop(player);
    turns_of_all(&mut live, &mut intruder, 20, 1000, &mut order);
    assert!(live.paint.painting_mut().report().steps > before);
}

#[test]
fn a_take_that_nobody_announced_paints_nothing() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    live.play(&mut turns(1), 20_000);
    let report = live.paint.painting_mut().report();
    assert_eq!((report.covered_cells, report.steps), (0, 0));
}

#[test]
fn a_single_sample_less_would_be_seen() {
    let mut offline_painting =
        Offline::new(painting(), "main", file(), 0.5, loads()).expect("set up");
    for (i, (time_ns, sample)) in take().into_iter().enumerate() {
        // Without its first touching sample the second stroke begins later.
        if i != 80 {
            offline_painting
                .sample(START_NS + time_ns, &sample)
                .expect("painted");
        }
    }
    assert!(picture(offline_painting.painting_mut(), 0).rgb != offline());
}

#[test]
fn a_live_brush_merges_while_paint_is_busy_and_keeps_the_path() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    live.command(
        1,
        Command::from(Load {
            mixture: loads()[0].clone(),
            beside: None,
            brush: BrushName::main(),
        }),
    );
    let samples = take();
    let mut states = 0;
    for (number, (time_ns, sample)) in samples.iter().enumerate() {
        let now_ns = live.net.bus().now_ns();
        let stamp = Stamp {
            now_ns,
            event_ns: now_ns,
        };
        assert!(*time_ns < u64::MAX);
        live.player.reset_credit();
        live.player.send(Flags::NONE, stamp, sample).expect("sent");
        live.net.advance(8_000_000);
        live.brush.poll().expect("turned");
        // Paint has its turn only now and then.
        if number % 12 == 0 {
            live.paint.poll().expect("turned");
        }
        states = live.brush.sent();
    }
    for _ in 0..200 {
        live.net.advance(5_000_000);
        live.brush.poll().expect("turned");
        live.paint.poll().expect("turned");
    }
    assert!(
        states < samples.len() as u64 * 3 / 4,
        "{states} states of {} samples",
        samples.len()
    );
    let merged = live.paint.painting_mut().report();
    let mut offline = Offline::new(painting(), "main", file(), 0.5, Vec::new()).expect("set up");
    let load = Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    };
    offline.edit(load).expect("loaded");
    for (time_ns, sample) in &samples {
        offline.sample(START_NS + time_ns, sample).expect("painted");
    }
    let whole = offline.painting_mut().report();
    assert_eq!(merged.quanta_missing, 0);
    let near = |a: u64, b: u64| (a as f64 / b as f64 - 1.0).abs() < 0.03;
    assert!(
        near(merged.covered_cells, whole.covered_cells),
        "{merged:?} {whole:?}"
    );
}

/// Paint that has its turn each so many samples: its steps, cells covered, and how much longer steps ever were.
fn painted_late(every: usize) -> (u64, u64, u32) {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let load = Command::from(Load {
        mixture: loads()[0].clone(),
        beside: None,
        brush: BrushName::main(),
    });
    live.command(1, load);
    let mut mouse = live.device("mouse", 5);
    let mut longest = 1;
    for number in 0..400u32 {
        let angle = 0.05 * f64::from(number);
        let (x, y) = (10.0 * libm::cos(angle), 10.0 * libm::sin(angle));
        mouse.send(&pen(1e-3 * (16.0 + x), 1e-3 * (16.0 + y), 0.4));
        live.net.advance(4_000_000);
        live.brush.poll().expect("turned");
        if (number as usize).is_multiple_of(every) {
            live.paint.poll().expect("turned");
            longest = longest.max(live.paint.painting_mut().longer());
        }
    }
    mouse.send(&pen(0.016, 0.016, 0.0));
    for _ in 0..200 {
        live.net.advance(5_000_000);
        live.brush.poll().expect("turned");
        live.paint.poll().expect("turned");
    }
    let painting = live.paint.painting_mut();
    assert_eq!(painting.longer(), 1, "the brush has lifted");
    let report = painting.report();
    assert_eq!(report.quanta_missing, 0);
    (painting.work().0, report.covered_cells, longest)
}

#[test]
fn painting_that_falls_behind_goes_in_longer_steps() {
    let (steps, covered, longest) = painted_late(1);
    assert_eq!(longest, 1, "in time");
    for (every, longer) in [(40, 2), (100, 4)] {
        let late = painted_late(every);
        assert_eq!(late.2, longer, "a turn each {} ms", 4 * every);
        assert!(late.0 < steps * 4 / 5, "{} steps of {steps}", late.0);
        let off = late.1 as f64 / covered as f64 - 1.0;
        assert!(off.abs() < 0.05, "{} cells of {covered}", late.1);
    }
}

#[test]
fn what_has_waited_long_is_sent_in_messages_that_fit() {
    let mut settings = settings();
    // So many joints that 200 solves exceed a message.
    settings.file.spines.joints = 16;
    let net = MemoryNet::new(1, START_NS, Faults::default());
    let mut live = Live::with(net, settings);
    let mut mouse = live.device("mouse", 5);
    // The path turns at each sample, so that none may be joined; paint has no turn.
    for step in 0..600 {
        let y = 2e-3 * f64::from(step % 2);
        mouse.send(&pen(1e-4 * f64::from(step), y, 0.4));
        live.net.advance(1_000_000);
        live.brush.poll().expect("turned");
    }
    let before = live.brush.sent();
    for _ in 0..200 {
        live.net.advance(5_000_000);
        live.paint.poll().expect("turned");
        live.brush.poll().expect("turned");
    }
    let brush = Origin {
        source: name_hash("main"),
        epoch: 77,
    };
    assert!(live.brush.sent() > before + 2, "the rest is one message");
    assert_eq!(live.paint.consumed(brush), live.brush.sent());
    assert_eq!(mouse.consumed(), 600);
}

#[test]
fn a_gap_of_thirty_years_in_a_take_takes_no_time() {
    let paint = |gap_ns: u64| {
        let mut offline = Offline::new(painting(), "main", file(), 0.5, loads()).expect("set up");
        for (i, (time_ns, sample)) in take().into_iter().enumerate() {
            let late = if i > 30 { gap_ns } else { 0 };
            offline
                .sample(START_NS + time_ns + late, &sample)
                .expect("painted");
        }
        picture(offline.painting_mut(), 0).rgb
    };
    assert!(paint(1_000_000_000 * 1_000_000_000) == paint(500_000_000));
}
