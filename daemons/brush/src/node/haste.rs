//! Samples that are too fast for a hand, or for which there is no room: counted in the status, and said once.

use maulstick_brush::speed_limit::FASTEST_M_S;
use maulstick_types::node::NodeWork;

use super::BrushNode;

/// What was logged of them.
#[derive(Debug, Default)]
pub(super) struct Haste {
    too_fast: bool,
    dropped: bool,
}

impl BrushNode {
    /// What this node has done since its start, and what waits.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        let counts = self.samples.counts();
        let waiting = (self.backlog.len() + self.outbox.len()) as u64;
        // While paint has no room for more it is not this node that is late.
        let is_behind = self.states.has_credit() && self.solves_left == 0;
        NodeWork {
            consumed: counts.received,
            produced: self.states.next_seq(),
            waiting: if is_behind { waiting } else { 0 },
            held: if is_behind { 0 } else { waiting },
            refused: counts.refused,
            lost: counts.lost + self.backlog.dropped(),
            too_fast: self.too_fast(),
        }
    }

    /// Samples that were faster than a hand.
    fn too_fast(&self) -> u64 {
        self.model.too_fast() + self.backlog.superseded()
    }

    /// Says once that samples are too fast, and once that there are more of them than can be painted.
    pub(super) fn tell_haste(&mut self) {
        let name = &self.settings.name;
        if self.too_fast() > 0 && !std::mem::replace(&mut self.told_haste.too_fast, true) {
            tracing::warn!(
                "brush '{name}': its stylus moves faster than {FASTEST_M_S} m/s: the brush begins anew at each such \
                 sample, and nothing is painted on the way to it; `maulstick node list` counts them"
            );
        }
        if self.backlog.dropped() > 0 && !std::mem::replace(&mut self.told_haste.dropped, true) {
            tracing::warn!(
                "brush '{name}': samples come faster than they can be painted, and some are dropped; `maulstick \
                 node list` counts them"
            );
        }
    }
}
