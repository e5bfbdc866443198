//! The vendor's clock: its scheduler calls the servo, on a thread of its own.
//!
//! The thread that runs it waits meanwhile and does the work that does not belong on a real-time thread: it
//! asks for a check of the calibration each second and logs the device's notices. Meanwhile it calls nothing
//! of the library that needs a frame or takes an error. However the servo ends, the last frame before the
//! scheduler stops is one without force; then its callback is removed, and with the session the device.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::park_timeout;
use std::time::{Duration, Instant};

use super::abi::{MAX_SCHEDULER_PRIORITY, RATE_HZ};
use super::calibration_state::CalibrationState;
use super::callback_slot::{Next, call, lend};
use super::faults::Notice;
use super::library::{Library, Scheduled};
use super::session::Session;
use crate::device::driver::{Caller, DeviceError, ServoClock};
use crate::servo::clock::{PERIOD_NS, monotonic_ns};

/// Time between two checks of the calibration.
const LOOK: Duration = Duration::from_secs(1);
/// Time between two looks for notices.
const GLANCE: Duration = Duration::from_millis(50);
/// Time without a call after which the scheduler counts as dead.
const STALLED: Duration = Duration::from_secs(2);
/// Time before a notice is repeated.
const TOLD: Duration = Duration::from_secs(10);

/// The scheduler never called, or stopped.
pub const DEAD: DeviceError = DeviceError {
    what: "the vendor's scheduler does not call the servo",
    code: 0,
    help: "plug the haptic device in again, and run the vendor's diagnostic program if it comes again",
};
const IN_USE: DeviceError = DeviceError {
    what: "another servo of this process runs on the vendor's scheduler",
    code: 0,
    help: "give each haptic device its own daemon",
};

/// The vendor's clock over a device.
pub struct VendorClock {
    session: Arc<Session>,
    notices: Notices,
    /// Calibration state logged last.
    heard: CalibrationState,
    /// Name of the device in the log.
    name: String,
}

impl VendorClock {
    /// The clock of a session, for the device of this name.
    #[must_use]
    pub fn new(session: Arc<Session>, name: String) -> Self {
        Self {
            session,
            notices: Notices::default(),
            heard: CalibrationState::Calibrated,
            name,
        }
    }
}

/// State shared by the scheduler's thread and the waiting one.
#[derive(Default)]
struct Calls {
    count: AtomicU64,
    /// True after the last call.
    over: AtomicBool,
}

impl ServoClock for VendorClock {
    fn run(
        &mut self,
        tick: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), DeviceError> {
        // Calls that name no device refer to this thread's current one.
        self.session.library.make_current(self.session.device);
        let calls = Calls::default();
        let (session, waiting) = (Arc::clone(&self.session), std::thread::current());
        let (mut before_ns, mut is_running, mut panic) = (None, true, None);
        let mut work = || {
            calls.count.fetch_add(1, Ordering::Relaxed);
            if is_running {
                let now_ns = monotonic_ns();
                let due_ns = before_ns.map_or(now_ns, |before_ns| before_ns + PERIOD_NS);
                before_ns = Some(now_ns);
                // A panic that unwinds into C is undefined.
                match catch_unwind(AssertUnwindSafe(|| tick(now_ns.saturating_sub(due_ns)))) {
                    Ok(ControlFlow::Continue(())) => return Next::Again,
                    Ok(ControlFlow::Break(())) => {}
                    Err(payload) => panic = Some(payload),
                }
                is_running = false;
                session.quieten();
                if session.has_force() {
                    return Next::Again;
                }
            } else {
                session.begin();
                session.quieten();
                session.take_error();
            }
            calls.over.store(true, Ordering::Release);
            waiting.unpark();
            Next::Done
        };
        let served = lend(&mut work, || self.serve(&calls));
        self.tell();
        match panic {
            // Unwinds as it would from the system's clock.
            Some(payload) => resume_unwind(payload),
            None => served.unwrap_or(Err(IN_USE)),
        }
    }

    fn caller(&self) -> Caller {
        Caller::Vendor
    }
}

