//! The bus between processes.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use nix::sys::resource::{Resource, getrlimit, setrlimit};
use zenoh::Wait as _;
use zenoh::bytes::ZBytes;
use zenoh::handlers::CallbackDrop;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::ConsolidationMode;
use zenoh::sample::{Sample, SampleKind};
use zenoh_ext::{
    AdvancedPublisherBuilderExt as _, AdvancedSubscriberBuilderExt as _, CacheConfig,
    HistoryConfig, MissDetectionConfig, RecoveryConfig,
};

use crate::bus::{
    Answer, Answering, Arrival, Bus, BusError, Pending, Publish, Qos, Request, Server,
    Subscription, Token,
};
use crate::clock::RigClock;
use crate::inbox::{Inbox, Queue, Wake};
use crate::reason::reason;
use crate::shared_memory::payload::Payload;
use crate::shared_memory::pool::Pool;

/// Settings with which a process joins the rig's sockets.
#[derive(Clone, Debug)]
pub struct Dial {
    /// Name shown to others.
    pub name: String,
    /// Own locator. A program without one joins as a client: the process that it connects to passes
    /// everything on.
    pub listen: Option<String>,
    /// Locators to connect to.
    pub connect: Vec<String>,
}

/// The largest message that a receiver accepts, bytes: a full-screen frame and some.
const MAX_MESSAGE_BYTES: usize = 96 << 20;
/// A peer that says nothing for this long is gone, ms. A process that died closes its sockets and is gone at once; one
/// that stood still continues, and must count as alive for that time: zenoh makes a link between two peers that both stay known
/// to a third only once.
const LEASE_MS: u32 = 20_000;

/// Longest wait for a connection to a rig that runs: as long as a process that stands still is believed.
const CONNECT: Duration = Duration::from_secs(20);
/// Files that a session has open at the same time: threads that wait, sockets to all others, and what its node reads.
const LEAST_FILES: u64 = 64;

/// Sees that this process may open as many files as a session needs; the limit is raised as far as the system allows.
///
/// # Errors
/// [`BusError::Files`]: without them zenoh panics.
fn check_files() -> Result<(), BusError> {
    let Ok((now, most)) = getrlimit(Resource::RLIMIT_NOFILE) else {
        return Ok(());
    };
    if now >= LEAST_FILES {
        return Ok(());
    }
    let wanted = LEAST_FILES.min(most);
    let raised = setrlimit(Resource::RLIMIT_NOFILE, wanted, most).map_or(now, |()| wanted);
    if raised >= LEAST_FILES {
        Ok(())
    } else {
        Err(BusError::Files {
            limit: raised,
            least: LEAST_FILES,
        })
    }
}

/// A zenoh session with the rig's clock.
#[derive(Debug)]
pub struct ZenohBus {
    session: zenoh::Session,
    clock: RigClock,
    pool: Option<Arc<Pool>>,
}

pub(crate) fn topic_error(topic: &str, error: impl std::fmt::Display) -> BusError {
    BusError::Topic {
        topic: topic.to_owned(),
        reason: reason(error),
    }
}

fn priority(qos: Qos) -> Priority {
    match qos {
        Qos::RealTime => Priority::RealTime,
        Qos::Control => Priority::InteractiveHigh,
        Qos::Cached => Priority::InteractiveLow,
        Qos::Data => Priority::Data,
        Qos::Background => Priority::Background,
    }
}

impl ZenohBus {
    /// Opens a session.
    ///
    /// # Errors
    /// [`BusError::Open`] where a locator cannot be used, or zenoh listens elsewhere than asked.
    pub fn open(dial: &Dial, clock: RigClock) -> Result<Self, BusError> {
        Self::open_as(dial, clock, Memory::Own)
    }

