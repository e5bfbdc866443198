//! Messages instead of bytes.

mod command_server;

use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::time::Duration;

use maulstick_types::command::{CommandReply, CommandRequest, Outcome};
use maulstick_types::{DecodeError, Flags, Header, Message, Origin, decode, encode};

use crate::bus::{Bus, BusError, Publish, Qos, Request, Subscription};
use crate::inbox::{Queue, Wake};
use crate::sender_arbiter::{Once, SenderArbiter, Verdict};

pub use command_server::CommandServer;

/// Draws an epoch: a number that differs at each start of a process.
#[must_use]
pub fn random_epoch() -> u32 {
    random_u64() as u32 | 1
}

/// Draws 64 random bits for a client's name.
#[must_use]
pub fn random_u64() -> u64 {
    use std::hash::{BuildHasher as _, RandomState};
    RandomState::new().hash_one(std::process::id())
}

/// Answers a request with a message at a time of the rig, ns; a client that has gone needs none.
pub fn answer<M: Message>(request: Request, me: &Origin, now_ns: u64, reply: &M) {
    send(request, encode(me, Flags::NONE, 0, now_ns, now_ns, reply));
}

fn send(request: Request, reply: Result<Vec<u8>, DecodeError>) {
    let topic = request.key.clone();
    match reply.map(|bytes| request.answer(bytes)) {
        Ok(Ok(())) => {}
        Ok(Err(error)) => tracing::debug!("{topic}: a client has gone: {error}"),
        Err(error) => tracing::error!("{topic}: no answer: {error}"),
    }
}

/// Sends one kind of message on one topic, numbered from 0.
pub struct Sender<M> {
    publish: Box<dyn Publish>,
    topic: String,
    origin: Origin,
    next: u64,
    /// True once a message that was too long was logged.
    told: bool,
    message: PhantomData<fn(M)>,
}

impl<M: Message> Sender<M> {
    /// Declares the topic.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(bus: &dyn Bus, topic: &str, qos: Qos, origin: Origin) -> Result<Self, BusError> {
        let publish = bus.publisher(topic, qos)?;
        Ok(Self {
            publish,
            topic: topic.to_owned(),
            origin,
            next: 0,
            told: false,
            message: PhantomData,
        })
    }

    /// Messages sent so far.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.next
    }

    /// Sends a message; `event_ns` is the time at which its content was true. One that exceeds its limit is dropped and
    /// reported: no content may end the node that sends it.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn send(&mut self, now_ns: u64, event_ns: u64, message: &M) -> Result<(), BusError> {
        let flags = if self.next == 0 {
            Flags::FIRST
        } else {
            Flags::NONE
        };
        let encoded = encode(&self.origin, flags, self.next, event_ns, now_ns, message);
        let Some(bytes) = sendable(&self.topic, encoded, &mut self.told) else {
            return Ok(());
        };
        self.next += 1;
        self.publish.put(bytes)
    }
}

/// Bytes of a message of a topic; `None` for one that exceeds its limit, which is reported once.
pub(crate) fn sendable(
    topic: &str,
    encoded: Result<Vec<u8>, DecodeError>,
    told: &mut bool,
) -> Option<Vec<u8>> {
    encoded
        .inspect_err(|error| {
            if !std::mem::replace(told, true) {
                tracing::error!("{topic}: a message is dropped: {error}");
            }
        })
        .ok()
}

/// Decodes what arrives; says once for each topic and reason what is dropped, and counts it.
#[derive(Debug, Default)]
pub struct Reader {
    refused: u64,
    told: Once,
    news: Vec<Refusal>,
}

/// A message that was dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Its topic.
    pub topic: String,
    /// The reason.
    pub reason: Reason,
}

/// Reason for dropping a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Reason {
    /// Message that does not decode.
    #[error(transparent)]
    Unread(#[from] DecodeError),
    /// Message with numbers out of range.
    #[error("{0}")]
    Fault(&'static str),
    /// Message of a second program under the same name.
    #[error(
        "a second program sends here under the same name; the one that started last is followed: \
         end the other, or give it another name"
    )]
    Rival,
    /// Two programs send as one, or one counts wrongly.
    #[error(
        "the numbers of messages leap; the stream before is followed until it is silent: \
         end a second program that sends here"
    )]
    Leap,
}

impl Reader {
    /// The message, or nothing where it was refused.
    pub fn read<M: Message>(&mut self, topic: &str, bytes: &[u8]) -> Option<(Header, M)> {
        match decode::<M>(bytes) {
            Ok(message) => Some(message),
            Err(error) => {
                self.refuse(topic, error.into());
                None
            }
        }
    }

    /// Reads a command. The reply to one that is out of range says so, if at least its number can be read.
    ///
    /// # Errors
    /// That reply.
    pub fn read_command(
        &mut self,
        topic: &str,
        bytes: &[u8],
    ) -> Result<CommandRequest, Option<CommandReply>> {
        let error = match decode::<CommandRequest>(bytes) {
            Ok((_, request)) => return Ok(request),
            Err(error) => error,
        };
        let reply = CommandRequest::number_in(bytes).map(|number| CommandReply {
            number,
            outcome: Outcome::refused(
                error.to_string(),
                "see the message formats for what a command may say",
            ),
        });
        self.refuse(topic, error.into());
        Err(reply)
    }

