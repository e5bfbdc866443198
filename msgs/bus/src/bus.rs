//! Interface of the transport to a node.

use std::any::Any;
use std::fmt;
use std::time::Duration;

use crate::inbox::{Counts, Inbox, Queue, Wake};
use crate::shared_memory::payload::Payload;

/// Errors of the bus.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BusError {
    /// The session could not be opened.
    #[error("cannot open the bus at {at}: {reason}")]
    Open {
        /// Address.
        at: String,
        /// Error of the transport.
        reason: String,
    },
    /// Nobody could be connected to in time.
    #[error("{at}: no connection within {limit_s} s")]
    Silent {
        /// Address.
        at: String,
        /// Waiting time, s.
        limit_s: u64,
    },
    /// This process may open too few files.
    #[error("this process may open {limit} files at the same time, and needs {least}")]
    Files {
        /// The limit.
        limit: u64,
        /// Files that it needs.
        least: u64,
    },
    /// A declaration or a send failed.
    #[error("{topic}: {reason}")]
    Topic {
        /// The topic.
        topic: String,
        /// Error of the transport.
        reason: String,
    },
    /// No answer in time.
    #[error("{topic}: no answer within {limit_ms} ms")]
    NoAnswer {
        /// The topic.
        topic: String,
        /// Waiting time, ms.
        limit_ms: u64,
    },
    /// The message does not fit its limit, or the answer does not decode.
    #[error("{topic}: {source}")]
    Message {
        /// The topic.
        topic: String,
        /// The error.
        source: maulstick_types::DecodeError,
    },
    /// No rig of that name runs.
    #[error("no rig called '{0}' is running")]
    NoRig(String),
    /// The rig's folder cannot be used.
    #[error("{reason}")]
    Folder {
        /// The error, and its place.
        reason: String,
        /// Advice.
        help: String,
    },
}

/// Quality of service of a topic. Every class may drop: a slow receiver never delays a sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Qos {
    /// Samples, states and contact models.
    RealTime,
    /// Credits, commands, lost messages, and the replies to them.
    Control,
    /// Rare values that late joiners need: the last one is kept for them, and a loss is repaired.
    Cached,
    /// Frames and the journal.
    Data,
    /// Status.
    Background,
}

/// A payload that arrived.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Its topic.
    pub key: String,
    /// Header and body; empty for a token.
    pub bytes: Vec<u8>,
    /// Time of arrival, rig clock, ns.
    pub arrived_ns: u64,
    /// For a token: true if it appeared, false if it went.
    pub present: bool,
}

/// Sends to one topic.
pub trait Publish: Send {
    /// Sends; may drop, never waits for a receiver.
    ///
    /// # Errors
    /// [`BusError::Topic`] where the transport is closed.
    fn put(&self, bytes: Vec<u8>) -> Result<(), BusError>;
}

/// Messages that arrive on a key expression, until dropped.
pub struct Subscription {
    /// The queue.
    pub inbox: Inbox<Arrival>,
    pub(crate) _keep: Box<dyn Any + Send + Sync>,
}

impl Subscription {
    /// The oldest arrival that waits.
    #[must_use]
    pub fn try_recv(&self) -> Option<Arrival> {
        self.inbox.try_recv()
    }

    /// Messages received and dropped so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.inbox.counts()
    }
}

impl fmt::Debug for Subscription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Subscription")
            .field("inbox", &self.inbox)
            .finish_non_exhaustive()
    }
}

/// Sends an answer.
type Answerer = Box<dyn FnOnce(Answering<'_>) -> Result<(), BusError> + Send>;

/// A query that waits for its answer. Dropping it answers nothing.
pub struct Request {
    /// The topic that was asked.
    pub key: String,
    /// The query: header and body.
    pub bytes: Vec<u8>,
    pub(crate) answer: Answerer,
}

/// The answer.
pub(crate) enum Answering<'a> {
    /// These bytes.
    Bytes(Vec<u8>),
    /// Bytes that are written into shared memory, if there is any.
    Written {
        /// Bytes.
        length: usize,
        /// Writes all of them.
        write: &'a mut dyn FnMut(&mut [u8]),
    },
}

