//! The bus inside one process, under a virtual clock, with faults on demand.
//!
//! Messages arrive only while [`MemoryNet::advance`] lets time pass. Their order follows from a seeded random number
//! generator alone, so a test that fails fails again.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

use crate::bus::{
    Answer, Answering, Arrival, Bus, BusError, Pending, Publish, Qos, Request, Server,
    Subscription, Token,
};
use crate::inbox::{Inbox, Queue, Wake};

/// Faults of the transport.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// Chance that a message that is not cached, a query or an answer is lost.
    pub loss: f64,
    /// Largest delay, ns; each message draws its own, so messages overtake each other.
    pub delay_ns: u64,
}

/// A message in flight.
enum Envelope {
    Message {
        key: String,
        bytes: Vec<u8>,
        present: bool,
        kind: Kind,
    },
    Question {
        key: String,
        bytes: Vec<u8>,
        answers: Inbox<Answer>,
    },
    Answer {
        bytes: Vec<u8>,
        answers: Inbox<Answer>,
    },
    End {
        answers: Inbox<Answer>,
    },
}

struct Listener {
    expression: String,
    inbox: Inbox<Arrival>,
    to: Kind,
}

/// Kind of a message or a listener.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Topics,
    Tokens,
}

struct Net {
    now_ns: u64,
    faults: Faults,
    random: Pcg32,
    next_id: u64,
    envelopes: BTreeMap<(u64, u64), Envelope>,
    listeners: BTreeMap<u64, Listener>,
    servers: BTreeMap<u64, (String, Inbox<Request>)>,
    cached: BTreeMap<String, Vec<u8>>,
    tokens: BTreeSet<String>,
}

/// The network: make a [`MemoryBus`] of it for each node.
#[derive(Clone)]
pub struct MemoryNet {
    net: Arc<Mutex<Net>>,
}

/// One node's end of a [`MemoryNet`].
#[derive(Clone)]
pub struct MemoryBus {
    net: Arc<Mutex<Net>>,
}

fn lock(net: &Mutex<Net>) -> MutexGuard<'_, Net> {
    net.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True if a key matches an expression: `*` stands for one chunk, `**` for any number.
fn matches(expression: &str, key: &str) -> bool {
    fn chunks(expression: &[&str], key: &[&str]) -> bool {
        match (expression, key) {
            ([], []) => true,
            (["**", rest @ ..], _) => {
                chunks(rest, key) || (!key.is_empty() && chunks(expression, &key[1..]))
            }
            ([first, rest @ ..], [chunk, others @ ..]) => {
                (*first == "*" || first == chunk) && chunks(rest, others)
            }
            _ => false,
        }
    }
    chunks(
        &expression.split('/').collect::<Vec<_>>(),
        &key.split('/').collect::<Vec<_>>(),
    )
}

impl Net {
    fn chance(&mut self) -> f64 {
        f64::from(self.random.next_u32()) / f64::from(u32::MAX)
    }

    /// Sends what may be lost.
    fn send(&mut self, envelope: Envelope) {
        if self.chance() >= self.faults.loss {
            self.send_surely(envelope);
        }
    }

    /// Sends what is repaired when it is lost.
    fn send_surely(&mut self, envelope: Envelope) {
        let delay = self.chance() * self.faults.delay_ns as f64;
        self.next_id += 1;
        self.envelopes
            .insert((self.now_ns + delay as u64, self.next_id), envelope);
    }

