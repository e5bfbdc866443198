//! Slot for the callback of the vendor's scheduler.
//!
//! The scheduler's callbacks carry a bare pointer, and only its manual says when it makes the last call.
//! So it calls a function that looks into this slot, which is filled only while a closure is lent: a late
//! call finds it empty and does nothing. A call that never returns from the vendor's driver can neither be
//! waited for nor be deprived of the closure, so the process aborts.

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

/// Answer of a callback to the scheduler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// Call again in the next tick.
    Again,
    /// Do not call again.
    Done,
}

type Work = dyn FnMut() -> Next + Send;

/// Nothing is lent.
const EMPTY: u8 = 0;
/// A closure is lent and not being called.
const READY: u8 = 1;
/// The closure is being called.
const INSIDE: u8 = 2;
/// A closure is lent but must not be called yet, or no longer.
const CLOSED: u8 = 3;

struct CallbackSlot {
    state: AtomicU8,
    work: UnsafeCell<Option<*mut Work>>,
}

// SAFETY: `work` is touched by whoever has moved `state` from READY to INSIDE or from EMPTY to CLOSED,
// and by nobody else.
unsafe impl Sync for CallbackSlot {}

/// The slot of the process, which has one scheduler.
static SLOT: CallbackSlot = CallbackSlot {
    state: AtomicU8::new(EMPTY),
    work: UnsafeCell::new(None),
};

/// Callback of the scheduler.
pub extern "C" fn call(_: *mut c_void) -> u32 {
    let slot = &SLOT;
    let free = slot
        .state
        .compare_exchange(READY, INSIDE, Ordering::Acquire, Ordering::Relaxed);
    if free.is_err() {
        return next::DONE;
    }
    // SAFETY: INSIDE is ours alone, and what is lent is not taken back before it is left.
    let answer = unsafe { (*slot.work.get()).map(|work| (*work)()) };
    let (state, code) = match answer {
        Some(Next::Again) => (READY, next::CONTINUE),
        _ => (CLOSED, next::DONE),
    };
    slot.state.store(state, Ordering::Release);
    code
}

/// Time after which a call counts as stuck; a tick is a millisecond.
const PATIENCE: Duration = Duration::from_secs(5);
/// Time between two looks.
const GLANCE: Duration = Duration::from_millis(1);

/// Error of a call that is still under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stuck;

/// Closes the slot to new calls, and waits for the one under way.
fn close(patience: Duration) -> Result<(), Stuck> {
    let give_up = Instant::now() + patience;
    let close = || {
        SLOT.state
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

/// Takes the closure back, also on a panic.
struct Lent;

impl Drop for Lent {
    fn drop(&mut self) {
        if close(PATIENCE).is_err() {
            // The borrow must not end, and the scheduler was asked to stop, which takes the force away.
            tracing::error!(
                "the driver of the haptic device does not come back from a call, so this process ends: switch the device off and on, and start the rig anew"
            );
            std::process::abort();
        }
        SLOT.state.store(EMPTY, Ordering::Release);
    }
}

/// Lends `work` to [`call`] while `during` runs. None, without running either, if the slot is taken.
pub fn lend<T>(work: &mut (dyn FnMut() -> Next + Send), during: impl FnOnce() -> T) -> Option<T> {
    let claimed = SLOT
        .state
        .compare_exchange(EMPTY, CLOSED, Ordering::Acquire, Ordering::Relaxed);
    if claimed.is_err() {
        return None;
    }
    let lent = Lent;
    let work: *mut (dyn FnMut() -> Next + Send + '_) = work;
    // SAFETY: the longer life is never used: `Lent` closes the slot before the borrow ends.
    let work =
        unsafe { std::mem::transmute::<*mut (dyn FnMut() -> Next + Send + '_), *mut Work>(work) };
    // SAFETY: the slot is closed, and only its claimant opens it.
    unsafe { *SLOT.work.get() = Some(work) };
    SLOT.state.store(READY, Ordering::Release);
    let done = during();
    drop(lent);
    Some(done)
}

#[cfg(test)]
mod tests {
    use std::sync::{Mutex, PoisonError};

    use super::*;

    /// A process has one slot.
    static TURN: Mutex<()> = Mutex::new(());

    #[test]
    fn what_is_lent_is_called_until_it_is_done_and_a_late_call_finds_nothing() {
        let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let mut calls = 0;
        let mut work = || {
            calls += 1;
            if calls < 3 { Next::Again } else { Next::Done }
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