impl Answering<'_> {
    /// The bytes, in memory of one's own.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Bytes(bytes) => bytes,
            Self::Written { length, write } => {
                let mut bytes = vec![0; length];
                write(&mut bytes);
                bytes
            }
        }
    }
}

impl Request {
    /// Answers.
    ///
    /// # Errors
    /// [`BusError::Topic`] where the asker is gone.
    pub fn answer(self, bytes: Vec<u8>) -> Result<(), BusError> {
        (self.answer)(Answering::Bytes(bytes))
    }

    /// Answers with `length` bytes that `write` writes: into memory that the asker reads them in,
    /// where both processes can share some and the pool has room, else as
    /// [`answer`](Self::answer) does.
    ///
    /// # Errors
    /// [`BusError::Topic`] where the asker is gone.
    pub fn answer_shared(
        self,
        length: usize,
        write: &mut dyn FnMut(&mut [u8]),
    ) -> Result<(), BusError> {
        (self.answer)(Answering::Written { length, write })
    }
}

/// Queries on a key expression, until dropped.
pub struct Server {
    pub(crate) inbox: Inbox<Request>,
    pub(crate) _keep: Box<dyn Any + Send + Sync>,
}

impl Server {
    /// The oldest query that waits.
    #[must_use]
    pub fn try_recv(&self) -> Option<Request> {
        self.inbox.try_recv()
    }
}

/// Outcome of a query.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// An answer.
    Bytes(Payload),
    /// No answer will come.
    Ended,
}

/// An asked query: answers arrive in its inbox, then [`Answer::Ended`].
#[derive(Debug)]
pub struct Pending {
    pub(crate) inbox: Inbox<Answer>,
    pub(crate) topic: String,
    pub(crate) limit: Duration,
}

impl Pending {
    /// The next answer that has arrived.
    #[must_use]
    pub fn try_recv(&self) -> Option<Answer> {
        self.inbox.try_recv()
    }

    /// Waits on `wake`, which must be the one that the query was asked with, for the first answer.
    ///
    /// # Errors
    /// [`BusError::NoAnswer`] where none comes in time.
    pub fn wait(&self, wake: &Wake) -> Result<Payload, BusError> {
        let give_up = std::time::Instant::now() + self.limit + Duration::from_millis(200);
        loop {
            match self.inbox.try_recv() {
                Some(Answer::Bytes(bytes)) => return Ok(bytes),
                Some(Answer::Ended) => break,
                None => {}
            }
            let left = give_up.saturating_duration_since(std::time::Instant::now());
            if left.is_zero() {
                break;
            }
            wake.wait(left);
        }
        Err(BusError::NoAnswer {
            topic: self.topic.clone(),
            limit_ms: u64::try_from(self.limit.as_millis()).unwrap_or(u64::MAX),
        })
    }
}

/// Kept for as long as a node lives; dropped, or with its process, it disappears for all.
pub struct Token {
    pub(crate) _keep: Box<dyn Any + Send + Sync>,
}

/// A transport with the rig's clock.
pub trait Bus: Send + Sync {
    /// Declares that this process sends on `key`.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn publisher(&self, key: &str, qos: Qos) -> Result<Box<dyn Publish>, BusError>;

    /// Receives what matches `key`; `Cached` topics give their last value at once.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn subscribe(
        &self,
        key: &str,
        qos: Qos,
        queue: Queue,
        wake: &Wake,
    ) -> Result<Subscription, BusError>;

    /// Answers queries on `key`; at most `capacity` wait.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn serve(&self, key: &str, capacity: usize, wake: &Wake) -> Result<Server, BusError>;

    /// Asks `key`; answers and the end arrive in the result and ring `wake`. The answer travels in
    /// the class of the question.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn ask(
        &self,
        key: &str,
        qos: Qos,
        bytes: Vec<u8>,
        limit: Duration,
        wake: &Wake,
    ) -> Result<Pending, BusError>;

    /// Shows that this node lives.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn token(&self, key: &str) -> Result<Token, BusError>;

    /// Watches tokens come and go, those that already live first.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    fn watch(&self, key: &str, wake: &Wake) -> Result<Subscription, BusError>;

    /// The rig's clock, ns.
    fn now_ns(&self) -> u64;
}