    fn deliver(&mut self, this: &Arc<Mutex<Net>>, envelope: Envelope) {
        match envelope {
            Envelope::Message {
                key,
                bytes,
                present,
                kind,
            } => {
                for listener in self.listeners.values() {
                    if listener.to == kind && matches(&listener.expression, &key) {
                        listener.inbox.push(Arrival {
                            key: key.clone(),
                            bytes: bytes.clone(),
                            arrived_ns: self.now_ns,
                            present,
                        });
                    }
                }
            }
            Envelope::Question {
                key,
                bytes,
                answers,
            } => {
                if !self
                    .servers
                    .values()
                    .any(|(served, _)| matches(served, &key))
                {
                    answers.push(Answer::Ended);
                }
                for (expression, inbox) in self.servers.values() {
                    if matches(expression, &key) {
                        let net = Arc::downgrade(this);
                        let answers = answers.clone();
                        let answer = Box::new(move |answer: Answering<'_>| {
                            let bytes = answer.into_bytes();
                            if let Some(net) = Weak::upgrade(&net) {
                                lock(&net).send(Envelope::Answer { bytes, answers });
                            }
                            Ok(())
                        });
                        inbox.push(Request {
                            key: key.clone(),
                            bytes: bytes.clone(),
                            answer,
                        });
                    }
                }
            }
            Envelope::Answer { bytes, answers } => answers.push(Answer::Bytes(bytes.into())),
            Envelope::End { answers } => answers.push(Answer::Ended),
        }
    }
}

impl MemoryNet {
    /// A network at time `start_ns` whose faults follow `seed`.
    #[must_use]
    pub fn new(seed: u64, start_ns: u64, faults: Faults) -> Self {
        Self {
            net: Arc::new(Mutex::new(Net {
                now_ns: start_ns,
                faults,
                random: Pcg32::new(seed, 0x6d61_756c),
                next_id: 0,
                envelopes: BTreeMap::new(),
                listeners: BTreeMap::new(),
                servers: BTreeMap::new(),
                cached: BTreeMap::new(),
                tokens: BTreeSet::new(),
            })),
        }
    }

    /// A node's end.
    #[must_use]
    pub fn bus(&self) -> MemoryBus {
        MemoryBus {
            net: Arc::clone(&self.net),
        }
    }

    /// Changes what goes wrong from now on.
    pub fn set_faults(&self, faults: Faults) {
        lock(&self.net).faults = faults;
    }

    /// Lets time pass and delivers what is due, in order of time.
    pub fn advance(&self, ns: u64) {
        let mut net = lock(&self.net);
        let until = net.now_ns + ns;
        while let Some((&(due, id), _)) = net.envelopes.first_key_value() {
            if due > until {
                break;
            }
            net.now_ns = net.now_ns.max(due);
            if let Some(envelope) = net.envelopes.remove(&(due, id)) {
                net.deliver(&self.net, envelope);
            }
        }
        net.now_ns = until;
    }
}

/// Takes something out of the network when dropped.
struct Leave {
    net: Weak<Mutex<Net>>,
    id: u64,
    token: Option<String>,
}

impl Drop for Leave {
    fn drop(&mut self) {
        let Some(net) = self.net.upgrade() else {
            return;
        };
        let mut net = lock(&net);
        net.listeners.remove(&self.id);
        net.servers.remove(&self.id);
        if let Some(key) = self.token.take() {
            net.tokens.remove(&key);
            let gone = Envelope::Message {
                key,
                bytes: Vec::new(),
                present: false,
                kind: Kind::Tokens,
            };
            net.send_surely(gone);
        }
    }
}

struct MemoryPublisher {
    net: Arc<Mutex<Net>>,
    key: String,
    qos: Qos,
}

impl Publish for MemoryPublisher {
    fn put(&self, bytes: Vec<u8>) -> Result<(), BusError> {
        let mut net = lock(&self.net);
        let cached = self.qos == Qos::Cached;
        if cached {
            net.cached.insert(self.key.clone(), bytes.clone());
        }
        let key = self.key.clone();
        let envelope = Envelope::Message {
            key,
            bytes,
            present: true,
            kind: Kind::Topics,
        };
        if cached {
            net.send_surely(envelope);
        } else {
            net.send(envelope);
        }
        Ok(())
    }
}