    /// Opens a session whose large answers are in memory that it shares with the asker, where the machine and the
    /// asker's session allow it.
    ///
    /// # Errors
    /// As [`ZenohBus::open`].
    pub fn open_sharing(dial: &Dial, clock: RigClock) -> Result<Self, BusError> {
        let opened = Self::open_as(dial, clock, Memory::Shared);
        let Err(error @ BusError::Open { .. }) = opened else {
            return opened;
        };
        let own = Self::open(dial, clock)?;
        tracing::info!(
            "pictures go through the socket, which takes longer: no memory is shared: {error}"
        );
        Ok(own)
    }

    /// The same bus with a pool of `bytes`, for benchmarks; without one if it shares no memory.
    #[must_use]
    pub fn lending(mut self, bytes: usize) -> Self {
        self.pool = self.pool.map(|_| Arc::new(Pool::of(bytes)));
        self
    }

    fn open_as(dial: &Dial, clock: RigClock, memory: Memory) -> Result<Self, BusError> {
        let at = dial
            .listen
            .iter()
            .chain(&dial.connect)
            .cloned()
            .collect::<Vec<_>>()
            .join(", ");
        let open_error = |error: String| BusError::Open {
            at: at.clone(),
            reason: error,
        };
        check_files()?;
        let config = config(dial, memory).map_err(|error| open_error(reason(error)))?;
        let begun = Instant::now();
        let session = zenoh::open(config).wait().map_err(|error| {
            // It has tried again and again until then.
            if dial.connect.is_empty() || begun.elapsed() < CONNECT {
                open_error(reason(error))
            } else {
                BusError::Silent {
                    at: at.clone(),
                    limit_s: CONNECT.as_secs(),
                }
            }
        })?;
        if let Some(listen) = &dial.listen {
            let locators = session.info().locators().wait();
            if !locators
                .iter()
                .any(|locator| locator.to_string() == *listen)
            {
                return Err(open_error(format!("zenoh listens at {locators:?} instead")));
            }
        }
        let pool = (memory == Memory::Shared).then(Arc::default);
        Ok(Self {
            session,
            clock,
            pool,
        })
    }

    /// The session itself, for benchmarks that put a bare zenoh beside this bus.
    #[must_use]
    pub fn raw_session(&self) -> &zenoh::Session {
        &self.session
    }

    /// Says goodbye to all peers.
    pub fn close(&self) {
        if let Err(error) = self.session.close().wait() {
            tracing::debug!("closing the bus: {}", reason(error));
        }
    }
}

/// Memory of a session's large answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Memory {
    Own,
    Shared,
}

fn config(dial: &Dial, memory: Memory) -> zenoh::Result<zenoh::Config> {
    let mut config = zenoh::Config::default();
    for (key, value) in meeting(dial).into_iter().chain(transport(dial, memory)) {
        config
            .insert_json5(key, &value.to_string())
            .map_err(|error| format!("{key}: {error}"))?;
    }
    Ok(config)
}

