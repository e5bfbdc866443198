//! What is asked after a stroke waits until the stroke has landed: a key is pressed sooner than the newest
//! samples of a stylus have become paint, and what it undoes or dries is the whole stroke.

use std::collections::{BTreeMap, VecDeque};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Class, Queue, Wake};
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::{After, Command};
use maulstick_types::name_hash;
use maulstick_types::paint::{BrushCredit, PaintConsumed};
use maulstick_types::topics::Topics;

use crate::rig::brushes::SampleNumber;
use crate::rig::requests::{Order, PAINT};

/// Nobody waits longer, ns: a brush may have ended in its stroke.
const LONGEST_NS: u64 = 1_000_000_000;

/// How far a sample has come on its way to the painting.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// It is to become a state of a brush.
    Sample(SampleNumber),
    /// It is in this state, which is to be painted: source, epoch and number.
    State(u32, u32, u64),
}

/// An order, and what it waits for.
#[derive(Debug)]
struct Waiting {
    order: Order,
    samples: Vec<Stage>,
    until_ns: u64,
}

/// An order that is sent.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Due {
    /// The order.
    pub order: Order,
    /// The state of a brush behind which the painting carries it out; at once if absent.
    pub after: Option<After>,
}

/// Orders that wait for a stroke.
pub(crate) struct Landing {
    topics: Topics,
    consumed: Receiver<BrushConsumed>,
    painted: Receiver<PaintConsumed>,
    /// What each brush has consumed of each device: by the sources of both.
    brushes: BTreeMap<(u32, u32), BrushConsumed>,
    /// What the painting has consumed of each brush.
    credits: BTreeMap<u32, BrushCredit>,
    waiting: VecDeque<Waiting>,
}

impl Landing {
    /// Listens to how far brushes and painting are.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(bus: &dyn Bus, topics: &Topics, wake: &Wake) -> Result<Self, BusError> {
        let (from_brush, from_paint) = (topics.brush_consumed("*"), topics.paint_consumed());
        Ok(Self {
            topics: topics.clone(),
            consumed: Receiver::new(bus, &from_brush, Class::Control, Queue::Ring(1024), wake)?,
            painted: Receiver::new(bus, &from_paint, Class::Control, Queue::Ring(16), wake)?,
            brushes: BTreeMap::new(),
            credits: BTreeMap::new(),
            waiting: VecDeque::new(),
        })
    }

    /// Takes in what has come.
    pub(crate) fn take_in(&mut self) {
        while let Some(consumed) = self.consumed.try_recv() {
            let brush = self.topics.middle(&consumed.key).unwrap_or_default();
            let key = (name_hash(brush), consumed.message.device);
            self.brushes.insert(key, consumed.message);
        }
        while let Some(painted) = self.painted.try_recv() {
            let brushes = painted.message.brushes.into_iter();
            self.credits
                .extend(brushes.map(|credit| (credit.brush, credit)));
        }
    }

    /// Takes an order that was given when these samples were the newest.
    pub(crate) fn give(
        &mut self,
        now_ns: u64,
        order: Order,
        newest: impl IntoIterator<Item = SampleNumber>,
    ) {
        let follows = follows(&order);
        let newest = newest.into_iter().filter(|sample| {
            let mut followed = self.brushes.keys();
            follows && followed.any(|(_, device)| *device == sample.device)
        });
        let samples = newest.map(Stage::Sample).collect();
        self.waiting.push_back(Waiting {
            order,
            samples,
            until_ns: now_ns.saturating_add(LONGEST_NS),
        });
    }

    /// The next order that need not wait; call it until there is none.
    pub(crate) fn due(&mut self, now_ns: u64) -> Option<Due> {
        for waiting in &mut self.waiting {
            waiting
                .samples
                .retain_mut(|stage| !landed(stage, &self.brushes, &self.credits));
        }
        let place = (0..self.waiting.len()).find(|place| {
            let waiting = &self.waiting[*place];
            let mut before = self.waiting.iter().take(*place);
            let ready = waiting.is_ready() || now_ns >= waiting.until_ns;
            ready && !before.any(|before| before.shares(&waiting.order))
        })?;
        let waiting = self.waiting.remove(place)?;
        if !waiting.is_ready() {
            // Who has not followed these devices for so long is not waited for again.
            for stage in &waiting.samples {
                if let Stage::Sample(sample) = stage {
                    self.brushes
                        .retain(|(_, device), _| *device != sample.device);
                }
            }
        }
        Some(Due {
            after: waiting.after(),
            order: waiting.order,
        })
    }

    /// Whether an order waits.
    #[must_use]
    pub(crate) fn holds(&self) -> bool {
        !self.waiting.is_empty()
    }
}

