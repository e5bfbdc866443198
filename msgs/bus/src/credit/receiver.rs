//! The receiving end of a stream with credit.
//!
//! A live gap is given up after a while, for a painter does not wait; a replayed one never, for a
//! painting with a hole is another painting.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use maulstick_types::command::GapRequest;
use maulstick_types::topics::Topics;
use maulstick_types::{Flags, Header, Message, Origin, encode};

use super::sender::split_messages;
use super::{PATIENCE, RETRY_NS, RING, WINDOW};
use crate::bus::{Answer, Bus, BusError, Class, Pending, Subscription};
use crate::inbox::{Queue, Wake};
use crate::typed::{Reader, Received};

/// What a receiver has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReceiverCounts {
    /// Messages handed on.
    pub received: u64,
    /// Messages that came only after asking again.
    pub recovered: u64,
    /// Messages that were given up.
    pub lost: u64,
    /// Messages that did not decode.
    pub refused: u64,
}

/// Hands on the messages of every sender that matches a topic, each sender's in order; no sender
/// waits for another.
pub struct CreditReceiver<M> {
    subscription: Subscription,
    topics: Topics,
    me: Origin,
    wake: Wake,
    reader: Reader,
    streams: BTreeMap<StreamKey, Stream<M>>,
    /// Messages put in order so far.
    ordered: u64,
    counts: ReceiverCounts,
    again: Vec<String>,
}

/// Topic and source. A topic is one device's or brush's; sources are numbers that anyone chooses,
/// so two devices may have the same one, and a stray sender does not take a topic over.
type StreamKey = (String, u32);

/// One sender since its start.
struct Stream<M> {
    epoch: u32,
    /// When the first message seen of this epoch was sent, rig clock, ns.
    began_ns: u64,
    /// Earlier epochs, whose late messages mean nothing, oldest first.
    superseded: VecDeque<u32>,
    /// Number of the next message to hand on; none while the beginning of a replay is sought.
    next: Option<u64>,
    held: BTreeMap<u64, Received<M>>,
    /// In order, each with its place among those of all senders.
    ready: VecDeque<(u64, Received<M>)>,
    /// The newest questions for the gap; an answer to any of them will do.
    asked: VecDeque<Pending>,
    asked_ns: u64,
    /// Questions for the gap that begins at `next`.
    askings: u32,
    /// Whether the newest message in order is played from a take.
    replay: bool,
}

/// How a message came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// As it was sent.
    Sent,
    /// In the answer to a question for a gap.
    AskedFor,
}

/// Messages from the first up to, but not with, the second number are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Gap {
    from: u64,
    seen: u64,
}

/// So many questions for one gap are open at a time.
const OPEN_QUESTIONS: usize = 8;
/// So many epochs of a sender are remembered.
const EPOCHS: usize = 16;
/// A stream keeps at most this many messages that nobody takes; its sender's ring has the rest.
const KEPT: usize = 2 * RING;

