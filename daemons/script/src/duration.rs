//! Durations of the painting's clock.

use maulstick_types::values::TICKS_A_SECOND;

/// Duration of a number of ticks, ns.
#[must_use]
pub(crate) fn time_ns(ticks: u32) -> u64 {
    u64::from(ticks) * 1_000_000_000 / u64::from(TICKS_A_SECOND)
}
