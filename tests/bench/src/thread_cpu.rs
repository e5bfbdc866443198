//! Time of the processor.

use std::time::Duration;

use nix::time::{ClockId, clock_gettime};

/// Time of the processor that this thread has had.
pub(crate) fn thread_cpu() -> Duration {
    had(ClockId::CLOCK_THREAD_CPUTIME_ID)
}

/// Time of the processor that all threads of this process have had.
pub(crate) fn process_cpu() -> Duration {
    had(ClockId::CLOCK_PROCESS_CPUTIME_ID)
}

fn had(clock: ClockId) -> Duration {
    clock_gettime(clock).map_or(Duration::ZERO, Duration::from)
}
