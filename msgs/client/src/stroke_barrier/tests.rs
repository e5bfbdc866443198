use maulstick_bus::typed::Sender;
use maulstick_bus::{Faults, MemoryNet};
use maulstick_types::Edit;
use maulstick_types::{Origin, Pose};
use serde_json::json;

use super::*;

const MILLISECOND: u64 = 1_000_000;
const START_NS: u64 = MILLISECOND;
const MOUSE: u32 = 77;
const BRUSH: &str = "main";

/// A brush, a painting, and orders between them.
struct Desk {
    net: MemoryNet,
    barrier: StrokeBarrier,
    brush: Sender<BrushConsumed>,
    paint: Sender<PaintConsumed>,
}

impl Desk {
    fn new() -> Self {
        let net = MemoryNet::new(1, START_NS, Faults::default());
        let (bus, topics) = (net.bus(), Topics::new("t"));
        let me = |name: &str| Origin {
            source: name_hash(name),
            epoch: 1,
        };
        let barrier = StrokeBarrier::new(&bus, &topics).expect("listens");
        let topic = topics.brush_consumed(BRUSH);
        let brush = Sender::new(&bus, &topic, Qos::Control, me(BRUSH)).expect("sends");
        let topic = topics.paint_consumed();
        let paint = Sender::new(&bus, &topic, Qos::Control, me(PAINT_NODE)).expect("sends");
        let mut desk = Self {
            barrier,
            brush,
            paint,
            net,
        };
        desk.consumed(1, 1);
        desk
    }

    fn pass(&mut self) {
        self.net.advance(10 * MILLISECOND);
        self.barrier.drain(self.net.bus().now_ns());
    }

    /// The brush has consumed the mouse's samples below `next`, the newest of them in `state`.
    fn consumed(&mut self, next: u64, state: u64) {
        let consumed = BrushConsumed {
            device: MOUSE,
            device_epoch: 3,
            next,
            brush_epoch: 5,
            state,
        };
        self.brush.send(0, 0, &consumed).expect("sent");
        self.pass();
    }

    /// The states below `next` are painted.
    fn painted(&mut self, next: u64) {
        let credit = BrushCredit {
            brush: name_hash(BRUSH),
            epoch: 5,
            next,
            wetness: 0.0,
            film_m: 0.0,
            viscosity_m2_s: 0.0,
            contact_m: 0.0,
            file: 0,
        };
        let painted = PaintConsumed {
            brushes: vec![credit],
        };
        self.paint.send(0, 0, &painted).expect("sent");
        self.pass();
    }

    fn push(&mut self, command: Command, seq: u64) {
        let request = Request::Command {
            node: PAINT_NODE.into(),
            command,
        };
        let sample = SampleNumber {
            device: MOUSE,
            epoch: 3,
            seq,
        };
        let now_ns = self.net.bus().now_ns();
        self.barrier.push(now_ns, (request, now_ns), [sample]);
    }

    /// The next command, and the state that it goes behind.
    fn next_ready(&mut self) -> Option<(Command, Option<u64>)> {
        let now_ns = self.net.bus().now_ns();
        let next_ready = self.barrier.next_ready(now_ns)?;
        let after = next_ready.after.map(|after| {
            assert_eq!((after.brush, after.epoch), (name_hash(BRUSH), 5));
            after.sequence
        });
        match next_ready.request {
            Request::Command { command, .. } => Some((command, after)),
            other @ Request::Force { .. } => panic!("{other:?}"),
        }
    }
}

fn undo() -> Command {
    Edit::named("undo", &json!({})).into()
}

fn place() -> Command {
    let fields = json!({ "surface": 0, "pose": Pose::IDENTITY, "zoom": 1.0 });
    Edit::named("place", &fields).into()
}

