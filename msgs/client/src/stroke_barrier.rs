//! Barrier that holds a command back until the stroke before it is painted. A key is pressed before the newest samples
//! of a stylus have become paint, and what it undoes or dries is the whole stroke.

use std::collections::{BTreeMap, VecDeque};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Wake};
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::{After, Command, FileCommand, PAINT_NODE};
use maulstick_types::name_hash;
use maulstick_types::paint::{BrushCredit, PaintConsumed};
use maulstick_types::wire::topics::Topics;

use crate::request::Request;

/// Longest wait without progress, ns: a brush node may have ended in its stroke.
const LONGEST_NS: u64 = 1_000_000_000;

/// Number of a sample of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleNumber {
    /// The source of its samples.
    pub device: u32,
    /// Its epoch.
    pub epoch: u32,
    /// Its number.
    pub seq: u64,
}

/// Progress of a sample toward the painting.
#[derive(Clone, Copy, Debug)]
enum SampleStage {
    /// It is to become a state of a brush.
    Sample(SampleNumber),
    /// It is in this state, which is to be painted: source, epoch and number.
    State(u32, u32, u64),
}

/// The process that is to work on a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Worker {
    /// A brush node, on the samples of a device.
    Brush {
        /// Source of the samples.
        device: u32,
    },
    /// The paint node, on the states of a brush.
    Paint {
        /// Source of the states.
        brush: u32,
    },
}

impl SampleStage {
    fn worker(&self) -> Worker {
        match self {
            Self::Sample(sample) => Worker::Brush {
                device: sample.device,
            },
            Self::State(brush, ..) => Worker::Paint { brush: *brush },
        }
    }
}

/// A request, and the samples it waits for.
#[derive(Debug)]
struct Waiting {
    request: Request,
    samples: Vec<SampleStage>,
    until_ns: u64,
    /// When it was asked for, ns.
    asked_ns: u64,
}

/// A request that may be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Ready {
    /// The request.
    pub request: Request,
    /// The state of a brush behind which the painting carries it out; at once if absent.
    pub after: Option<After>,
    /// Samples until then were made before it was asked for, rig clock, ns.
    pub asked_ns: u64,
}

/// Requests that wait for a stroke.
pub struct StrokeBarrier {
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
    pub fn new(bus: &dyn Bus, topics: &Topics) -> Result<Self, BusError> {
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

    /// Reads how far brushes and painting are; what a process works on is waited for longer.
    pub fn drain(&mut self, now_ns: u64) {
        let mut moved = Vec::new();
        while let Some(consumed) = self.consumed.try_recv() {
            let brush = self.topics.middle(&consumed.key).unwrap_or_default();
            let (key, next) = (
                (name_hash(brush), consumed.message.device),
                consumed.message.next,
            );
            let before = self.brushes.insert(key, consumed.message);
            if before.is_none_or(|before| before.next != next) {
                moved.push(Worker::Brush { device: key.1 });
            }
        }
        while let Some(painted) = self.painted.try_recv() {
            for credit in painted.message.brushes {
                let (brush, next) = (credit.brush, credit.next);
                let before = self.credits.insert(brush, credit);
                if before.is_none_or(|before| before.next != next) {
                    moved.push(Worker::Paint { brush });
                }
            }
        }
        for waiting in &mut self.waiting {
            let mut stages = waiting.samples.iter();
            if stages.any(|stage| moved.contains(&stage.worker())) {
                waiting.until_ns = now_ns.saturating_add(LONGEST_NS);
            }
        }
    }

    /// Takes a request made when these samples were the newest that came lately. Of a hand that rests no sample is
    /// new, and its stroke may wait to be painted all the same.
    pub fn push(
        &mut self,
        now_ns: u64,
        (request, asked_ns): (Request, u64),
        newest: impl IntoIterator<Item = SampleNumber>,
    ) {
        let follows = follows(&request);
        let newest = newest.into_iter().filter(|sample| {
            let mut followed = self.brushes.keys();
            follows && followed.any(|(_, device)| *device == sample.device)
        });
        let mut samples: Vec<SampleStage> = newest.map(SampleStage::Sample).collect();
        if follows {
            samples.extend(self.unpainted(&samples));
        }
        self.waiting.push_back(Waiting {
            request,
            samples,
            until_ns: now_ns.saturating_add(LONGEST_NS),
            asked_ns,
        });
    }

    /// Takes a request that follows one that is done, and so waits for no stroke.
    pub fn push_follow_up(&mut self, (request, asked_ns): (Request, u64)) {
        self.waiting.push_back(Waiting {
            request,
            samples: Vec::new(),
            until_ns: 0,
            asked_ns,
        });
    }

    /// When the oldest request that waits, and for which strokes wait, was asked for, ns.
    #[must_use]
    pub fn oldest_ns(&self) -> Option<u64> {
        let waiting = self.waiting.iter();
        let holding = waiting.filter(|waiting| waiting.request.precedes_strokes());
        holding.map(|waiting| waiting.asked_ns).min()
    }

    /// The newest state of each brush, where it is not painted yet; none of a brush that these samples move.
    fn unpainted(&self, samples: &[SampleStage]) -> Vec<SampleStage> {
        let is_moved = |brush: u32, device: u32| {
            let moves = |stage: &SampleStage| stage.worker() == Worker::Brush { device };
            self.brushes.contains_key(&(brush, device)) && samples.iter().any(moves)
        };
        let mut states = Vec::new();
        for credit in self.credits.values() {
            let own = self.brushes.iter().filter(|((brush, _), consumed)| {
                *brush == credit.brush && consumed.brush_epoch == credit.epoch
            });
            if own
                .clone()
                .any(|((brush, device), _)| is_moved(*brush, *device))
            {
                continue;
            }
            let newest = own.map(|(_, consumed)| consumed.state).max();
            let waits = newest.filter(|state| *state >= credit.next);
            states.extend(waits.map(|state| SampleStage::State(credit.brush, credit.epoch, state)));
        }
        states
    }

    /// The next request that need not wait; call it until there is none.
    pub fn next_ready(&mut self, now_ns: u64) -> Option<Ready> {
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
            asked_ns: waiting.asked_ns,
            request: waiting.request,
        })
    }

    /// True while a request waits.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }
}

impl Ready {
    /// When it was asked for, ns, if strokes wait for it.
    pub fn holds_strokes_ns(&self) -> Option<u64> {
        self.request.precedes_strokes().then_some(self.asked_ns)
    }
}

impl From<Request> for Ready {
    fn from(request: Request) -> Self {
        Self {
            request,
            after: None,
            asked_ns: 0,
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
        let for_paint =
            matches!(&self.request, Request::Command { node, .. } if node == PAINT_NODE);
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
        Request::Command { .. } => request.sets().is_none() || request.changes_brush(),
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
mod tests;
