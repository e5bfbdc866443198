//! Advance of time while paint dries.

use maulstick_painting::Sequencer;
use maulstick_session::ticker::Ticker;

/// Most ticks entered in a turn: after a time in which the node stood still it catches up bit by bit.
const TICKS_A_TURN: u64 = 60;

/// Clock of the paint that dries.
#[derive(Debug, Default)]
pub(super) struct DryingClock {
    ticker: Ticker,
}

impl DryingClock {
    /// Enters the ticks that are due. While nothing dries there are none.
    pub(super) fn advance(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        if !sequencer.painting().is_drying() {
            self.ticker = Ticker::default();
            return;
        }
        for _ in 0..self.ticker.look(now_ns, TICKS_A_TURN) {
            sequencer.tick();
        }
    }
}