#[test]
fn an_undo_goes_right_behind_the_stroke_before_it() {
    let mut desk = Desk::new();
    desk.painted(2);
    desk.push(undo(), 9);
    assert_eq!(desk.next_ready(), None, "the brush has not consumed it");
    desk.consumed(9, 20);
    desk.painted(30);
    assert_eq!(desk.next_ready(), None, "nor the last of its samples");
    desk.consumed(10, 40);
    assert_eq!(desk.next_ready(), Some((undo(), Some(40))));
    assert!(!desk.barrier.is_waiting());
    desk.push(undo(), 9);
    desk.painted(41);
    assert_eq!(desk.next_ready(), Some((undo(), None)), "it is painted");
}

#[test]
fn another_node_is_asked_when_the_stroke_is_painted() {
    let mut desk = Desk::new();
    let request = Request::Command {
        node: "rig".into(),
        command: undo(),
    };
    let sample = SampleNumber {
        device: MOUSE,
        epoch: 3,
        seq: 9,
    };
    desk.barrier.push(START_NS, (request.clone(), 0), [sample]);
    desk.consumed(10, 40);
    // What is painted later does not hold it up.
    assert_eq!(desk.barrier.next_ready(START_NS), None);
    desk.consumed(30, 90);
    desk.painted(40);
    assert_eq!(desk.barrier.next_ready(START_NS), None);
    desk.painted(41);
    assert_eq!(desk.barrier.next_ready(START_NS), Some(request.into()));
}

#[test]
fn a_canvas_moves_at_once_but_overtakes_nothing() {
    let mut desk = Desk::new();
    desk.push(place(), 9);
    assert_eq!(desk.next_ready(), Some((place(), None)));
    desk.push(undo(), 9);
    desk.push(place(), 20);
    assert_eq!(desk.next_ready(), None);
    desk.consumed(10, 4);
    let next_ready = [desk.next_ready(), desk.next_ready()];
    assert_eq!(next_ready, [Some((undo(), Some(4))), Some((place(), None))]);
}

/// Paint may be seconds behind a hand that has long been at rest.
#[test]
fn a_stroke_that_is_not_painted_is_not_overtaken_however_long_the_hand_rests() {
    let mut desk = Desk::new();
    desk.painted(2);
    desk.consumed(10, 40);
    desk.net.advance(5000 * MILLISECOND);
    let push = |desk: &mut Desk| {
        let request = Request::Command {
            node: PAINT_NODE.into(),
            command: undo(),
        };
        let now_ns = desk.net.bus().now_ns();
        desk.barrier.push(now_ns, (request, now_ns), []);
    };
    push(&mut desk);
    assert_eq!(desk.next_ready(), Some((undo(), Some(40))));
    desk.painted(41);
    push(&mut desk);
    assert_eq!(desk.next_ready(), Some((undo(), None)), "all is painted");
}

#[test]
fn a_brush_that_works_is_waited_for() {
    let mut desk = Desk::new();
    desk.push(undo(), 9);
    for next in 2..9 {
        desk.net.advance(900 * MILLISECOND);
        desk.consumed(next, next);
        assert_eq!(desk.next_ready(), None, "{next}");
    }
    desk.consumed(10, 40);
    assert_eq!(desk.next_ready(), Some((undo(), Some(40))));
}

#[test]
fn nobody_waits_for_a_brush_that_ended_nor_for_a_stylus_that_moves_none() {
    let mut desk = Desk::new();
    desk.push(undo(), 9);
    desk.net.advance(990 * MILLISECOND);
    assert_eq!(desk.next_ready(), None);
    desk.net.advance(20 * MILLISECOND);
    assert_eq!(desk.next_ready(), Some((undo(), None)));
    desk.push(undo(), 10);
    assert_eq!(desk.next_ready(), Some((undo(), None)), "once is enough");
    let stranger = SampleNumber {
        device: MOUSE + 1,
        epoch: 3,
        seq: 9,
    };
    let request = Request::Command {
        node: PAINT_NODE.into(),
        command: undo(),
    };
    desk.barrier
        .push(START_NS, (request.clone(), 0), [stranger]);
    assert_eq!(desk.barrier.next_ready(START_NS), Some(request.into()));
}