impl<M: Message> CreditReceiver<M> {
    /// Subscribes; `me` names the receiver in its queries.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        topic: &str,
        me: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        Ok(Self {
            subscription: bus.subscribe(topic, Class::RealTime, Queue::Ring(RING), wake)?,
            topics: topics.clone(),
            me,
            wake: wake.clone(),
            reader: Reader::default(),
            streams: BTreeMap::new(),
            ordered: 0,
            counts: ReceiverCounts::default(),
            again: Vec::new(),
        })
    }

    /// Takes in what has arrived and asks for what is missing.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn poll(&mut self, bus: &dyn Bus) -> Result<(), BusError> {
        let now_ns = bus.now_ns();
        while let Some(arrival) = self.subscription.try_recv() {
            self.take_in(&arrival.key, arrival.arrived_ns, &arrival.bytes, Way::Sent);
        }
        let keys: Vec<StreamKey> = self.streams.keys().cloned().collect();
        for key in keys {
            self.chase(bus, &key, now_ns)?;
        }
        self.counts.refused = self.reader.refused();
        Ok(())
    }

    /// The next message in order.
    pub fn pop(&mut self) -> Option<Received<M>> {
        self.pop_where(|_| true)
    }

    /// The next message that may go: of the first in order of each sender the one that came in
    /// order first. What may not go holds up its own sender alone.
    pub fn pop_where(
        &mut self,
        mut may_go: impl FnMut(&Received<M>) -> bool,
    ) -> Option<Received<M>> {
        let stream = self
            .streams
            .values_mut()
            .filter(|stream| stream.ready.front().is_some_and(|(_, head)| may_go(head)))
            .min_by_key(|stream| stream.ready.front().map(|(place, _)| *place))?;
        let (_, next) = stream.ready.pop_front()?;
        self.counts.received += 1;
        Some(next)
    }

    /// The first message in order of each sender.
    pub fn heads(&self) -> impl Iterator<Item = &Received<M>> {
        self.streams
            .values()
            .filter_map(|stream| stream.ready.front().map(|(_, head)| head))
    }

    /// Topics whose newest message came once more: their senders have not heard of its consumption.
    pub fn unheard(&mut self) -> Vec<String> {
        std::mem::take(&mut self.again)
    }

    /// What has been seen so far.
    #[must_use]
    pub fn counts(&self) -> ReceiverCounts {
        self.counts
    }

    fn take_in(&mut self, topic: &str, arrived_ns: u64, bytes: &[u8], way: Way) {
        let Some((header, message)) = self.reader.read::<M>(topic, bytes) else {
            return;
        };
        let stream = self
            .streams
            .entry((topic.to_owned(), header.source))
            .or_insert_with(|| Stream::begin(&header));
        if !stream.belongs(&header) {
            return;
        }
        if stream.next.is_none() && header.flags.has(Flags::FIRST) {
            stream.next = Some(header.seq);
            stream.held = stream.held.split_off(&header.seq);
        }
        if stream.next.is_some_and(|next| header.seq < next) {
            if way == Way::Sent && stream.next == Some(header.seq.wrapping_add(1)) {
                self.again.push(topic.to_owned());
            }
            return;
        }
        if stream.held.len() + stream.ready.len() >= KEPT && stream.next != Some(header.seq) {
            return;
        }
        let seq = header.seq;
        let received = Received {
            key: topic.to_owned(),
            arrived_ns,
            header,
            message,
        };
        if stream.held.insert(seq, received).is_none() && way == Way::AskedFor {
            self.counts.recovered += 1;
        }
        stream.release(&mut self.ordered);
    }

    /// Follows up on a stream's gap.
    fn chase(&mut self, bus: &dyn Bus, key: &StreamKey, now_ns: u64) -> Result<(), BusError> {
        let answered = self.take_answers(key, now_ns);
        let Some(stream) = self.streams.get_mut(key) else {
            return Ok(());
        };
        let Some(gap) = stream.gap(&mut self.ordered) else {
            stream.asked.clear();
            stream.askings = 0;
            return Ok(());
        };
        let waits = !stream.asked.is_empty() && now_ns < stream.asked_ns + RETRY_NS;
        if waits && answered == 0 {
            return Ok(());
        }
        if stream.askings >= PATIENCE && !stream.is_replayed() {
            self.counts.lost += stream.give_up(gap, &mut self.ordered);
            tracing::warn!(
                "{}: messages {} to {} are lost",
                key.0,
                gap.from,
                gap.seen - 1
            );
            return Ok(());
        }
        self.ask(bus, key, gap, now_ns)
    }

    /// Takes in what came for a stream's gap; how many answers there were.
    fn take_answers(&mut self, key: &StreamKey, now_ns: u64) -> usize {
        let Some(stream) = self.streams.get(key) else {
            return 0;
        };
        let mut answers = Vec::new();
        for pending in &stream.asked {
            while let Some(Answer::Bytes(bytes)) = pending.try_recv() {
                answers.push(bytes);
            }
        }
        for message in answers.iter().flat_map(|answer| split_messages(answer)) {
            self.take_in(&key.0, now_ns, message, Way::AskedFor);
        }
        answers.len()
    }

    /// Asks a stream's sender for what is missing.
    fn ask(
        &mut self,
        bus: &dyn Bus,
        key: &StreamKey,
        gap: Gap,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let Some(stream) = self.streams.get_mut(key) else {
            return Ok(());
        };
        let request = GapRequest {
            epoch: stream.epoch,
            from: gap.from,
            to: gap.seen - 1,
        };
        let topic = self
            .topics
            .gap(self.topics.relative(&key.0).unwrap_or(&key.0));
        let bytes =
            encode(&self.me, Flags::NONE, 0, now_ns, now_ns, &request).map_err(|source| {
                BusError::Message {
                    topic: topic.clone(),
                    source,
                }
            })?;
        let limit = Duration::from_nanos(RETRY_NS * OPEN_QUESTIONS as u64);
        if stream.asked.len() == OPEN_QUESTIONS {
            stream.asked.pop_front();
        }
        stream
            .asked
            .push_back(bus.ask(&topic, Class::Control, bytes, limit, &self.wake)?);
        stream.asked_ns = now_ns;
        stream.askings += 1;
        Ok(())
    }
}

