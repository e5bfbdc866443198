//! The receiving end of a stream with credit.
//!
//! A live gap is given up after a while, for a painter does not wait; a replayed one never, for a
//! painting with a hole is another painting.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use maulstick_types::command::GapRequest;
use maulstick_types::topics::Topics;
use maulstick_types::{Flags, Message, Origin, encode};

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

/// Hands on the messages of every sender that matches a topic, each sender's in order.
pub struct CreditReceiver<M> {
    subscription: Subscription,
    topics: Topics,
    me: Origin,
    wake: Wake,
    reader: Reader,
    streams: BTreeMap<Origin, Stream<M>>,
    ready: VecDeque<Received<M>>,
    counts: ReceiverCounts,
    again: Vec<Origin>,
}

/// One sender since its start.
struct Stream<M> {
    topic: String,
    /// Number of the next message to hand on; none while the beginning of a replay is sought.
    next: Option<u64>,
    held: BTreeMap<u64, Received<M>>,
    /// The newest questions for the gap; an answer to any of them will do.
    asked: VecDeque<Pending>,
    asked_ns: u64,
    askings: u32,
    replay: bool,
}

/// So many questions for one gap are open at a time.
const OPEN_QUESTIONS: usize = 8;

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
            ready: VecDeque::new(),
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
            self.take_in(&arrival.key, arrival.arrived_ns, &arrival.bytes, false);
        }
        let origins: Vec<Origin> = self.streams.keys().copied().collect();
        for origin in origins {
            self.chase(bus, origin, now_ns)?;
        }
        self.counts.refused = self.reader.refused();
        Ok(())
    }

    /// The next message in order.
    pub fn pop(&mut self) -> Option<Received<M>> {
        let next = self.ready.pop_front();
        self.counts.received += u64::from(next.is_some());
        next
    }

    /// The message that [`pop`](Self::pop) would give.
    #[must_use]
    pub fn peek(&self) -> Option<&Received<M>> {
        self.ready.front()
    }

    /// How many messages wait in order.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.ready.len()
    }

    /// Senders whose newest message came once more: they have not heard of its consumption.
    pub fn unheard(&mut self) -> Vec<Origin> {
        std::mem::take(&mut self.again)
    }

    /// What has been seen so far.
    #[must_use]
    pub fn counts(&self) -> ReceiverCounts {
        self.counts
    }

    /// Whether a gap is being sought.
    #[must_use]
    pub fn seeking(&self) -> bool {
        self.streams.values().any(|stream| !stream.held.is_empty())
    }

    fn take_in(&mut self, key: &str, arrived_ns: u64, bytes: &[u8], recovered: bool) {
        let Some((header, message)) = self.reader.read::<M>(key, bytes) else {
            return;
        };
        let origin = header.origin();
        let replay = header.flags.has(Flags::REPLAY);
        let first = header.flags.has(Flags::FIRST);
        if !self.streams.contains_key(&origin) {
            // The sender has started anew: what is left of its stream before means nothing now.
            self.streams
                .retain(|other, _| other.source != origin.source);
            self.ready
                .retain(|left| left.header.source != origin.source);
            let next = (first || !replay).then_some(header.seq);
            let topic = key.to_owned();
            let stream = Stream {
                topic,
                next,
                held: BTreeMap::new(),
                asked: VecDeque::new(),
                asked_ns: 0,
                askings: 0,
                replay,
            };
            self.streams.insert(origin, stream);
        }
        let Some(stream) = self.streams.get_mut(&origin) else {
            return;
        };
        if stream.next.is_none() && first {
            stream.next = Some(header.seq);
            stream.held = stream.held.split_off(&header.seq);
        }
        if stream.next.is_some_and(|next| header.seq < next) {
            if !recovered && stream.next == Some(header.seq + 1) {
                self.again.push(origin);
            }
            return;
        }
        let seq = header.seq;
        let received = Received {
            key: key.to_owned(),
            arrived_ns,
            header,
            message,
        };
        if stream.held.insert(seq, received).is_none() && recovered {
            self.counts.recovered += 1;
        }
        stream.release(&mut self.ready);
    }

    /// Follows up on a stream's gap.
    fn chase(&mut self, bus: &dyn Bus, origin: Origin, now_ns: u64) -> Result<(), BusError> {
        let Some(stream) = self.streams.get_mut(&origin) else {
            return Ok(());
        };
        let mut answers = Vec::new();
        for pending in &stream.asked {
            while let Some(Answer::Bytes(bytes)) = pending.try_recv() {
                answers.push(bytes);
            }
        }
        let topic = stream.topic.clone();
        for answer in &answers {
            for message in split_messages(answer) {
                self.take_in(&topic, now_ns, message, true);
            }
        }
        let Some(stream) = self.streams.get_mut(&origin) else {
            return Ok(());
        };
        let Some((&seen, _)) = stream.held.first_key_value() else {
            stream.asked.clear();
            stream.askings = 0;
            return Ok(());
        };
        let waits = !stream.asked.is_empty() && now_ns < stream.asked_ns + RETRY_NS;
        if waits && answers.is_empty() {
            return Ok(());
        }
        if stream.askings >= PATIENCE && !stream.replay {
            let from = stream.next.unwrap_or(seen);
            tracing::warn!("{topic}: messages {from} to {seen} are lost");
            self.counts.lost += seen - from;
            stream.next = Some(seen);
            stream.askings = 0;
            stream.asked.clear();
            stream.release(&mut self.ready);
            return Ok(());
        }
        let from = stream.next.unwrap_or(seen.saturating_sub(WINDOW));
        if from == seen {
            stream.next = Some(seen);
            stream.release(&mut self.ready);
            return Ok(());
        }
        let request = GapRequest {
            epoch: origin.epoch,
            from,
            to: seen - 1,
        };
        let gap_topic = self
            .topics
            .gap(self.topics.relative(&topic).unwrap_or(&topic));
        let bytes =
            encode(&self.me, Flags::NONE, 0, now_ns, now_ns, &request).map_err(|source| {
                BusError::Message {
                    topic: gap_topic.clone(),
                    source,
                }
            })?;
        let limit = Duration::from_nanos(RETRY_NS * OPEN_QUESTIONS as u64);
        if stream.asked.len() == OPEN_QUESTIONS {
            stream.asked.pop_front();
        }
        stream
            .asked
            .push_back(bus.ask(&gap_topic, bytes, limit, &self.wake)?);
        stream.asked_ns = now_ns;
        stream.askings += 1;
        Ok(())
    }
}

impl<M> Stream<M> {
    /// Moves what is in order to `ready`.
    fn release(&mut self, ready: &mut VecDeque<Received<M>>) {
        while let Some(next) = self.next {
            let Some(received) = self.held.remove(&next) else {
                return;
            };
            ready.push_back(received);
            self.next = Some(next + 1);
        }
    }
}

impl<M> std::fmt::Debug for CreditReceiver<M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CreditReceiver")
            .field("counts", &self.counts)
            .finish_non_exhaustive()
    }
}