    /// Counts a refusal and reports it, once for each topic and reason.
    pub fn refuse(&mut self, topic: &str, reason: Reason) {
        self.refused += 1;
        let kind = match &reason {
            Reason::Unread(error) => format!("{:?}", std::mem::discriminant(error)),
            reason => format!("{:?}", std::mem::discriminant(reason)),
        };
        if self.told.say(&format!("{topic} {kind}")) {
            tracing::warn!("{topic}: {reason}");
            self.news.push(Refusal {
                topic: topic.to_owned(),
                reason,
            });
        }
    }

    /// Refusals since the last call: each topic and reason comes once.
    pub fn refusals(&mut self) -> Vec<Refusal> {
        std::mem::take(&mut self.news)
    }

    /// Messages refused so far.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.refused
    }
}

/// Largest number of streams that are remembered; beyond it the one that was silent for longest is forgotten.
const STREAMS: usize = 64;

/// Choice among several senders of a real-time stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    /// The one that started last is followed.
    Newest,
    /// Whoever reads the messages chooses.
    Readers,
}

/// Receives one kind of message; of two senders of a real-time stream the one that started last.
pub struct Receiver<M> {
    subscription: Subscription,
    reader: Reader,
    qos: Qos,
    /// Arbiters between the senders of each real-time stream.
    choice: Choice,
    /// By topic and source.
    streams: BTreeMap<(String, u32), SenderArbiter>,
    /// Error of a message that decodes, if any.
    fault: fn(&M) -> Option<&'static str>,
}

impl<M: Message> Receiver<M> {
    /// Subscribes.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: &dyn Bus,
        topic: &str,
        qos: Qos,
        queue: Queue,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let subscription = bus.subscribe(topic, qos, queue, wake)?;
        Ok(Self {
            subscription,
            reader: Reader::default(),
            qos,
            choice: Choice::Newest,
            streams: BTreeMap::new(),
            fault: |_| None,
        })
    }

    /// Hands on the messages of all senders: whoever reads them chooses.
    #[must_use]
    pub fn of_all_senders(mut self) -> Self {
        self.choice = Choice::Readers;
        self
    }

    /// Drops messages that `fault` says something against.
    #[must_use]
    pub fn checking(mut self, fault: fn(&M) -> Option<&'static str>) -> Self {
        self.fault = fault;
        self
    }

    /// True if the sender of a message is followed.
    fn follows(&mut self, header: &Header, key: &str, arrived_ns: u64) -> bool {
        let stream = (key.to_owned(), header.source);
        if !self.streams.contains_key(&stream) && self.streams.len() == STREAMS {
            let oldest = self
                .streams
                .iter()
                .min_by_key(|(_, arbiter)| arbiter.heard_ns());
            let oldest = oldest.map(|(stream, _)| stream.clone());
            oldest.map(|stream| self.streams.remove(&stream));
        }
        let begun = || SenderArbiter::new(header, arrived_ns);
        let arbiter = self.streams.entry(stream).or_insert_with(begun);
        let verdict = arbiter.judge(header, arrived_ns, true, None);
        if verdict == Verdict::SetAside && arbiter.is_rival(header, arrived_ns) {
            self.reader.refuse(key, Reason::Rival);
        }
        verdict != Verdict::SetAside
    }

    /// The next message that waits, is understood and is of the sender that is followed.
    pub fn try_recv(&mut self) -> Option<Received<M>> {
        while let Some(arrival) = self.subscription.try_recv() {
            if let Some((header, message)) = self.reader.read(&arrival.key, &arrival.bytes) {
                let (key, arrived_ns) = (arrival.key, arrival.arrived_ns);
                if let Some(fault) = (self.fault)(&message) {
                    self.reader.refuse(&key, Reason::Fault(fault));
                    continue;
                }
                let chooses = self.qos == Qos::RealTime && self.choice == Choice::Newest;
                if chooses && !self.follows(&header, &key, arrived_ns) {
                    continue;
                }
                return Some(Received {
                    key,
                    arrived_ns,
                    header,
                    message,
                });
            }
        }
        None
    }

    /// The newest message that waits.
    pub fn newest(&mut self) -> Option<Received<M>> {
        std::iter::from_fn(|| self.try_recv()).last()
    }

    /// Messages that were refused.
    #[must_use]
    pub fn refused(&self) -> u64 {
        self.reader.refused()
    }

    /// Refusals since the last call: each topic and reason comes once.
    pub fn refusals(&mut self) -> Vec<Refusal> {
        self.reader.refusals()
    }
}

impl<M> std::fmt::Debug for Receiver<M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Receiver")
            .field("subscription", &self.subscription)
            .finish_non_exhaustive()
    }
}

/// A message that arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Received<M> {
    /// Its topic.
    pub key: String,
    /// Time of arrival, rig clock, ns.
    pub arrived_ns: u64,
    /// Its header.
    pub header: Header,
    /// Itself.
    pub message: M,
}

/// Asks a query and waits for its answer.
///
/// # Errors
/// [`BusError::NoAnswer`], or [`BusError::Message`] where the answer does not decode.
pub fn ask<Q: Message, A: Message>(
    bus: &dyn Bus,
    topic: &str,
    qos: Qos,
    origin: Origin,
    question: &Q,
    limit: Duration,
) -> Result<A, BusError> {
    let wake = Wake::new();
    let now = bus.now_ns();
    let refused = |source| BusError::Message {
        topic: topic.to_owned(),
        source,
    };
    let bytes = encode(&origin, Flags::NONE, 0, now, now, question).map_err(refused)?;
    let answer = bus.ask(topic, qos, bytes, limit, &wake)?.wait(&wake)?;
    Ok(decode::<A>(&answer).map_err(refused)?.1)
}
