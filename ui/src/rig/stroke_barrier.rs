//! Delays a command until the stroke that preceded it is painted. A key is pressed before the newest samples
//! of a stylus have become paint, and what it undoes or dries is the whole stroke.

use std::collections::{BTreeMap, VecDeque};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::{After, Command, FileCommand};
use maulstick_types::name_hash;
use maulstick_types::paint::{BrushCredit, PaintConsumed};
use maulstick_types::wire::topics::Topics;

use crate::rig::brushes::SampleNumber;
use crate::rig::requests::{PAINT, Request};

/// Longest wait, ns: a brush node may have ended in its stroke.
const LONGEST_NS: u64 = 1_000_000_000;

/// Progress of a sample toward the painting.
#[derive(Clone, Copy, Debug)]
enum SampleStage {
    /// It is to become a state of a brush.
    Sample(SampleNumber),
    /// It is in this state, which is to be painted: source, epoch and number.
    State(u32, u32, u64),
}

/// A request, and the samples it waits for.
#[derive(Debug)]
struct Waiting {
    request: Request,
    samples: Vec<SampleStage>,
    until_ns: u64,
}

/// A request that may be sent.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ready {
    /// The request.
    pub request: Request,
    /// The state of a brush behind which the painting carries it out; at once if absent.
    pub after: Option<After>,
}

/// Requests that wait for a stroke.
pub(crate) struct StrokeBarrier {
    topics: Topics,
    consumed: Receiver<BrushConsumed>,
    painted: Receiver<PaintConsumed>,
    /// Samples of each device that each brush has consumed: by the sources of both.
    brushes: BTreeMap<(u32, u32), BrushConsumed>,
    /// States of each brush that the painting has consumed.
    credits: BTreeMap<u32, BrushCredit>,
    waiting: VecDeque<Waiting>,
}

impl StrokeBarrier {
    /// Listens to how far brushes and painting are; nothing is signalled, for they say it with every sample.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(bus: &dyn Bus, topics: &Topics) -> Result<Self, BusError> {
        let (from_brush, from_paint) = (topics.brush_consumed("*"), topics.paint_consumed());
        let silent = Wake::new();
        Ok(Self {
            topics: topics.clone(),
            consumed: Receiver::new(bus, &from_brush, Qos::Control, Queue::Ring(1024), &silent)?,
            painted: Receiver::new(bus, &from_paint, Qos::Control, Queue::Ring(16), &silent)?,
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

    /// Takes a request made when these samples were the newest.
    pub(crate) fn push(
        &mut self,
        now_ns: u64,
        request: Request,
        newest: impl IntoIterator<Item = SampleNumber>,
    ) {
        let follows = follows(&request);
        let newest = newest.into_iter().filter(|sample| {
            let mut followed = self.brushes.keys();
            follows && followed.any(|(_, device)| *device == sample.device)
        });
        let samples = newest.map(SampleStage::Sample).collect();
        self.waiting.push_back(Waiting {
            request,
            samples,
            until_ns: now_ns.saturating_add(LONGEST_NS),
        });
    }

    /// The next request that need not wait; call it until there is none.
    pub(crate) fn next_ready(&mut self, now_ns: u64) -> Option<Ready> {
        for waiting in &mut self.waiting {
            waiting
                .samples
                .retain_mut(|stage| !is_painted(stage, &self.brushes, &self.credits));
        }
        let place = (0..self.waiting.len()).find(|place| {
            let waiting = &self.waiting[*place];
            let mut before = self.waiting.iter().take(*place);
            let ready = waiting.is_ready() || now_ns >= waiting.until_ns;
            ready && !before.any(|before| before.shares(&waiting.request))
        })?;
        let waiting = self.waiting.remove(place)?;
        if !waiting.is_ready() {
            // A brush that has not followed these devices for so long is not waited for again.
            for stage in &waiting.samples {
                if let SampleStage::Sample(sample) = stage {
                    self.brushes
                        .retain(|(_, device), _| *device != sample.device);
                }
            }
        }
        Some(Ready {
            after: waiting.after(),
            request: waiting.request,
        })
    }

    /// True while a request waits.
    #[must_use]
    pub(crate) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }
}

impl From<Request> for Ready {
    fn from(request: Request) -> Self {
        Self {
            request,
            after: None,
        }
    }
}

impl Waiting {
    /// True if it may be sent: the painting has consumed the state that it still waits for.
    fn is_ready(&self) -> bool {
        self.samples.is_empty() || self.after().is_some()
    }

    /// The state behind which it takes its place.
    fn after(&self) -> Option<After> {
        let for_paint = matches!(&self.request, Request::Command { node, .. } if node == PAINT);
        match self.samples[..] {
            [SampleStage::State(brush, epoch, sequence)] if for_paint => Some(After {
                brush,
                epoch,
                sequence,
            }),
            _ => None,
        }
    }