/// A setting of zenoh and its value.
type Setting = (&'static str, serde_json::Value);

/// Settings by which processes of a rig meet.
fn meeting(dial: &Dial) -> [Setting; 10] {
    [
        (
            "mode",
            serde_json::json!(if dial.listen.is_some() {
                "peer"
            } else {
                "client"
            }),
        ),
        (
            "metadata",
            serde_json::json!({ "name": dial.name, "pid": std::process::id() }),
        ),
        (
            "listen/endpoints",
            serde_json::json!(dial.listen.iter().collect::<Vec<_>>()),
        ),
        ("connect/endpoints", serde_json::json!(dial.connect)),
        ("connect/timeout_ms", serde_json::json!(CONNECT.as_millis())),
        (
            "connect/exit_on_failure",
            serde_json::json!(!dial.connect.is_empty()),
        ),
        (
            "connect/retry",
            serde_json::json!({
                "period_init_ms": 50, "period_max_ms": 500, "period_increase_factor": 2
            }),
        ),
        ("scouting/multicast/enabled", serde_json::json!(false)),
        ("scouting/gossip/enabled", serde_json::json!(true)),
        (
            "scouting/gossip/autoconnect_strategy",
            serde_json::json!({ "peer": { "to_router": "always", "to_peer": "greater-zid" } }),
        ),
    ]
}

/// Settings of the links between them.
fn transport(dial: &Dial, memory: Memory) -> [Setting; 9] {
    [
        // By gossip a process hears of what others listen at, over TCP too.
        (
            "transport/link/protocols",
            serde_json::json!(protocols(dial)),
        ),
        ("timestamping/enabled", serde_json::json!(true)),
        // Each says what it sends and receives, to who asks.
        ("adminspace/enabled", serde_json::json!(true)),
        ("transport/link/tx/lease", serde_json::json!(LEASE_MS)),
        (
            "transport/link/tx/queue/size/real_time",
            serde_json::json!(16),
        ),
        (
            "transport/link/rx/max_message_size",
            serde_json::json!(MAX_MESSAGE_BYTES),
        ),
        ("transport/unicast/lowlatency", serde_json::json!(false)),
        (
            "transport/shared_memory/enabled",
            serde_json::json!(memory == Memory::Shared),
        ),
        // Only what is written there on purpose is shared.
        (
            "transport/shared_memory/transport_optimization/enabled",
            serde_json::json!(false),
        ),
    ]
}

/// The protocols of the requested locators: those of a rig are unix sockets.
fn protocols(dial: &Dial) -> BTreeSet<&str> {
    let locators = dial.listen.iter().chain(&dial.connect);
    locators
        .filter_map(|locator| locator.split('/').next())
        .collect()
}

struct ZenohPublisher {
    topic: String,
    send: Box<dyn Fn(Vec<u8>) -> zenoh::Result<()> + Send>,
}

impl Publish for ZenohPublisher {
    fn put(&self, bytes: Vec<u8>) -> Result<(), BusError> {
        (self.send)(bytes).map_err(|error| topic_error(&self.topic, error))
    }
}

/// Shorter answers go through the socket as fast or faster, bytes.
const SHARED_FROM: usize = 768 << 10;

/// An answer, written into shared memory where it is worth it and there is room.
fn payload(answer: Answering<'_>, pool: Option<&Pool>) -> ZBytes {
    match (answer, pool) {
        (Answering::Written { length, write }, Some(pool)) if length >= SHARED_FROM => {
            match pool.room(length) {
                Some(mut room) => {
                    write(&mut room);
                    room.into()
                }
                None => Answering::Written { length, write }.into_bytes().into(),
            }
        }
        (answer, _) => answer.into_bytes().into(),
    }
}

/// Turns a sample into an arrival; the only work that a callback does.
fn arrive(inbox: &Inbox<Arrival>, clock: RigClock, sample: &Sample) {
    inbox.push(Arrival {
        key: sample.key_expr().as_str().to_owned(),
        bytes: sample.payload().to_bytes().into_owned(),
        arrived_ns: clock.now_ns(),
        present: sample.kind() == SampleKind::Put,
    });
}

impl Bus for ZenohBus {
    fn publisher(&self, key: &str, qos: Qos) -> Result<Box<dyn Publish>, BusError> {
        let builder = self
            .session
            .declare_publisher(key.to_owned())
            .congestion_control(CongestionControl::Drop)
            .priority(priority(qos));
        let send: Box<dyn Fn(Vec<u8>) -> zenoh::Result<()> + Send> = if qos == Qos::Cached {
            let publisher = builder
                .cache(CacheConfig::default().max_samples(1))
                .publisher_detection()
                .sample_miss_detection(
                    MissDetectionConfig::default().heartbeat(Duration::from_millis(500)),
                )
                .wait()
                .map_err(|error| topic_error(key, error))?;
            Box::new(move |bytes| publisher.put(bytes).wait())
        } else {
            let publisher = builder.wait().map_err(|error| topic_error(key, error))?;
            Box::new(move |bytes| publisher.put(bytes).wait())
        };
        Ok(Box::new(ZenohPublisher {
            topic: key.to_owned(),
            send,
        }))
    }

    fn subscribe(
        &self,
        key: &str,
        qos: Qos,
        queue: Queue,
        wake: &Wake,
    ) -> Result<Subscription, BusError> {
        let inbox = Inbox::new(queue, wake);
        let (to, clock) = (inbox.clone(), self.clock);
        let builder = self
            .session
            .declare_subscriber(key.to_owned())
            .callback(move |sample| arrive(&to, clock, &sample));
        let keep: Box<dyn std::any::Any + Send + Sync> = if qos == Qos::Cached {
            let subscriber = builder
                .history(
                    HistoryConfig::default()
                        .max_samples(1)
                        .detect_late_publishers(),
                )
                .recovery(RecoveryConfig::default().heartbeat())
                .wait()
                .map_err(|error| topic_error(key, error))?;
            Box::new(subscriber)
        } else {
            Box::new(builder.wait().map_err(|error| topic_error(key, error))?)
        };
        Ok(Subscription { inbox, _keep: keep })
    }

    fn serve(&self, key: &str, capacity: usize, wake: &Wake) -> Result<Server, BusError> {
        let inbox = Inbox::new(Queue::Bounded(capacity), wake);
        let (to, pool) = (inbox.clone(), self.pool.clone());
        let queryable = self
            .session
            .declare_queryable(key.to_owned())
            .callback(move |query| {
                let bytes = query
                    .payload()
                    .map(|p| p.to_bytes().into_owned())
                    .unwrap_or_default();
                let key = query.key_expr().as_str().to_owned();
                let topic = key.clone();
                let pool = pool.clone();
                let answer = Box::new(move |answer: Answering<'_>| {
                    query
                        .reply(query.key_expr().clone(), payload(answer, pool.as_deref()))
                        .wait()
                        .map_err(|error| topic_error(&topic, error))
                });
                to.push(Request { key, bytes, answer });
            })
            .wait()
            .map_err(|error| topic_error(key, error))?;
        Ok(Server {
            inbox,
            _keep: Box::new(queryable),
        })
    }

    fn ask(
        &self,
        key: &str,
        qos: Qos,
        bytes: Vec<u8>,
        limit: Duration,
        wake: &Wake,
    ) -> Result<Pending, BusError> {
        let inbox = Inbox::new(Queue::Ring(64), wake);
        let (answers, end) = (inbox.clone(), inbox.clone());
        let callback = CallbackDrop {
            callback: move |reply: zenoh::query::Reply| {
                if let Ok(sample) = reply.result() {
                    answers.push(Answer::Bytes(Payload::of(sample.payload())));
                }
            },
            drop: move || end.push(Answer::Ended),
        };
        self.session
            .get(key.to_owned())
            .payload(bytes)
            .timeout(limit)
            .congestion_control(CongestionControl::Drop)
            .priority(priority(qos))
            .consolidation(ConsolidationMode::None)
            .with(callback)
            .wait()
            .map_err(|error| topic_error(key, error))?;
        Ok(Pending {
            inbox,
            topic: key.to_owned(),
            limit,
        })
    }

    fn token(&self, key: &str) -> Result<Token, BusError> {
        let token = self
            .session
            .liveliness()
            .declare_token(key.to_owned())
            .wait()
            .map_err(|error| topic_error(key, error))?;
        Ok(Token {
            _keep: Box::new(token),
        })
    }

    fn watch(&self, key: &str, wake: &Wake) -> Result<Subscription, BusError> {
        let inbox = Inbox::new(Queue::Ring(1024), wake);
        let (to, clock) = (inbox.clone(), self.clock);
        let subscriber = self
            .session
            .liveliness()
            .declare_subscriber(key.to_owned())
            .history(true)
            .callback(move |sample| arrive(&to, clock, &sample))
            .wait()
            .map_err(|error| topic_error(key, error))?;
        Ok(Subscription {
            inbox,
            _keep: Box::new(subscriber),
        })
    }

    fn now_ns(&self) -> u64 {
        self.clock.now_ns()
    }
}