impl<M> Stream<M> {
    fn begin(header: &Header) -> Self {
        let replay = header.flags.has(Flags::REPLAY);
        let first = header.flags.has(Flags::FIRST);
        Self {
            epoch: header.epoch,
            began_ns: header.sent_ns,
            superseded: VecDeque::new(),
            next: (first || !replay).then_some(header.seq),
            held: BTreeMap::new(),
            ready: VecDeque::new(),
            asked: VecDeque::new(),
            asked_ns: 0,
            askings: 0,
            replay,
        }
    }

    /// Whether a message is of this stream, or of one that begins with it: then the sender has
    /// started anew, and what is left of its stream before means nothing now. A late message of a
    /// stream before is of neither.
    fn belongs(&mut self, header: &Header) -> bool {
        if header.epoch == self.epoch {
            return true;
        }
        let earlier = !header.flags.has(Flags::FIRST) && header.sent_ns < self.began_ns;
        if earlier || self.superseded.contains(&header.epoch) {
            return false;
        }
        let mut superseded = std::mem::take(&mut self.superseded);
        if superseded.len() == EPOCHS {
            superseded.pop_front();
        }
        superseded.push_back(self.epoch);
        *self = Self::begin(header);
        self.superseded = superseded;
        true
    }

    /// Moves what is in order to `ready`.
    fn release(&mut self, ordered: &mut u64) {
        while let Some(next) = self.next {
            let Some(received) = self.held.remove(&next) else {
                return;
            };
            self.replay = received.header.flags.has(Flags::REPLAY);
            self.askings = 0;
            self.ready.push_back((*ordered, received));
            *ordered += 1;
            self.next = Some(next.wrapping_add(1));
        }
    }

    /// Whether a take is played on either side of the gap: live and played messages of a brush are
    /// one stream.
    fn is_replayed(&self) -> bool {
        let behind = self.held.first_key_value();
        self.replay || behind.is_some_and(|(_, held)| held.header.flags.has(Flags::REPLAY))
    }

    /// What is missing before the first message held.
    fn gap(&mut self, ordered: &mut u64) -> Option<Gap> {
        let (&seen, _) = self.held.first_key_value()?;
        let from = self.next.unwrap_or(seen.saturating_sub(WINDOW));
        if from == seen {
            self.next = Some(seen);
            self.release(ordered);
            return None;
        }
        Some(Gap { from, seen })
    }

    /// Goes on behind a gap; returns how many messages are lost in it.
    fn give_up(&mut self, gap: Gap, ordered: &mut u64) -> u64 {
        self.next = Some(gap.seen);
        self.askings = 0;
        self.asked.clear();
        self.release(ordered);
        gap.seen - gap.from
    }
}

impl<M> std::fmt::Debug for CreditReceiver<M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CreditReceiver")
            .field("counts", &self.counts)
            .finish_non_exhaustive()
    }
}