impl MemoryBus {
    fn listen(&self, key: &str, queue: Queue, wake: &Wake, to: Kind) -> Subscription {
        let mut net = lock(&self.net);
        net.next_id += 1;
        let id = net.next_id;
        let inbox = Inbox::new(queue, wake);
        let listener = Listener {
            expression: key.to_owned(),
            inbox: inbox.clone(),
            to,
        };
        net.listeners.insert(id, listener);
        let keep = Leave {
            net: Arc::downgrade(&self.net),
            id,
            token: None,
        };
        Subscription {
            inbox,
            _keep: Box::new(keep),
        }
    }
}

impl Bus for MemoryBus {
    fn publisher(&self, key: &str, qos: Qos) -> Result<Box<dyn Publish>, BusError> {
        Ok(Box::new(MemoryPublisher {
            net: Arc::clone(&self.net),
            key: key.to_owned(),
            qos,
        }))
    }

    fn subscribe(
        &self,
        key: &str,
        qos: Qos,
        queue: Queue,
        wake: &Wake,
    ) -> Result<Subscription, BusError> {
        let subscription = self.listen(key, queue, wake, Kind::Topics);
        if qos == Qos::Cached {
            let net = lock(&self.net);
            for (cached, bytes) in &net.cached {
                if matches(key, cached) {
                    subscription.inbox.push(Arrival {
                        key: cached.clone(),
                        bytes: bytes.clone(),
                        arrived_ns: net.now_ns,
                        present: true,
                    });
                }
            }
        }
        Ok(subscription)
    }

    fn serve(&self, key: &str, capacity: usize, wake: &Wake) -> Result<Server, BusError> {
        let mut net = lock(&self.net);
        net.next_id += 1;
        let id = net.next_id;
        let inbox = Inbox::new(Queue::Bounded(capacity), wake);
        net.servers.insert(id, (key.to_owned(), inbox.clone()));
        let keep = Leave {
            net: Arc::downgrade(&self.net),
            id,
            token: None,
        };
        Ok(Server {
            inbox,
            _keep: Box::new(keep),
        })
    }

    fn ask(
        &self,
        key: &str,
        _qos: Qos,
        bytes: Vec<u8>,
        limit: Duration,
        wake: &Wake,
    ) -> Result<Pending, BusError> {
        let inbox = Inbox::new(Queue::Ring(64), wake);
        let mut net = lock(&self.net);
        let answers = inbox.clone();
        net.send(Envelope::Question {
            key: key.to_owned(),
            bytes,
            answers,
        });
        net.next_id += 1;
        let end = (
            net.now_ns + u64::try_from(limit.as_nanos()).unwrap_or(u64::MAX / 2),
            net.next_id,
        );
        net.envelopes.insert(
            end,
            Envelope::End {
                answers: inbox.clone(),
            },
        );
        Ok(Pending {
            inbox,
            topic: key.to_owned(),
            limit,
        })
    }

    fn token(&self, key: &str) -> Result<Token, BusError> {
        let mut net = lock(&self.net);
        net.tokens.insert(key.to_owned());
        let appeared = Envelope::Message {
            key: key.to_owned(),
            bytes: Vec::new(),
            present: true,
            kind: Kind::Tokens,
        };
        net.send_surely(appeared);
        let keep = Leave {
            net: Arc::downgrade(&self.net),
            id: 0,
            token: Some(key.to_owned()),
        };
        Ok(Token {
            _keep: Box::new(keep),
        })
    }

    fn watch(&self, key: &str, wake: &Wake) -> Result<Subscription, BusError> {
        let subscription = self.listen(key, Queue::Ring(1024), wake, Kind::Tokens);
        let net = lock(&self.net);
        for token in net.tokens.iter().filter(|token| matches(key, token)) {
            subscription.inbox.push(Arrival {
                key: token.clone(),
                bytes: Vec::new(),
                arrived_ns: net.now_ns,
                present: true,
            });
        }
        Ok(subscription)
    }

    fn now_ns(&self) -> u64 {
        lock(&self.net).now_ns
    }
}

#[cfg(test)]
mod tests;
