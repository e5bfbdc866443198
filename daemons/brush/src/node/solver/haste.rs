//! Samples that are too fast for a hand, or for which there is no room: counted in the status, and logged once.

use maulstick_brush::speed_limit::FASTEST_M_S;

/// Warnings that were logged.
#[derive(Debug, Default)]
pub(super) struct Haste {
    too_fast: bool,
    dropped: bool,
}

impl Haste {
    /// Logs once that samples are too fast, and once that there are more of them than can be painted.
    pub(super) fn warn(&mut self, brush: &str, too_fast: u64, dropped: u64) {
        if too_fast > 0 && !std::mem::replace(&mut self.too_fast, true) {
            tracing::warn!(
                "brush '{brush}': its stylus moves faster than {FASTEST_M_S} m/s: the brush begins anew at each such \
                 sample, and nothing is painted on the way to it; `maulstick node list` counts them"
            );
        }
        if dropped > 0 && !std::mem::replace(&mut self.dropped, true) {
            tracing::warn!(
                "brush '{brush}': samples come faster than they can be painted, and some are dropped; `maulstick \
                 node list` counts them"
            );
        }
    }
}
