//! The rig's clock: the machine's monotonic clock plus an offset that the launcher fixes once.
//!
//! Its stamps look like nanoseconds since 1970 and never step, whatever happens to wall time.

use nix::time::{ClockId, clock_gettime};

/// The clock of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigClock {
    offset_ns: u64,
}

fn read(clock: ClockId) -> u64 {
    clock_gettime(clock).map_or(0, |time| {
        let seconds = u64::try_from(time.tv_sec()).unwrap_or(0);
        seconds * 1_000_000_000 + u64::try_from(time.tv_nsec()).unwrap_or(0)
    })
}

impl RigClock {
    /// A clock that shows wall time now.
    #[must_use]
    pub fn start() -> Self {
        let wall = read(ClockId::CLOCK_REALTIME);
        Self {
            offset_ns: wall.saturating_sub(read(ClockId::CLOCK_MONOTONIC)),
        }
    }

    /// The clock of a rig that is already running.
    #[must_use]
    pub fn with_offset(offset_ns: u64) -> Self {
        Self { offset_ns }
    }

    /// Offset from `CLOCK_MONOTONIC`, ns.
    #[must_use]
    pub fn offset_ns(self) -> u64 {
        self.offset_ns
    }

    /// Now, ns.
    #[must_use]
    pub fn now_ns(self) -> u64 {
        read(ClockId::CLOCK_MONOTONIC) + self.offset_ns
    }
}