    /// True if another request is for the same process: none overtakes.
    fn shares(&self, other: &Request) -> bool {
        match (&self.request, other) {
            (Request::Command { node: one, .. }, Request::Command { node: other, .. }) => {
                one == other
            }
            _ => false,
        }
    }
}

/// True for a request that depends on the strokes painted before it.
fn follows(request: &Request) -> bool {
    match request {
        Request::Command {
            command: Command::File(FileCommand::StopExport),
            ..
        }
        | Request::Force { .. } => false,
        Request::Command { .. } => request.sets().is_none(),
    }
}

/// Follows a sample; whether it is painted.
fn is_painted(
    stage: &mut SampleStage,
    brushes: &BTreeMap<(u32, u32), BrushConsumed>,
    credits: &BTreeMap<u32, BrushCredit>,
) -> bool {
    if let SampleStage::Sample(sample) = *stage {
        let is_waiting = |consumed: &BrushConsumed| {
            (consumed.device, consumed.device_epoch) == (sample.device, sample.epoch)
                && consumed.next > sample.seq
        };
        let state = brushes.iter().find(|(_, consumed)| is_waiting(consumed));
        let Some(((brush, _), consumed)) = state else {
            return false;
        };
        *stage = SampleStage::State(*brush, consumed.brush_epoch, consumed.state);
    }
    let SampleStage::State(brush, epoch, state) = *stage else {
        return false;
    };
    let credit = credits.get(&brush);
    credit.is_some_and(|credit| credit.epoch == epoch && credit.next > state)
}

#[cfg(test)]
mod tests {
    use maulstick_bus::typed::Sender;
    use maulstick_bus::{Faults, MemoryNet};
    use maulstick_types::edits::Edit;
    use maulstick_types::edits::{Place, Undo};
    use maulstick_types::{Origin, Pose};

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
            let paint = Sender::new(&bus, &topic, Qos::Control, me(PAINT)).expect("sends");
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
            self.barrier.take_in();
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

        fn push(&mut self, command: Command, seq: u64) {
            let request = Request::Command {
                node: PAINT.into(),
                command,
            };
            let sample = SampleNumber {
                device: MOUSE,
                epoch: 3,
                seq,
            };
            let now_ns = self.net.bus().now_ns();
            self.barrier.push(now_ns, request, [sample]);
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

    const UNDO: Command = Command::Edit(Edit::Undo(Undo { brush: None }));

    fn place() -> Command {
        Command::from(Place::new(0, Pose::IDENTITY, 1.0).expect("in reach"))
    }

    #[test]
    fn an_undo_goes_right_behind_the_stroke_before_it() {
        let mut desk = Desk::new();
        desk.painted(2);
        desk.push(UNDO, 9);
        assert_eq!(desk.next_ready(), None, "the brush has not consumed it");
        desk.consumed(9, 20);
        desk.painted(30);
        assert_eq!(desk.next_ready(), None, "nor the last of its samples");
        desk.consumed(10, 40);
        assert_eq!(desk.next_ready(), Some((UNDO, Some(40))));
        assert!(!desk.barrier.is_waiting());
        desk.push(UNDO, 9);
        desk.painted(41);
        assert_eq!(desk.next_ready(), Some((UNDO, None)), "it is painted");
    }

    #[test]
    fn another_node_is_asked_when_the_stroke_is_painted() {
        let mut desk = Desk::new();
        let request = Request::Command {
            node: "rig".into(),
            command: UNDO,
        };
        let sample = SampleNumber {
            device: MOUSE,
            epoch: 3,
            seq: 9,
        };
        desk.barrier.push(START_NS, request.clone(), [sample]);
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
        desk.push(UNDO, 9);
        desk.push(place(), 20);
        assert_eq!(desk.next_ready(), None);
        desk.consumed(10, 4);
        let next_ready = [desk.next_ready(), desk.next_ready()];
        assert_eq!(next_ready, [Some((UNDO, Some(4))), Some((place(), None))]);
    }

    #[test]
    fn nobody_waits_for_a_brush_that_ended_nor_for_a_stylus_that_moves_none() {
        let mut desk = Desk::new();
        desk.push(UNDO, 9);
        desk.net.advance(990 * MILLISECOND);
        assert_eq!(desk.next_ready(), None);
        desk.net.advance(20 * MILLISECOND);
        assert_eq!(desk.next_ready(), Some((UNDO, None)));
        desk.push(UNDO, 10);
        assert_eq!(desk.next_ready(), Some((UNDO, None)), "once is enough");
        let stranger = SampleNumber {
            device: MOUSE + 1,
            epoch: 3,
            seq: 9,
        };
        let request = Request::Command {
            node: PAINT.into(),
            command: UNDO,
        };
        desk.barrier.push(START_NS, request.clone(), [stranger]);
        assert_eq!(desk.barrier.next_ready(START_NS), Some(request.into()));
    }
}
