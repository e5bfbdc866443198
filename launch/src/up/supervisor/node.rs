//! One node of a rig, for the launcher.

use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};

use maulstick_rig::RigConfig;
use maulstick_rig::config::Restart;

use crate::up::plan::{NodeSpec, Role};

/// Number of failures within [`WINDOW`] that are too many.
const FAILURES: usize = 3;
/// See [`FAILURES`].
const WINDOW: Duration = Duration::from_secs(10);
/// A node shows its token within this time, or it counts as failed.
const START_TIME: Duration = Duration::from_secs(30);
/// The same for the paint node of a document: a fill of a vast canvas may have to be done again.
const START_TIME_DOCUMENT: Duration = Duration::from_secs(600);
/// Pause after the first start that the system did not allow; after each further one it is twice as long, up to
/// [`LONGEST_PAUSE`].
const FIRST_PAUSE: Duration = Duration::from_millis(200);
/// See [`FIRST_PAUSE`].
const LONGEST_PAUSE: Duration = Duration::from_secs(5);
/// Number of them in a row, a minute's, that are too many.
const MOST_FAILED: u32 = 16;

/// State of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::up) enum State {
    /// Started, its token not yet seen.
    Starting,
    /// Its token is there.
    Running,
    /// Ended, to be started again.
    Restarting,
    /// Ended with success.
    Ended,
    /// Failed too often, or may not be started again.
    Failed,
}

impl State {
    /// As the table shows it.
    pub(in crate::up) fn word(self) -> &'static str {
        match self {
            Self::Starting => "starting",
            Self::Running => "running",
            Self::Restarting => "restarting",
            Self::Ended => "ended",
            Self::Failed => "failed",
        }
    }
}

/// A node, and times of its process.
#[derive(Debug)]
pub(in crate::up) struct Node {
    /// Its specification.
    pub(in crate::up) spec: NodeSpec,
    /// Its state.
    pub(in crate::up) state: State,
    /// Its process, while it runs.
    pub(in crate::up) pid: Option<u32>,
    /// Time of its start.
    pub(super) started: Option<Instant>,
    /// Time since when its token is missed.
    pub(super) missed: Option<Instant>,
    /// Time of the request to end for a restart.
    pub(super) leaving_since: Option<Instant>,
    /// Time at which it is started again.
    pub(super) due: Option<Instant>,
    /// Starts in a row that the system did not allow.
    failed_starts: u32,
}

impl Node {
    /// A node that is not started.
    pub(super) fn new(spec: NodeSpec) -> Self {
        Self {
            spec,
            state: State::Restarting,
            pid: None,
            started: None,
            missed: None,
            leaving_since: None,
            due: None,
            failed_starts: 0,
        }
    }

    /// Its process was started.
    pub(super) fn has_started(&mut self, pid: u32, now: Instant) {
        (self.pid, self.started) = (Some(pid), Some(now));
        (self.missed, self.leaving_since, self.due) = (None, None, None);
        (self.state, self.failed_starts) = (State::Starting, 0);
    }

    /// The system did not allow its start: it is tried again later; false where that was tried too often.
    pub(super) fn put_off(&mut self, now: Instant) -> bool {
        (self.missed, self.leaving_since, self.due) = (None, None, None);
        self.failed_starts += 1;
        let is_hopeful = self.failed_starts < MOST_FAILED;
        if is_hopeful {
            let pause = FIRST_PAUSE.saturating_mul(1 << (self.failed_starts - 1).min(16));
            self.state = State::Restarting;
            self.due = Some(now + pause.min(LONGEST_PAUSE));
        }
        is_hopeful
    }

    /// True if it may be started again after a failure.
    pub(super) fn may_restart(&self) -> bool {
        self.spec.restart == Restart::OnFailure
    }

    /// Longest wait for its token.
    pub(super) fn start_time(&self, config: &RigConfig) -> Duration {
        match (self.spec.role, &config.paint.document) {
            (Role::Paint, Some(_)) => START_TIME_DOCUMENT,
            _ => START_TIME,
        }
    }

    /// Extends its deadline: the launcher was stopped itself.
    pub(super) fn postpone(&mut self, by: Duration) {
        for since in [&mut self.missed, &mut self.leaving_since, &mut self.started] {
            *since = since.map(|since| since + by);
        }
    }
}

/// Times at which nodes failed, by name, kept for nodes that are made again.
#[derive(Debug, Default)]
pub(super) struct Failures(BTreeMap<String, VecDeque<Instant>>);

impl Failures {
    /// Counts a failure of the node called `name`; true where it has failed too often.
    pub(super) fn count(&mut self, name: &str, now: Instant) -> bool {
        let failures = self.0.entry(name.to_owned()).or_default();
        failures.push_back(now);
        failures.retain(|when| now.duration_since(*when) <= WINDOW);
        failures.len() >= FAILURES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::up::plan::{Hands, Window, nodes};

    #[test]
    fn three_failures_in_ten_seconds_are_too_many_whoever_else_fails() {
        let (mut failures, start) = (Failures::default(), Instant::now());
        let mut fails =
            |name: &str, second: u64| failures.count(name, start + Duration::from_secs(second));
        assert!(!fails("player", 0) && !fails("paint", 1) && !fails("player", 2));
        // The first is 11 s ago, so these are two again.
        assert!(!fails("player", 11));
        assert!(!fails("paint", 11));
        assert!(fails("player", 12));
        assert!(fails("player", 13));
        assert!(!fails("player", 30));
    }

    #[test]
    fn starts_that_fail_are_farther_and_farther_apart_and_end_after_a_minute() {
        let mut specs = nodes(&RigConfig::default(), Window::Headless, Hands::Devices);
        let (mut node, mut now) = (Node::new(specs.remove(0)), Instant::now());
        let mut pauses = Vec::new();
        while node.put_off(now) {
            let due = node.due.expect("due");
            pauses.push(due - now);
            now = due;
        }
        assert_eq!(pauses[..2], [FIRST_PAUSE, FIRST_PAUSE * 2]);
        assert!(pauses.is_sorted() && pauses.last() == Some(&LONGEST_PAUSE));
        let all: Duration = pauses.iter().sum();
        assert!((50..70).contains(&all.as_secs()), "{all:?}");
        node.has_started(7, now);
        assert!(node.put_off(now));
        assert_eq!(node.due, Some(now + FIRST_PAUSE));
    }
}
