//! Where the vendor's scheduler finds what it is to call.
//!
//! Its callbacks carry a bare pointer, and nothing but its manual says when it makes the last call.
//! So it calls a function that looks here, where there is something only while it is lent: a call
//! that comes late finds nothing, and does nothing. A call that never comes back from the vendor's
//! driver cannot be waited for, nor can what it uses be taken from it: the process ends.

#![allow(
    unsafe_code,
    reason = "a borrow that another thread uses while its owner waits"
)]

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::atomic::{AtomicU8, Ordering};
use std::thread::park_timeout;
use std::time::{Duration, Instant};

use super::abi::next;

/// Whether to be called again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// In the next tick.
    Again,
    /// Never.
    Done,
}

type Work = dyn FnMut() -> Next + Send;

/// Nothing is lent.
const EMPTY: u8 = 0;
/// Something is lent, and nobody is calling it.
const READY: u8 = 1;
/// It is being called.
const INSIDE: u8 = 2;
/// Something is lent that is not to be called yet, or not any more.
const CLOSED: u8 = 3;

struct Seat {
    state: AtomicU8,
    work: UnsafeCell<Option<*mut Work>>,
}

// SAFETY: `work` is touched by whoever has moved `state` from READY to INSIDE or from EMPTY to CLOSED,
// and by nobody else.
unsafe impl Sync for Seat {}

/// There is one scheduler in a process.
static SEAT: Seat = Seat {
    state: AtomicU8::new(EMPTY),
    work: UnsafeCell::new(None),
};

/// What the scheduler calls.
pub extern "C" fn call(_: *mut c_void) -> u32 {
    let seat = &SEAT;
    let free = seat
        .state
        .compare_exchange(READY, INSIDE, Ordering::Acquire, Ordering::Relaxed);
    if free.is_err() {
        return next::DONE;
    }
    // SAFETY: INSIDE is ours alone, and what is lent is not taken back before it is left.
    let answer = unsafe { (*seat.work.get()).map(|work| (*work)()) };
    let (state, code) = match answer {
        Some(Next::Again) => (READY, next::CONTINUE),
        _ => (CLOSED, next::DONE),
    };
    seat.state.store(state, Ordering::Release);
    code
}

/// A call that has not come back for so long never does: a tick is a millisecond.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time between two looks whether it has.
const GLANCE: Duration = Duration::from_millis(1);

/// A call is still under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stuck;

/// Has no call begin any more, and waits for the one that runs.
fn close(patience: Duration) -> Result<(), Stuck> {
    let give_up = Instant::now() + patience;
    let close = || {
        SEAT.state
            .compare_exchange(READY, CLOSED, Ordering::Acquire, Ordering::Acquire)
    };
    while close() == Err(INSIDE) {
        if Instant::now() >= give_up {
            return Err(Stuck);
        }
        park_timeout(GLANCE);
    }
    Ok(())
}

/// Takes back what was lent, also if what goes on meanwhile panics.
struct Lent;

impl Drop for Lent {
    fn drop(&mut self) {
        if close(PATIENCE).is_err() {
            // The borrow must not end, and the scheduler was told to stop, which takes the force away.
            tracing::error!(
                "the driver of the haptic device does not come back from a call, so this process ends: switch the device off and on, and start the rig anew"
            );
            std::process::abort();
        }
        SEAT.state.store(EMPTY, Ordering::Release);
    }
}

/// Lends `work` to [`call`] while `during` runs. None, and neither is run, where something is lent
/// already.
pub fn lend<T>(work: &mut (dyn FnMut() -> Next + Send), during: impl FnOnce() -> T) -> Option<T> {
    let claimed = SEAT
        .state
        .compare_exchange(EMPTY, CLOSED, Ordering::Acquire, Ordering::Relaxed);
    if claimed.is_err() {
        return None;
    }
    let lent = Lent;
    let work: *mut (dyn FnMut() -> Next + Send + '_) = work;
    // SAFETY: the longer life is never used: `Lent` closes the seat before the borrow ends.
    let work =
        unsafe { std::mem::transmute::<*mut (dyn FnMut() -> Next + Send + '_), *mut Work>(work) };
    // SAFETY: the seat is closed, and only who has claimed it opens it.
    unsafe { *SEAT.work.get() = Some(work) };
    SEAT.state.store(READY, Ordering::Release);
    let done = during();
    drop(lent);
    Some(done)
}

#[cfg(test)]
mod tests {
    use std::sync::{Mutex, PoisonError};

    use super::*;

    /// A process has one seat.
    static TURN: Mutex<()> = Mutex::new(());

    #[test]
    fn what_is_lent_is_called_until_it_is_done_and_a_late_call_finds_nothing() {
        let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let mut calls = 0;
        let mut work = || {
            calls += 1;
            match calls < 3 {
                true => Next::Again,
                false => Next::Done,
            }
        };
        let codes = lend(&mut work, || {
            let inner = lend(&mut || Next::Done, || ());
            assert_eq!(inner, None, "one at a time");
            [(); 5].map(|()| call(std::ptr::null_mut()))
        });
        assert_eq!(codes, Some([1, 1, 0, 0, 0]));
        assert_eq!((calls, call(std::ptr::null_mut())), (3, 0));
        assert!(lend(&mut || Next::Done, || ()).is_some());
    }

    #[test]
    fn a_call_that_runs_is_waited_for() {
        let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let (entered, has_entered) = std::sync::mpsc::channel();
        let (leave, may_leave) = std::sync::mpsc::channel::<()>();
        let mut left = false;
        let leaving = &mut left;
        let mut work = move || {
            entered.send(()).ok();
            may_leave.recv().ok();
            *leaving = true;
            Next::Again
        };
        let mut caller = None;
        let lent = lend(&mut work, || {
            caller = Some(std::thread::spawn(|| call(std::ptr::null_mut())));
            has_entered.recv().ok();
            assert_eq!(close(GLANCE), Err(Stuck), "it is not waited for for ever");
            leave.send(()).ok();
        });
        assert_eq!(lent, Some(()));
        assert!(left, "what is lent is done before it is taken back");
        assert_eq!(caller.map(|caller| caller.join().ok()), Some(Some(1)));
    }
}
