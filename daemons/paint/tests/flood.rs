//! Samples that come faster than any hand: the brush goes on, and the next device paints.

mod support;

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_types::brush::BrushState;
use support::{Live, START_NS, pen};

/// Solves that a turn of the brush sends at most: its own bound, and those of one sample.
const MOST: usize = 256 + 4 * 1024 + 1;

fn turn(live: &mut Live) {
    live.net.advance(1_000_000);
    live.brush.poll().expect("turned");
    live.net.advance(1_000_000);
    live.paint.poll().expect("turned");
}

/// Solves of the states that came, and how many of them touch in the middle of a stroke.
fn solves(states: &mut Receiver<BrushState>, device: u32) -> (usize, usize) {
    let states = std::iter::from_fn(|| states.try_recv()).map(|received| received.message);
    let solves = states.filter(|state| state.device == device);
    let solves: Vec<_> = solves.flat_map(|state| state.solves).collect();
    let painting = solves
        .iter()
        .filter(|solve| solve.flags == 0 && solve.stroke != 0);
    (solves.len(), painting.count())
}

#[test]
fn after_a_flood_of_samples_the_next_device_paints() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    let bus = live.net.bus();
    let topic = live.topics.brush_state("main");
    let states = Receiver::new(&bus, &topic, Qos::RealTime, Queue::Ring(8192), &Wake::new());
    let mut states = states.expect("subscribed");
    turn(&mut live);
    // A zigzag of a millimetre each, round and round, at 200 kHz: 200 m/s.
    let (mut flood, mut sent) = (live.device("flood", 41), 0_u32);
    for _ in 0..5 {
        for _ in 0..1000 {
            live.net.advance(5_000);
            let x = 2e-4 * f64::from(sent % 400);
            flood.send(&pen(x - 0.04, 1e-3 * f64::from(sent % 3), 0.4));
            sent += 1;
        }
        let before = live.brush.sent();
        live.brush.poll().expect("turned");
        live.net.advance(1_000);
        let (many, _) = solves(&mut states, 41);
        assert!(
            many <= MOST,
            "{many} solves in a turn that sent from {before}"
        );
        let work = live.brush.work();
        assert!(work.waiting + work.held < 5000, "{work:?}");
        live.paint.poll().expect("turned");
    }
    let work = live.brush.work();
    assert!(work.too_fast > 0, "{work:?}");
    // It is gone, and its stroke is left after half a second.
    let mut turns = 0;
    while live.brush.work().waiting + live.brush.work().held > 0 {
        turn(&mut live);
        turns += 1;
        assert!(turns < 2000, "{:?}", live.brush.work());
    }
    live.net.advance(600_000_000);
    solves(&mut states, 42);
    let mut other = live.device("pen", 42);
    for step in 0..60 {
        other.send(&pen(1e-3 * f64::from(step), 0.02, 0.4));
        (0..4).for_each(|_| turn(&mut live));
    }
    other.send(&pen(0.06, 0.02, 0.0));
    (0..40).for_each(|_| turn(&mut live));
    let (_, painting) = solves(&mut states, 42);
    // 59 mm in steps of .175 mm.
    assert!(painting > 300, "{painting} solves");
    assert_eq!(other.consumed(), 61);
    let lost = live.brush.work().lost;
    assert_eq!(lost, 0, "nothing that a hand drew");
}

#[test]
fn an_ordinary_hand_is_never_too_fast() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    turn(&mut live);
    let mut arm = live.device("arm", 42);
    // 5 m/s, with four samples at once each 8 ms, as of a late frame.
    for step in 0..40_u32 {
        for part in 0..4_u32 {
            live.net.advance(1);
            let x = 0.01 * f64::from((4 * step + part) % 8);
            arm.send(&pen(x, 0.0, 0.4));
        }
        (0..4).for_each(|_| turn(&mut live));
    }
    (0..40).for_each(|_| turn(&mut live));
    let work = live.brush.work();
    assert_eq!((work.too_fast, work.lost), (0, 0), "{work:?}");
}
