//! Advance of time while paint dries.

use super::PaintNode;

/// Most ticks entered in a turn: after a time in which the node stood still it catches up bit by bit.
const TICKS_A_TURN: u64 = 60;

impl PaintNode {
    /// Enters the ticks that are due. While nothing dries there are none.
    pub(super) fn let_time_pass(&mut self, now_ns: u64) {
        if !self.sequencer.painting().is_drying() {
            self.ticker = Default::default();
            return;
        }
        for _ in 0..self.ticker.look(now_ns, TICKS_A_TURN) {
            self.sequencer.tick();
        }
    }
}
