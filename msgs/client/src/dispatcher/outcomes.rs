//! Outcomes on their way to the window.

use super::Outcome;

/// Outcomes that the window has not taken, and when the oldest of those for which strokes wait was asked for, ns.
#[derive(Debug, Default)]
pub(super) struct Outcomes {
    pub(super) list: Vec<Outcome>,
    pub(super) oldest_ns: Option<u64>,
}

impl Outcomes {
    pub(super) fn push(&mut self, outcome: Outcome, asked_ns: Option<u64>) {
        self.list.push(outcome);
        self.oldest_ns = self.oldest_ns.into_iter().chain(asked_ns).min();
    }
}