impl From<Order> for Due {
    fn from(order: Order) -> Self {
        Self { order, after: None }
    }
}

impl Waiting {
    /// Whether it may be sent: the painting knows what the one state is that it still waits for.
    fn is_ready(&self) -> bool {
        self.samples.is_empty() || self.after().is_some()
    }

    /// The state behind which it takes its place.
    fn after(&self) -> Option<After> {
        let for_paint = matches!(&self.order, Order::Command { node, .. } if node == PAINT);
        match self.samples[..] {
            [Stage::State(brush, epoch, sequence)] if for_paint => Some(After {
                brush,
                epoch,
                sequence,
            }),
            _ => None,
        }
    }

    /// Whether another order is for the same process: none overtakes.
    fn shares(&self, other: &Order) -> bool {
        match (&self.order, other) {
            (Order::Command { node: one, .. }, Order::Command { node: other, .. }) => one == other,
            _ => false,
        }
    }
}

/// Whether an order means what has been painted.
fn follows(order: &Order) -> bool {
    match order {
        Order::Command {
            command: Command::StopExport,
            ..
        }
        | Order::Force { .. } => false,
        Order::Command { .. } => order.sets().is_none(),
    }
}

/// Follows a sample; whether it is painted.
fn landed(
    stage: &mut Stage,
    brushes: &BTreeMap<(u32, u32), BrushConsumed>,
    credits: &BTreeMap<u32, BrushCredit>,
) -> bool {
    if let Stage::Sample(sample) = *stage {
        let holds = |consumed: &BrushConsumed| {
            (consumed.device, consumed.device_epoch) == (sample.device, sample.epoch)
                && consumed.next > sample.seq
        };
        let state = brushes.iter().find(|(_, consumed)| holds(consumed));
        let Some(((brush, _), consumed)) = state else {
            return false;
        };
        *stage = Stage::State(*brush, consumed.brush_epoch, consumed.state);
    }
    let Stage::State(brush, epoch, state) = *stage else {
        return false;
    };
    let credit = credits.get(&brush);
    credit.is_some_and(|credit| credit.epoch == epoch && credit.next > state)
}

