//! The vendor's clock: its scheduler calls the servo, on a thread of its own.
//!
//! The thread that runs it waits beside and does what is no work for a real-time thread: it looks at
//! the calibration each second, and tells what the device has to say. However the servo ends, a frame
//! without force is the last one before the scheduler stops; then its callback goes, and with the
//! session the device.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::park_timeout;
use std::time::{Duration, Instant};

use super::abi::{MAX_SCHEDULER_PRIORITY, RATE_HZ};
use super::calibration::Calibration;
use super::faults::Notice;
use super::library::{Library, Scheduled};
use super::seat::{Next, call, lend};
use super::session::Session;
use crate::driver::{Pace, Trouble};
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
    calibration: Calibration,
    notices: Notices,
    /// The device's name, for what is told.
    name: String,
}

impl VendorClock {
    /// The clock of a session, for the device of this name.
    #[must_use]
    pub fn new(session: Arc<Session>, calibration: Calibration, name: String) -> Self {
        Self {
            session,
            calibration,
            notices: Notices::default(),
            name,
        }
    }
}

/// What the scheduler's thread and the waiting one share.
#[derive(Default)]
struct Calls {
    count: AtomicU64,
    /// The waiting thread wants no more.
    enough: AtomicBool,
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
        self.calibration.before_start(&self.session)?;
        let calls = Calls::default();
        let (session, waiting) = (Arc::clone(&self.session), std::thread::current());
        let (mut before_ns, mut is_beating, mut panic) = (None, true, None);
        let mut work = || {
            calls.count.fetch_add(1, Ordering::Relaxed);
            if is_beating && !calls.enough.load(Ordering::Relaxed) {
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
        let _running = Running { library, scheduled };
        library.start_scheduler();
        if let Some(trouble) = self.session.trouble() {
            return Err(trouble);
        }
        self.wait(calls)
    }

    /// Waits until the calls are over, and looks after the device meanwhile.
    fn wait(&mut self, calls: &Calls) -> Result<(), Trouble> {
        let mut pulse = Pulse::new(calls);
        let (mut look, mut ending) = (Instant::now(), None);
        while !calls.over.load(Ordering::Acquire) {
            if pulse.is_dead() {
                return Err(ending.unwrap_or(DEAD));
            }
            if ending.is_none() && Instant::now() >= look {
                look = Instant::now() + LOOK;
                match self.calibration.look(&self.session, || settle(calls)) {
                    Ok(Some(words)) => tracing::warn!("{}: {words}", self.name),
                    Ok(None) => {}
                    Err(trouble) => {
                        calls.enough.store(true, Ordering::Relaxed);
                        ending = Some(trouble);
                    }
                }
            }
            self.tell();
            park_timeout(GLANCE);
        }
        ending.map_or(Ok(()), Err)
    }

    /// Tells what the device has had to say.
    fn tell(&mut self) {
        for notice in self.notices.due(self.session.take_told(), Instant::now()) {
            tracing::warn!("{}: {}", self.name, notice.words());
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

/// Waits until two more calls have come, so that one has begun since.
fn settle(calls: &Calls) {
    let from = calls.count.load(Ordering::Relaxed);
    let mut pulse = Pulse::new(calls);
    while calls.count.load(Ordering::Relaxed) < from + 2
        && !calls.over.load(Ordering::Acquire)
        && !pulse.is_dead()
    {
        park_timeout(Duration::from_nanos(PERIOD_NS));
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
    scheduled: Scheduled,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.library.stop_scheduler();
        self.library.unschedule(self.scheduled);
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