impl VendorClock {
    /// Runs the scheduler until the calls are over.
    fn serve(&mut self, calls: &Calls) -> Result<(), DeviceError> {
        let library = self.session.library;
        // A model with a single rate refuses to set it, but that rate is this one.
        library.set_rate(RATE_HZ);
        library.forget_errors();
        let scheduled = library.schedule(call, MAX_SCHEDULER_PRIORITY);
        if let Some(error) = self.session.take_error() {
            return Err(error);
        }
        let mut running = Running {
            library,
            scheduled: Some(scheduled),
        };
        library.start_scheduler();
        self.wait(calls, &mut running)
    }

    /// Waits until the calls are over, and serves the device meanwhile.
    fn wait(&mut self, calls: &Calls, running: &mut Running) -> Result<(), DeviceError> {
        let mut pulse = Pulse::new(calls);
        let mut look = Instant::now() + LOOK;
        while !calls.over.load(Ordering::Acquire) {
            if pulse.is_dead() {
                // Only now may this thread take errors.
                running.stop();
                return Err(self.session.take_error().unwrap_or(DEAD));
            }
            if Instant::now() >= look {
                look = Instant::now() + LOOK;
                self.session.ask_look();
            }
            self.tell();
            park_timeout(GLANCE);
        }
        Ok(())
    }

    /// Logs the device's notices.
    fn tell(&mut self) {
        for notice in self.notices.due(self.session.take_told(), Instant::now()) {
            tracing::warn!("{}: {}", self.name, notice.words());
        }
        let state = self.session.calibration();
        if state != self.heard {
            if let Some(words) = state.words() {
                tracing::warn!("{}: {words}", self.name);
                self.heard = state;
            } else if state == CalibrationState::Calibrated {
                tracing::info!("{}: the device is calibrated", self.name);
                self.heard = state;
            }
        }
        if let Some((code, internal)) = self.session.ended()
            && !std::mem::replace(&mut self.notices.is_over, true)
        {
            let words = self.session.library.error_words(code);
            tracing::warn!(
                "{}: the library says '{words}' ({code:#x}, internal {internal})",
                self.name
            );
        }
    }
}

/// Watchdog over the scheduler's calls.
struct Pulse<'a> {
    calls: &'a Calls,
    seen: u64,
    since: Instant,
}

impl<'a> Pulse<'a> {
    fn new(calls: &'a Calls) -> Self {
        Self {
            calls,
            seen: calls.count.load(Ordering::Relaxed),
            since: Instant::now(),
        }
    }

    fn is_dead(&mut self) -> bool {
        let now = self.calls.count.load(Ordering::Relaxed);
        if now != self.seen {
            (self.seen, self.since) = (now, Instant::now());
        }
        self.since.elapsed() > STALLED
    }
}

/// A running scheduler.
struct Running {
    library: &'static Library,
    scheduled: Option<Scheduled>,
}

impl Running {
    fn stop(&mut self) {
        if let Some(scheduled) = self.scheduled.take() {
            self.library.stop_scheduler();
            self.library.unschedule(scheduled);
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop();
        self.library.forget_errors();
    }
}

/// Notices logged so far, with their times.
#[derive(Debug, Default)]
struct Notices {
    told: [Option<Instant>; Notice::ALL.len()],
    is_over: bool,
}

impl Notices {
    /// The notices of a mask that were not logged recently.
    fn due(&mut self, mask: u32, now: Instant) -> Vec<Notice> {
        let mut due = Vec::new();
        for (notice, told) in Notice::ALL.into_iter().zip(&mut self.told) {
            let is_old = told.is_none_or(|told| now.duration_since(told) >= TOLD);
            if mask & notice.bit() != 0 && is_old {
                *told = Some(now);
                due.push(notice);
            }
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_on_is_told_now_and_then() {
        let mut notices = Notices::default();
        let start = Instant::now();
        let after = |seconds| start + Duration::from_secs(seconds);
        let warm = Notice::WarmMotors.bit();
        assert_eq!(notices.due(warm, start), [Notice::WarmMotors]);
        assert_eq!(notices.due(warm, after(9)), []);
        let both = warm | Notice::TooFastForce.bit();
        assert_eq!(notices.due(both, after(9)), [Notice::TooFastForce]);
        assert_eq!(notices.due(both, after(10)), [Notice::WarmMotors]);
        assert_eq!(notices.due(0, after(99)), []);
    }
}
