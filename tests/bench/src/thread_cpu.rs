//! Time of the processor.

use std::time::Duration;

/// Time of the processor that this thread has had.
pub(crate) fn thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let now = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID);
    now.map_or(Duration::ZERO, Duration::from)
}
