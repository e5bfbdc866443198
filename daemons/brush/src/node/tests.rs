//! A node on a bus in memory, without a painting: strokes that wait, and takes.

use maulstick_brush::BrushFile;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Faults, MemoryNet};
use maulstick_bus::{Qos, Queue};
use maulstick_painting::PaintingSetup;
use maulstick_types::Header;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose};

use super::*;

const MS: u64 = 1_000_000;

const PEN: Origin = Origin {
    source: 9,
    epoch: 1,
};

/// A node over a desk, and its network.
fn node() -> (BrushNode, MemoryNet) {
    let net = MemoryNet::new(1, 1000 * MS, Faults::default());
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    let settings = BrushSettings {
        name: "main".into(),
        file: BrushFile::library("round").expect("round"),
        depth_share: 0.5,
        devices: BrushDevices {
            foreign_priority: Some(0),
            ..BrushDevices::default()
        },
        epoch: 1,
    };
    let node = BrushNode::new(bus, &Topics::new("t"), &Wake::new(), settings);
    let mut node = node.expect("a node");
    node.solver.set_scene(&PaintingSetup::default().scene());
    (node, net)
}

fn pen(x: f64, pressure: f64) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, 0.0, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// Queues a sample of a pen.
fn queue(node: &mut BrushNode, event_ns: u64, x: f64, pressure: f64) {
    let sample = pen(x, pressure);
    node.solver
        .queue((PEN, event_ns / MS), event_ns, sample, event_ns);
}

fn header(origin: Origin, flags: Flags, seq: u64, event_ns: u64) -> Header {
    Header {
        version: 1,
        schema: 0,
        source: origin.source,
        epoch: origin.epoch,
        flags,
        length: 0,
        seq,
        event_ns,
        sent_ns: event_ns,
    }
}

/// Header of a window's message of what is pending.
fn order(seq: u64) -> Header {
    let window = Origin {
        source: 1,
        epoch: 1,
    };
    header(window, Flags::NONE, seq, 0)
}

/// Flags by which the solves of a stroke are late that waited from 1100 to 1350 ms.
fn lateness(node: &mut BrushNode) -> u32 {
    node.solve(1350 * MS);
    let solves = node.output.drain();
    assert!(solves.iter().any(|solve| solve.stroke == 1), "it began");
    let late = solves.iter().map(|solve| solve.flags);
    late.fold(0, |all, flags| all | flags) & (solve_flags::TWICE | solve_flags::FOUR_TIMES)
}

#[test]
fn a_stroke_that_was_held_is_not_late_though_another_order_is_pending() {
    let begun = || {
        let (mut node, _) = node();
        queue(&mut node, 1100 * MS, 0.0, 0.4);
        node
    };
    let mut late = begun();
    assert_eq!(lateness(&mut late), solve_flags::FOUR_TIMES, "of the paint");
    let mut held = begun();
    held.hold.on_pending(&order(1), 1050 * MS, 1060 * MS);
    held.solve(1110 * MS);
    assert_eq!(held.output.waiting(), 0);
    // That is done, and something else was asked for.
    held.hold.on_pending(&order(2), 1200 * MS, 1340 * MS);
    assert_eq!(lateness(&mut held), 0);
}

#[test]
fn a_mark_that_waits_is_posted_where_its_brush_begins_anew() {
    let (mut node, _) = node();
    queue(&mut node, 1100 * MS, 0.0, 0.4);
    node.solve(1101 * MS);
    let is_mark = |solve: &Solve| {
        let is_painted = solve.flags & solve_flags::PREVIEW == 0 && solve.stroke == 1;
        is_painted && solve.event_ns == 1100 * MS
    };
    assert!(!node.output.drain().iter().any(is_mark), "it waits");
    // A metre in a millisecond, there and back.
    for (ms, x) in [(1101, 1.0), (1102, 0.0)] {
        queue(&mut node, ms * MS, x, 0.4);
    }
    node.solve(1103 * MS);
    assert!(node.output.drain().iter().any(is_mark));
}

#[test]
fn a_take_has_no_mark_of_a_hand_that_waits_and_its_own_to_the_end() {
    let (mut node, net) = node();
    let (bus, topic) = (net.bus(), node.topics.brush_state("main"));
    let states = Receiver::new(&bus, &topic, Qos::RealTime, Queue::Ring(64), &Wake::new());
    let mut states: Receiver<BrushState> = states.expect("subscribed");
    queue(&mut node, 1100 * MS, 0.0, 0.4);
    node.solve(1101 * MS);
    assert!(!node.output.drain().is_empty(), "it waits");
    let player = Origin {
        source: 3,
        epoch: 1,
    };
    let take = [
        (1200, 0.0, Flags::REPLAY.with(Flags::FIRST)),
        (1208, 0.4, Flags::REPLAY.with(Flags::LAST)),
    ];
    for (seq, (ms, pressure, flags)) in (0..).zip(take) {
        let received = Received {
            key: node.topics.sample("player"),
            header: header(player, flags, seq, ms * MS),
            message: pen(0.0, pressure),
            arrived_ns: ms * MS,
        };
        assert!(node.replay("player", &received, ms * MS).expect("a bus"));
    }
    net.advance(10 * MS);
    let states = std::iter::from_fn(|| states.try_recv());
    let solves: Vec<Solve> = states.flat_map(|state| state.message.solves).collect();
    let painted = |solve: &&Solve| solve.flags & solve_flags::PREVIEW == 0 && solve.stroke > 0;
    let times: Vec<u64> = solves.iter().filter(painted).map(|s| s.event_ns).collect();
    assert_eq!(times, [1208 * MS]);
}

#[test]
fn a_stroke_that_is_held_for_a_brush_is_not_before_it_though_that_is_heard_later() {
    let (mut node, _) = node();
    let flat = BrushFile::library("flat").expect("flat");
    node.definition.request((1, 1), flat, 1100 * MS);
    queue(&mut node, 1060 * MS, 0.0, 0.4);
    let adopted = node.adopt_brush(1110 * MS).expect("a bus");
    assert!(!adopted, "the stroke is before it");
    node.hold.on_pending(&order(1), 1050 * MS, 1120 * MS);
    assert!(node.adopt_brush(1130 * MS).expect("a bus"));
    let since_ns = node.definition.since_ns(1130 * MS);
    assert_eq!(
        since_ns,
        Some(1050 * MS),
        "the stroke waits for the painting"
    );
}
