//! The servo's own clock: absolute deadlines on `CLOCK_MONOTONIC`, a millisecond apart.

use std::ops::ControlFlow;

use nix::sys::time::TimeSpec;
use nix::time::{ClockId, ClockNanosleepFlags, clock_gettime, clock_nanosleep};

use crate::device::driver::{DeviceError, ServoClock};

/// Period of the servo, ns.
pub const PERIOD_NS: u64 = 1_000_000;

/// `CLOCK_MONOTONIC`, ns.
#[must_use]
pub fn monotonic_ns() -> u64 {
    clock_gettime(ClockId::CLOCK_MONOTONIC).map_or(0, |time| {
        time.tv_sec() as u64 * 1_000_000_000 + time.tv_nsec() as u64
    })
}

fn sleep_until(deadline_ns: u64) {
    let time = TimeSpec::new(
        (deadline_ns / 1_000_000_000) as i64,
        (deadline_ns % 1_000_000_000) as i64,
    );
    clock_nanosleep(
        ClockId::CLOCK_MONOTONIC,
        ClockNanosleepFlags::TIMER_ABSTIME,
        &time,
    )
    .ok();
}

/// The system's monotonic clock, on the servo's own thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct MonotonicClock;

impl ServoClock for MonotonicClock {
    fn run(
        &mut self,
        tick: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), DeviceError> {
        let mut deadline_ns = monotonic_ns() + PERIOD_NS;
        loop {
            sleep_until(deadline_ns);
            if tick(monotonic_ns().saturating_sub(deadline_ns)).is_break() {
                return Ok(());
            }
            // After an overrun the next deadline is the next grid point: no burst to catch up.
            deadline_ns += PERIOD_NS;
            let now_ns = monotonic_ns();
            if deadline_ns <= now_ns {
                deadline_ns += (now_ns - deadline_ns).div_ceil(PERIOD_NS) * PERIOD_NS;
            }
        }
    }
}
