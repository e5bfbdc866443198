//! The vendor's clock: its scheduler calls the servo, on a thread of its own.
//!
//! The thread that runs it waits beside and does what is no work for a real-time thread: it asks for a
//! look at the calibration each second, and tells what the device has to say. It calls nothing of the
//! library that needs a frame or takes an error meanwhile. However the servo ends, a frame
//! without force is the last one before the scheduler stops; then its callback goes, and with the
//! session the device.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::park_timeout;
use std::time::{Duration, Instant};

use super::abi::{MAX_SCHEDULER_PRIORITY, RATE_HZ};
use super::calibration::Standing;
use super::faults::Notice;
use super::library::{Library, Scheduled};
use super::seat::{Next, call, lend};
use super::session::Session;
use crate::driver::{Caller, Pace, Trouble};
use crate::pace::{PERIOD_NS, monotonic_ns};

/// Time between two looks at the calibration.
const LOOK: Duration = Duration::from_secs(1);
/// Time between two looks at what there is to tell.
const GLANCE: Duration = Duration::from_millis(50);
/// A scheduler that has not called for so long is dead.
const STALLED: Duration = Duration::from_secs(2);
/// What is told is not told again for so long.
const TOLD: Duration = Duration::from_secs(10);

const DEAD: Trouble = Trouble {
    what: "the vendor's scheduler does not call the servo",
    code: 0,
    help: "plug the haptic device in again, and run the vendor's diagnostic program if it comes again",
};
const IN_USE: Trouble = Trouble {
    what: "another servo of this process runs on the vendor's scheduler",
    code: 0,
    help: "give each haptic device its own daemon",
};

/// The vendor's clock over a device.
pub struct VendorClock {
    session: Arc<Session>,
    notices: Notices,
    /// What was told of the calibration.
    heard: Standing,
    /// The device's name, for what is told.
    name: String,
}

impl VendorClock {
    /// The clock of a session, for the device of this name.
    #[must_use]
    pub fn new(session: Arc<Session>, name: String) -> Self {
        Self {
            session,
            notices: Notices::default(),
            heard: Standing::Calibrated,
            name,
        }
    }
}

/// What the scheduler's thread and the waiting one share.
#[derive(Default)]
struct Calls {
    count: AtomicU64,
    /// There are no more.
    over: AtomicBool,
}

impl Pace for VendorClock {
    fn run(
        &mut self,
        beat: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), Trouble> {
        // What is asked of no device in particular is asked of this thread's.
        self.session.library.make_current(self.session.device);
        let calls = Calls::default();
        let (session, waiting) = (Arc::clone(&self.session), std::thread::current());
        let (mut before_ns, mut is_beating, mut panic) = (None, true, None);
        let mut work = || {
            calls.count.fetch_add(1, Ordering::Relaxed);
            if is_beating {
                let now_ns = monotonic_ns();
                let due_ns = before_ns.map_or(now_ns, |before_ns| before_ns + PERIOD_NS);
                before_ns = Some(now_ns);
                // A panic that unwinds into C is undefined.
                match catch_unwind(AssertUnwindSafe(|| beat(now_ns.saturating_sub(due_ns)))) {
                    Ok(ControlFlow::Continue(())) => return Next::Again,
                    Ok(ControlFlow::Break(())) => {}
                    Err(payload) => panic = Some(payload),
                }
                is_beating = false;
                session.quieten();
                if session.has_force() {
                    return Next::Again;
                }
            } else {
                session.begin();
                session.quieten();
                session.trouble();
            }
            calls.over.store(true, Ordering::Release);
            waiting.unpark();
            Next::Done
        };
        let served = lend(&mut work, || self.serve(&calls));
        self.tell();
        match panic {
            // It goes on where it would have gone from our own clock.
            Some(payload) => resume_unwind(payload),
            None => served.unwrap_or(Err(IN_USE)),
        }
    }

    fn caller(&self) -> Caller {
        Caller::Vendor
    }
}

impl VendorClock {
    /// Has the scheduler call until it is over.
    fn serve(&mut self, calls: &Calls) -> Result<(), Trouble> {
        let library = self.session.library;
        // A model that has one rate only says that it cannot be set: it is this one.
        library.set_rate(RATE_HZ);
        library.forget_errors();
        let scheduled = library.schedule(call, MAX_SCHEDULER_PRIORITY);
        if let Some(trouble) = self.session.trouble() {
            return Err(trouble);
        }
        let mut running = Running {
            library,
            scheduled: Some(scheduled),
        };
        library.start_scheduler();
        self.wait(calls, &mut running)
    }

    /// Waits until the calls are over, and looks after the device meanwhile.
    fn wait(&mut self, calls: &Calls, running: &mut Running) -> Result<(), Trouble> {
        let mut pulse = Pulse::new(calls);
        let mut look = Instant::now() + LOOK;
        while !calls.over.load(Ordering::Acquire) {
            if pulse.is_dead() {
                // Only now are the errors ours.
                running.stop();
                return Err(self.session.trouble().unwrap_or(DEAD));
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

    /// Tells what the device has had to say.
    fn tell(&mut self) {
        for notice in self.notices.due(self.session.take_told(), Instant::now()) {
            tracing::warn!("{}: {}", self.name, notice.words());
        }
        let standing = self.session.standing();
        if standing != self.heard {
            if let Some(words) = standing.words() {
                tracing::warn!("{}: {words}", self.name);
                self.heard = standing;
            } else if standing == Standing::Calibrated {
                tracing::info!("{}: the device is calibrated", self.name);
                self.heard = standing;
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

/// Whether calls still come.
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

/// What has been told, and when.
#[derive(Debug, Default)]
struct Notices {
    told: [Option<Instant>; Notice::ALL.len()],
    is_over: bool,
}

impl Notices {
    /// Those of a mask that were not told of late.
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
