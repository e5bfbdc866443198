//! Starts of nodes: their time limits, and those that the system does not allow.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use maulstick_rig::{RigConfig, UserError};

use super::Supervisor;
use crate::up::child::{Node, State};
use crate::up::plan::Role;

/// A node shows its token within this time, or it counts as failed.
const START_TIME: Duration = Duration::from_secs(30);
/// The same for the paint node of a document: a fill of a vast canvas may have to be done again.
const START_TIME_DOCUMENT: Duration = Duration::from_secs(600);
/// Longest wait for a node's token.
pub(super) fn start_time(role: Role, config: &RigConfig) -> Duration {
    match (role, &config.paint.document) {
        (Role::Paint, Some(_)) => START_TIME_DOCUMENT,
        _ => START_TIME,
    }
}

/// Pause after the first start that the system did not allow; after each further one it is twice as long, up to
/// [`LONGEST_PAUSE`].
const FIRST_PAUSE: Duration = Duration::from_millis(200);
/// See [`FIRST_PAUSE`].
const LONGEST_PAUSE: Duration = Duration::from_secs(5);
/// So many of them in a row, a minute's, are too many.
const MOST_FAILED: u32 = 16;

/// Starts in a row that the system did not allow, by the name of the node.
#[derive(Debug, Default)]
pub(super) struct FailedStarts(BTreeMap<String, u32>);

impl FailedStarts {
    /// Counts one, and returns the pause before the next attempt; `None` where there were too many.
    fn count(&mut self, name: &str) -> Option<Duration> {
        let failed = self.0.entry(name.to_owned()).or_default();
        *failed += 1;
        let pause = FIRST_PAUSE.saturating_mul(1 << (*failed - 1).min(16));
        (*failed < MOST_FAILED).then_some(pause.min(LONGEST_PAUSE))
    }

    /// A node was started.
    pub(super) fn forget(&mut self, name: &str) {
        self.0.remove(name);
    }
}

impl Supervisor {
    /// A node that the system did not start, as where memory or processes are short, is tried again later: the others
    /// paint on.
    ///
    /// # Errors
    /// The fault, where that does not help a node that the rig cannot do without.
    pub(super) fn put_off(&mut self, place: usize, fault: UserError) -> Result<(), UserError> {
        let node = &mut self.nodes[place];
        let name = node.spec.name.clone();
        (node.missed, node.leaving_since) = (None, None);
        self.due.retain(|(due, _)| *due != name);
        match self.failed_starts.count(&name) {
            Some(pause) => {
                tracing::warn!("{}; it is tried again", fault.what);
                node.state = State::Restarting;
                self.due.push((name, Instant::now() + pause));
                Ok(())
            }
            None if node.spec.role.is_spare() => {
                tracing::error!("{}; it is not tried again", fault.what);
                node.state = State::Failed;
                Ok(())
            }
            None => Err(fault),
        }
    }

    /// A node that shows no token in time is killed, and with that has failed.
    pub(super) fn watch_starts(&mut self) -> Result<(), UserError> {
        let now = Instant::now();
        // The switch itself sees to the painting that it opens.
        let is_opening = self.is_opening(Role::Paint);
        let starting = |node: &&mut Node| {
            node.state == State::Starting && !(is_opening && node.spec.role == Role::Paint)
        };
        for node in self.nodes.iter_mut().filter(starting) {
            let since = self
                .started
                .iter()
                .find(|(name, _)| *name == node.spec.name);
            let limit = start_time(node.spec.role, &self.config);
            if since.is_some_and(|(_, since)| now - *since > limit) {
                tracing::warn!("node '{}' does not get ready", node.spec.name);
                node.terminate();
                node.kill();
                if !node.fail(&mut self.failures) {
                    if node.spec.role.is_spare() {
                        tracing::error!("node '{}' is not started again", node.spec.name);
                        continue;
                    }
                    return Err(UserError::failure(format!(
                        "node '{}' does not get ready",
                        node.spec.name
                    ))
                    .help("its own messages above say why"));
                }
                self.due.push((node.spec.name.clone(), now));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_that_fail_are_farther_and_farther_apart_and_end_after_a_minute() {
        let mut failed = FailedStarts::default();
        let pauses: Vec<Duration> = std::iter::from_fn(|| failed.count("paint")).collect();
        assert_eq!(pauses[..2], [FIRST_PAUSE, FIRST_PAUSE * 2]);
        assert!(pauses.is_sorted() && pauses.last() == Some(&LONGEST_PAUSE));
        let all: Duration = pauses.iter().sum();
        assert!((50..70).contains(&all.as_secs()), "{all:?}");
        assert_eq!(failed.count("brush-main"), Some(FIRST_PAUSE));
        failed.forget("paint");
        assert_eq!(failed.count("paint"), Some(FIRST_PAUSE));
    }
}
