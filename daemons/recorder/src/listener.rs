//! Messages of a running rig, whatever they are: a member of its own, to which the nodes send directly.

use std::time::{Duration, Instant};

use maulstick_bus::{Qos, Queue, RigFolder, Subscription};
use maulstick_rig::{NodeArgs, NodeHandle};
use maulstick_streams::Traffic;
use maulstick_streams::topic_pattern::matches;
use maulstick_streams::traffic::Arrived;
use maulstick_types::Header;

use crate::error::RecorderError;
use crate::work::has_rig;

/// Topics whose last message is kept for late joiners.
const CACHED: [&str; 4] = ["scene", "brush/*/def", "brush/*/look", "stylus/*/info"];
/// Messages that wait while this program is busy: some seconds of all streams.
const ROOM: usize = 1 << 15;
/// Longest time in which what waits is taken in at the end.
const REST: Duration = Duration::from_millis(200);

/// Time for which missing messages are waited for when a measurement ends.
const LATE: Duration = Duration::from_millis(200);

/// Interval at which it is looked whether the rig is still there.
const LOOK: Duration = Duration::from_millis(50);

/// A message that was received.
#[derive(Clone)]
pub struct ReceivedMessage {
    /// Its topic, without the rig's prefix.
    pub topic: String,
    /// Header, size and time.
    pub message: Arrived,
    /// Header and body.
    pub bytes: Vec<u8>,
}

/// Receives the topics of a pattern.
pub struct Listener {
    /// This program in the rig.
    pub member: NodeHandle,
    pattern: String,
    live: Subscription,
    cached: Vec<Subscription>,
    /// Messages that are none of Maulstick's.
    pub foreign: u64,
}

impl Listener {
    /// Joins a rig as a process of its own, which signals stop.
    ///
    /// # Errors
    /// A [`RecorderError`] where no rig of that name runs, or the pattern is none.
    pub fn open(rig: &str, pattern: &str) -> Result<Self, RecorderError> {
        let (folder, _) = RigFolder::join(rig)?;
        let member = NodeHandle::join(&NodeArgs {
            folder: folder.path().to_owned(),
            node: format!("listener-{}", std::process::id()),
            guarded: false,
        })?;
        Self::over(member, pattern)
    }

    /// Listens as a member of a rig.
    ///
    /// # Errors
    /// A [`RecorderError`] where the pattern is none.
    pub fn over(member: NodeHandle, pattern: &str) -> Result<Self, RecorderError> {
        let pattern = pattern.trim_start_matches(member.topics.prefix());
        let is_key = !pattern.is_empty() && pattern.split('/').all(|part| !part.is_empty());
        if !is_key || pattern.contains(['?', '#', '$']) {
            return Err(RecorderError::Pattern(pattern.to_owned()));
        }
        let key = format!("{}{pattern}", member.topics.prefix());
        let live = member
            .bus
            .subscribe(&key, Qos::RealTime, Queue::Ring(ROOM), &member.wake)?;
        let cached = CACHED.iter().map(|topic| {
            let key = format!("{}{topic}", member.topics.prefix());
            let room = Queue::Ring(ROOM);
            member.bus.subscribe(&key, Qos::Cached, room, &member.wake)
        });
        let cached = cached.collect::<Result<_, _>>()?;
        Ok(Self {
            pattern: pattern.to_owned(),
            live,
            cached,
            foreign: 0,
            member,
        })
    }

    /// The next message; `None` once this program is asked to stop. Dropped before that, it loses no message.
    pub async fn arrival(&mut self) -> Option<ReceivedMessage> {
        loop {
            // However fast they come, other tasks have their turn.
            tokio::task::coop::consume_budget().await;
            if self.is_over() {
                return None;
            }
            if let Some(received) = self.waiting() {
                return Some(received);
            }
            self.member.wake.ringing().await;
        }
    }

    /// The next message until then, or until this program is asked to stop.
    pub fn next(&mut self, until: Instant) -> Option<ReceivedMessage> {
        // However fast they come, the time ends.
        while !self.is_over() && Instant::now() < until {
            if let Some(received) = self.waiting() {
                return Some(received);
            }
            let left = until.saturating_duration_since(Instant::now());
            self.member.wake.wait(left);
        }
        None
    }

    /// Messages that have arrived and were not asked for, for a moment at most: more may come meanwhile.
    pub fn rest(&mut self) -> Vec<ReceivedMessage> {
        let until = Instant::now() + REST;
        let waiting = std::iter::from_fn(|| self.waiting());
        waiting.take_while(|_| Instant::now() < until).collect()
    }

    /// Traffic from now on, for a time. A message that another has overtaken may come a moment later.
    pub fn traffic(&mut self, time: Duration) -> Traffic {
        let mut traffic = Traffic::since(self.member.bus.now_ns());
        let until = Instant::now() + time;
        while let Some(received) = self.next(until) {
            traffic.add(&received.topic, &received.message);
        }
        let late = Instant::now() + LATE;
        while traffic.lacks_some()
            && let Some(received) = self.next(late)
        {
            traffic.add_late(&received.topic, &received.message);
        }
        traffic
    }

    /// A message that has arrived.
    fn waiting(&mut self) -> Option<ReceivedMessage> {
        loop {
            let of_cache = self.cached.iter().find_map(Subscription::try_recv);
            let came_cached = of_cache.is_some();
            let arrival = of_cache.or_else(|| self.live.try_recv())?;
            let Some(topic) = self.member.topics.relative(&arrival.key) else {
                continue;
            };
            // A message of a cached topic comes twice.
            if Self::is_cached(topic) != came_cached || !matches(&self.pattern, topic) {
                continue;
            }
            let Ok(header) = Header::from_bytes(&arrival.bytes) else {
                self.foreign += 1;
                continue;
            };
            return Some(ReceivedMessage {
                topic: topic.to_owned(),
                message: Arrived {
                    header,
                    bytes: arrival.bytes.len(),
                    arrived_ns: arrival.arrived_ns,
                },
                bytes: arrival.bytes,
            });
        }
    }

    /// True for a topic whose last message is kept for late joiners.
    #[must_use]
    pub fn is_cached(topic: &str) -> bool {
        CACHED.iter().any(|pattern| matches(pattern, topic))
    }

    /// Messages that this program was too slow for.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        let all = self.cached.iter().chain([&self.live]);
        all.map(|subscription| subscription.counts().dropped).sum()
    }

    /// True if this program was asked to stop.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.member.stop.requested()
    }

    /// Waits until the rig has gone. Nothing signals that, so its folder is looked at.
    pub(crate) async fn rig_gone(&self) {
        let mut look = tokio::time::interval(LOOK);
        while self.has_rig() {
            look.tick().await;
        }
    }

    /// True while the rig runs.
    #[must_use]
    pub fn has_rig(&self) -> bool {
        has_rig(&self.member.folder)
    }
}
