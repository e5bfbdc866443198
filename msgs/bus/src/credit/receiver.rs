//! The receiving end of a stream with credit.
//!
//! A live gap is given up after a while, for a painter does not wait, and at once where its sender answers for none; a
//! replayed one never, for a painting with a hole is another painting.

use std::collections::BTreeMap;
use std::time::Duration;

use maulstick_types::command::GapRequest;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Message, Origin, encode};

use super::sender::split_messages;
use super::stream::{Gap, Stream, Taken};
use super::{PATIENCE, RETRY_NS, RING};
use crate::bus::{Answer, Bus, BusError, Qos, Subscription};
use crate::inbox::{Queue, Wake};
use crate::typed::{Reader, Reason, Received};

/// Counts of a receiver.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReceiverCounts {
    /// Messages handed on.
    pub received: u64,
    /// Messages that came only after asking again.
    pub recovered: u64,
    /// Messages that were given up.
    pub lost: u64,
    /// Messages that did not decode, or were of a sender that is not followed.
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

/// Delivery of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Delivery {
    /// By its sender's own sending.
    Sent,
    /// In the answer to a question for a gap.
    AskedFor,
}

/// Largest number of open queries for one gap.
const OPEN_QUESTIONS: usize = 8;
/// Largest number of senders that are remembered; beyond it the one that was silent for longest is forgotten.
const SENDERS: usize = 64;
/// Silence after which a sender is forgotten, ns.
const FORGOTTEN_NS: u64 = 600_000_000_000;

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
            subscription: bus.subscribe(topic, Qos::RealTime, Queue::Ring(RING), wake)?,
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
            self.accept(
                &arrival.key,
                arrival.arrived_ns,
                &arrival.bytes,
                Delivery::Sent,
            );
        }
        self.streams.retain(|_, stream| {
            !stream.is_idle() || now_ns < stream.arbiter.heard_ns().saturating_add(FORGOTTEN_NS)
        });
        let keys: Vec<StreamKey> = self.streams.keys().cloned().collect();
        for key in keys {
            self.chase(bus, &key, now_ns)?;
            let stream = self.streams.get_mut(&key);
            if let Some(lost) = stream.and_then(|stream| stream.losses.due(now_ns)) {
                tracing::warn!("{}: {lost} messages are lost", key.0);
            }
        }
        self.counts.refused = self.reader.refused();
        Ok(())
    }

    /// The next message in order.
    pub fn pop(&mut self) -> Option<Received<M>> {
        self.pop_where(|_| true)
    }

    /// The next message that may be handed on: among the first in order of each sender the one that came in order
    /// first. A message that may not delays its own sender alone.
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

    /// The messages of a sender that wait in order, the oldest first.
    pub fn waiting(&self, sender: Origin) -> impl Iterator<Item = &Received<M>> {
        let own = self.streams.iter();
        own.filter(move |((_, source), stream)| {
            (*source, stream.epoch) == (sender.source, sender.epoch)
        })
        .flat_map(|(_, stream)| stream.ready.iter().map(|(_, message)| message))
    }

    /// Topics whose newest message came once more: their senders have no report of its consumption.
    pub fn unheard(&mut self) -> Vec<String> {
        std::mem::take(&mut self.again)
    }

    /// Counts so far.
    #[must_use]
    pub fn counts(&self) -> ReceiverCounts {
        self.counts
    }

    /// Number of senders that are remembered.
    #[cfg(test)]
    pub(super) fn senders(&self) -> usize {
        self.streams.len()
    }

    fn accept(&mut self, topic: &str, arrived_ns: u64, bytes: &[u8], delivery: Delivery) {
        let Some((header, message)) = self.reader.read::<M>(topic, bytes) else {
            return;
        };
        let key = (topic.to_owned(), header.source);
        if !self.streams.contains_key(&key) {
            self.make_room();
        }
        let received = Received {
            key: topic.to_owned(),
            arrived_ns,
            header,
            message,
        };
        let begun = || Stream::new(&header, arrived_ns);
        let stream = self.streams.entry(key).or_insert_with(begun);
        if delivery == Delivery::AskedFor {
            if stream.fill(received, &mut self.ordered) == Taken::New {
                self.counts.recovered += 1;
            }
            return;
        }
        let (epoch, lost) = (stream.epoch, stream.lost);
        match stream.take(received, &mut self.ordered) {
            Taken::Again => self.again.push(topic.to_owned()),
            Taken::SetAside if stream.arbiter.is_rival(&header, arrived_ns) => {
                let reason = if epoch == header.epoch {
                    Reason::Leap
                } else {
                    Reason::Rival
                };
                self.reader.refuse(topic, reason);
            }
            Taken::New | Taken::Known | Taken::SetAside => {}
        }
        self.counts.lost += stream.lost - lost;
    }

    /// Forgets the sender that was silent for longest where there are too many.
    fn make_room(&mut self) {
        if self.streams.len() < SENDERS {
            return;
        }
        let heard_ns = |(_, stream): &(&StreamKey, &Stream<M>)| stream.arbiter.heard_ns();
        let oldest = self.streams.iter().min_by_key(heard_ns);
        if let Some(key) = oldest.map(|(key, _)| key.clone()) {
            self.streams.remove(&key);
        }
    }

    /// Follows up on a stream's gap.
    fn chase(&mut self, bus: &dyn Bus, key: &StreamKey, now_ns: u64) -> Result<(), BusError> {
        let (answered, unserved) = self.take_answers(key, now_ns);
        let Some(stream) = self.streams.get_mut(key) else {
            return Ok(());
        };
        let Some(gap) = stream.gap(&mut self.ordered) else {
            stream.asked.clear();
            stream.askings = 0;
            return Ok(());
        };
        let waits = !stream.asked.is_empty() && now_ns < stream.asked_ns + RETRY_NS;
        let live = !stream.is_replayed();
        let unserved = unserved && live;
        if waits && answered == 0 && !unserved {
            return Ok(());
        }
        if unserved || (live && stream.askings >= PATIENCE) {
            let lost = stream.give_up(gap, &mut self.ordered);
            self.counts.lost += lost;
            stream.losses.add(lost);
            return Ok(());
        }
        self.ask(bus, key, gap, now_ns)
    }

    /// Takes in what came for a stream's gap: how many answers there were, and whether the newest question ended at once
    /// without any, because nobody serves its gaps.
    fn take_answers(&mut self, key: &StreamKey, now_ns: u64) -> (usize, bool) {
        let Some(stream) = self.streams.get(key) else {
            return (0, false);
        };
        let (mut answers, mut ended) = (Vec::new(), false);
        for pending in &stream.asked {
            ended = false;
            while let Some(answer) = pending.try_recv() {
                match answer {
                    Answer::Bytes(bytes) => answers.push(bytes),
                    Answer::Ended => ended = true,
                }
            }
        }
        let unserved = ended && answers.is_empty() && now_ns < stream.asked_ns + RETRY_NS;
        for message in answers.iter().flat_map(|answer| split_messages(answer)) {
            self.accept(&key.0, now_ns, message, Delivery::AskedFor);
        }
        (answers.len(), unserved)
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
            .push_back(bus.ask(&topic, Qos::Control, bytes, limit, &self.wake)?);
        stream.asked_ns = now_ns;
        stream.askings += 1;
        Ok(())
    }
}