impl std::fmt::Debug for Landing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Landing")
            .field("waiting", &self.waiting)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::typed::Sender;
    use maulstick_bus::{Faults, MemoryNet};
    use maulstick_types::{Origin, Pose};

    use super::*;

    const MILLISECOND: u64 = 1_000_000;
    const START_NS: u64 = MILLISECOND;
    const MOUSE: u32 = 77;
    const BRUSH: &str = "main";

    /// A brush, a painting, and orders between them.
    struct Desk {
        net: MemoryNet,
        landing: Landing,
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
            let landing = Landing::new(&bus, &topics, &Wake::new()).expect("listens");
            let topic = topics.brush_consumed(BRUSH);
            let brush = Sender::new(&bus, &topic, Class::Control, me(BRUSH)).expect("sends");
            let topic = topics.paint_consumed();
            let paint = Sender::new(&bus, &topic, Class::Control, me(PAINT)).expect("sends");
            let mut desk = Self {
                landing,
                brush,
                paint,
                net,
            };
            desk.consumed(1, 1);
            desk
        }

        fn pass(&mut self) {
            self.net.advance(10 * MILLISECOND);
            self.landing.take_in();
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
            };
            let painted = PaintConsumed {
                brushes: vec![credit],
            };
            self.paint.send(0, 0, &painted).expect("sent");
            self.pass();
        }

        fn give(&mut self, command: Command, seq: u64) {
            let order = Order::Command {
                node: PAINT.into(),
                command,
            };
            let sample = SampleNumber {
                device: MOUSE,
                epoch: 3,
                seq,
            };
            let now_ns = self.net.bus().now_ns();
            self.landing.give(now_ns, order, [sample]);
        }

        /// The next command, and the state that it goes behind.
        fn due(&mut self) -> Option<(Command, Option<u64>)> {
            let now_ns = self.net.bus().now_ns();
            let due = self.landing.due(now_ns)?;
            let after = due.after.map(|after| {
                assert_eq!((after.brush, after.epoch), (name_hash(BRUSH), 5));
                after.sequence
            });
            match due.order {
                Order::Command { command, .. } => Some((command, after)),
                other @ Order::Force { .. } => panic!("{other:?}"),
            }
        }
    }

    const UNDO: Command = Command::Undo { brush: None };

    fn place() -> Command {
        Command::Place {
            surface: 0,
            pose: Pose::IDENTITY,
            zoom: 1.0,
        }
    }

    #[test]
    fn an_undo_goes_right_behind_the_stroke_before_it() {
        let mut desk = Desk::new();
        desk.painted(2);
        desk.give(UNDO, 9);
        assert_eq!(desk.due(), None, "the brush has not consumed it");
        desk.consumed(9, 20);
        desk.painted(30);
        assert_eq!(desk.due(), None, "nor the last of its samples");
        desk.consumed(10, 40);
        assert_eq!(desk.due(), Some((UNDO, Some(40))));
        assert!(!desk.landing.holds());
        desk.give(UNDO, 9);
        desk.painted(41);
        assert_eq!(desk.due(), Some((UNDO, None)), "it is painted");
    }

    #[test]
    fn another_node_is_asked_when_the_stroke_is_painted() {
        let mut desk = Desk::new();
        let order = Order::Command {
            node: "rig".into(),
            command: UNDO,
        };
        let sample = SampleNumber {
            device: MOUSE,
            epoch: 3,
            seq: 9,
        };
        desk.landing.give(START_NS, order.clone(), [sample]);
        desk.consumed(10, 40);
        // What is painted later does not hold it up.
        assert_eq!(desk.landing.due(START_NS), None);
        desk.consumed(30, 90);
        desk.painted(40);
        assert_eq!(desk.landing.due(START_NS), None);
        desk.painted(41);
        assert_eq!(desk.landing.due(START_NS), Some(order.into()));
    }

    #[test]
    fn a_canvas_moves_at_once_but_overtakes_nothing() {
        let mut desk = Desk::new();
        desk.give(place(), 9);
        assert_eq!(desk.due(), Some((place(), None)));
        desk.give(UNDO, 9);
        desk.give(place(), 20);
        assert_eq!(desk.due(), None);
        desk.consumed(10, 4);
        let due = [desk.due(), desk.due()];
        assert_eq!(due, [Some((UNDO, Some(4))), Some((place(), None))]);
    }

    #[test]
    fn nobody_waits_for_a_brush_that_ended_nor_for_a_stylus_that_moves_none() {
        let mut desk = Desk::new();
        desk.give(UNDO, 9);
        desk.net.advance(990 * MILLISECOND);
        assert_eq!(desk.due(), None);
        desk.net.advance(20 * MILLISECOND);
        assert_eq!(desk.due(), Some((UNDO, None)));
        desk.give(UNDO, 10);
        assert_eq!(desk.due(), Some((UNDO, None)), "once is enough");
        let stranger = SampleNumber {
            device: MOUSE + 1,
            epoch: 3,
            seq: 9,
        };
        let order = Order::Command {
            node: PAINT.into(),
            command: UNDO,
        };
        desk.landing.give(START_NS, order.clone(), [stranger]);
        assert_eq!(desk.landing.due(START_NS), Some(order.into()));
    }
}
