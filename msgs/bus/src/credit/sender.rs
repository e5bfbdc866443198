//! The sending end of a stream with credit.

use std::collections::VecDeque;
use std::marker::PhantomData;

use maulstick_types::command::GapRequest;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Header, Message, Origin, encode};

use super::{RETRY_NS, RING, RING_BYTES, WINDOW};
use crate::bus::{Bus, BusError, Publish, Qos, Server};
use crate::inbox::Wake;
use crate::typed::{Reader, sendable};

/// Most bytes of an answer to a gap request, unless a single message has more.
const ANSWER_BYTES: usize = 1 << 20;

/// Time of sending a message and time of its content, rig clock, ns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// Now.
    pub now_ns: u64,
    /// Time of sampling.
    pub event_ns: u64,
}

/// Numbers, sends and keeps messages until they are consumed.
pub struct CreditSender<M> {
    publish: Box<dyn Publish>,
    gaps: Server,
    reader: Reader,
    topic: String,
    origin: Origin,
    next: u64,
    consumed: u64,
    progress_ns: u64,
    ring: VecDeque<Kept>,
    /// Bytes of the messages in the ring.
    ring_bytes: usize,
    /// True once a message that was too long was logged.
    told: bool,
    message: PhantomData<fn(M)>,
}

struct Kept {
    seq: u64,
    event_ns: u64,
    bytes: Vec<u8>,
}

impl<M: Message> CreditSender<M> {
    /// Declares the topic and answers for its gaps.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topics: &Topics,
        topic: &str,
        origin: Origin,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let stream = topics.relative(topic).unwrap_or(topic);
        Ok(Self {
            publish: bus.publisher(topic, Qos::RealTime)?,
            gaps: bus.serve(&topics.gap(stream), 64, wake)?,
            reader: Reader::default(),
            topic: topic.to_owned(),
            origin,
            next: 0,
            consumed: 0,
            progress_ns: bus.now_ns(),
            ring: VecDeque::new(),
            ring_bytes: 0,
            told: false,
            message: PhantomData,
        })
    }

    /// Sends a message and returns its number. One that exceeds its limit is dropped and reported, and the next one has its
    /// number.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn send(&mut self, flags: Flags, stamp: Stamp, message: &M) -> Result<u64, BusError> {
        let Stamp { now_ns, event_ns } = stamp;
        let flags = if self.next == 0 {
            flags.with(Flags::FIRST)
        } else {
            flags
        };
        let seq = self.next;
        let encoded = encode(&self.origin, flags, seq, event_ns, now_ns, message);
        let Some(bytes) = sendable(&self.topic, encoded, &mut self.told) else {
            return Ok(seq);
        };
        if self.outstanding() == 0 {
            self.progress_ns = now_ns;
        }
        self.ring_bytes += bytes.len();
        self.ring.push_back(Kept {
            seq,
            event_ns,
            bytes: bytes.clone(),
        });
        self.make_room();
        self.next += 1;
        self.publish.put(bytes)?;
        Ok(seq)
    }

    /// Drops the oldest messages that there is no room for.
    fn make_room(&mut self) {
        let window = WINDOW as usize;
        while self.ring.len() > RING || (self.ring_bytes > RING_BYTES && self.ring.len() > window) {
            let dropped = self.ring.pop_front();
            self.ring_bytes -= dropped.map_or(0, |kept| kept.bytes.len());
        }
    }

    /// Begins a new stream: another epoch, numbers from 0, nothing outstanding.
    pub fn restart(&mut self, epoch: u32) {
        self.origin.epoch = epoch;
        self.next = 0;
        self.consumed = 0;
        self.ring.clear();
        self.ring_bytes = 0;
    }

    /// The consumer has consumed all messages below `next` of epoch `epoch`.
    pub fn consumed(&mut self, epoch: u32, next: u64, now_ns: u64) {
        if epoch == self.origin.epoch && next > self.consumed && next <= self.next {
            self.consumed = next;
            self.progress_ns = now_ns;
        }
    }

    /// Forgets what is outstanding: its consumer is gone.
    pub fn reset_credit(&mut self) {
        self.consumed = self.next;
    }

    /// Origin of the messages.
    #[must_use]
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// Number of the next message.
    #[must_use]
    pub fn next_seq(&self) -> u64 {
        self.next
    }

    /// Messages that the consumer has not consumed.
    #[must_use]
    pub fn outstanding(&self) -> u64 {
        self.next - self.consumed
    }

    /// True if another message may be sent: fewer than 64 are outstanding.
    #[must_use]
    pub fn has_credit(&self) -> bool {
        self.outstanding() < WINDOW
    }

    /// Age of the oldest message that is not consumed, by its time of sampling, ns.
    #[must_use]
    pub fn oldest_age_ns(&self, now_ns: u64) -> u64 {
        let oldest = self.ring.len().saturating_sub(self.outstanding() as usize);
        match self.ring.get(oldest) {
            Some(kept) if self.outstanding() > 0 => now_ns.saturating_sub(kept.event_ns),
            _ => 0,
        }
    }

    /// Answers queries for gaps, and sends the newest message again where the consumer has made no
    /// progress for a while: the loss of a last message shows no gap.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        while let Some(request) = self.gaps.try_recv() {
            let Some((_, gap)) = self.reader.read::<GapRequest>(&request.key, &request.bytes)
            else {
                continue;
            };
            if gap.epoch != self.origin.epoch {
                continue;
            }
            let mut bytes = Vec::new();
            let missing = |kept: &&Kept| (gap.from..=gap.to).contains(&kept.seq);
            for kept in self.ring.iter().filter(missing) {
                // Messages without room in this answer are asked for again.
                if !bytes.is_empty() && bytes.len() + kept.bytes.len() > ANSWER_BYTES {
                    break;
                }
                bytes.extend_from_slice(&kept.bytes);
            }
            request.answer(bytes)?;
        }
        if self.outstanding() > 0 && now_ns.saturating_sub(self.progress_ns) > RETRY_NS {
            self.progress_ns = now_ns;
            if let Some(kept) = self.ring.back() {
                self.publish.put(kept.bytes.clone())?;
            }
        }
        Ok(())
    }
}

/// Splits the answer to a gap into whole messages.
pub(super) fn split_messages(mut bytes: &[u8]) -> Vec<&[u8]> {
    let mut messages = Vec::new();
    while bytes.len() >= maulstick_types::HEADER_BYTES {
        let length = u32::from_le_bytes([bytes[20], bytes[21], bytes[22], bytes[23]]) as usize;
        let whole = maulstick_types::HEADER_BYTES.saturating_add(length);
        if whole > bytes.len() || Header::from_bytes(&bytes[..whole]).is_err() {
            break;
        }
        messages.push(&bytes[..whole]);
        bytes = &bytes[whole..];
    }
    messages
}
