//! Time limits for the start of nodes.

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

impl Supervisor {
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
                    if node.spec.role == Role::Recorder {
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
