//! Our own clock: absolute deadlines a millisecond apart.

use std::ops::ControlFlow;

use nix::sys::time::TimeSpec;
use nix::time::{ClockId, ClockNanosleepFlags, clock_gettime, clock_nanosleep};

use crate::driver::{Pace, Trouble};

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

/// Our own clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct OwnClock;

impl Pace for OwnClock {
    fn run(
        &mut self,
        beat: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), Trouble> {
        let mut deadline_ns = monotonic_ns() + PERIOD_NS;
        loop {
            sleep_until(deadline_ns);
            if beat(monotonic_ns().saturating_sub(deadline_ns)).is_break() {
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
