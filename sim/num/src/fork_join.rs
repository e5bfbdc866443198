//! Work that two cores share.
//!
//! Which core does what never matters to what comes out: jobs that run beside each other write to
//! different places, and what they find is put together in the same order.
//!
//! The jobs are tens of microseconds long and follow each other as closely, so the helper waits for
//! the next awake. Pools of threads that sleep in between (rayon) take longer to wake than the jobs
//! take.

use std::any::Any;
use std::cell::{RefCell, UnsafeCell};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::thread::{Builder, Thread, available_parallelism, park, scope, yield_now};
use std::time::Instant;

/// Spin iterations before yielding the core.
const SPIN_LIMIT: u32 = 2_000;
/// Iterations, spinning and yielding, before sleeping.
const AWAKE: u32 = SPIN_LIMIT + 200;

/// Nothing to do.
const EMPTY: u32 = 0;
/// A job lies there.
const OFFERED: u32 = 1;
/// One of the two threads does it.
const TAKEN: u32 = 2;
/// It is done.
const DONE: u32 = 3;
/// No more jobs come.
const CLOSED: u32 = 4;

type Job<'a> = dyn FnMut() + Send + 'a;

/// Where one thread leaves a job for the other.
#[derive(Default)]
struct JobSlot {
    state: AtomicU32,
    sleeping: AtomicBool,
    job: UnsafeCell<Option<NonNull<Job<'static>>>>,
    panic: UnsafeCell<Option<Box<dyn Any + Send>>>,
}

#[allow(
    unsafe_code,
    reason = "a slot hands a job from one thread to the other"
)]
// SAFETY: `job` and `panic` are used by the owner while the state is EMPTY or DONE, and by the thread that
// has made it TAKEN while it is; the state's releases and acquires order the accesses.
unsafe impl Sync for JobSlot {}
#[allow(
    unsafe_code,
    reason = "a slot hands a job from one thread to the other"
)]
// SAFETY: the job is `Send`, and its pointer is used as told above alone.
unsafe impl Send for JobSlot {}

thread_local! {
    static HELP: RefCell<Option<(Arc<JobSlot>, Thread)>> = const { RefCell::new(None) };
}

impl JobSlot {
    /// Does what is offered until the desk is closed.
    fn serve(&self) {
        let mut looks = 0;
        loop {
            match self.state.load(Ordering::Acquire) {
                CLOSED => return,
                OFFERED => {
                    let (from, to) = (Ordering::Acquire, Ordering::Relaxed);
                    let taken = self.state.compare_exchange(OFFERED, TAKEN, from, to);
                    if taken.is_ok() {
                        self.perform();
                        self.state.store(DONE, Ordering::Release);
                    }
                    looks = 0;
                }
                _ if looks < SPIN_LIMIT => std::hint::spin_loop(),
                _ if looks < AWAKE => yield_now(),
                _ => self.sleep(),
            }
            looks = looks.saturating_add(1);
        }
    }

    fn sleep(&self) {
        self.sleeping.store(true, Ordering::SeqCst);
        if !matches!(self.state.load(Ordering::SeqCst), OFFERED | CLOSED) {
            park();
        }
        self.sleeping.store(false, Ordering::SeqCst);
    }

    fn perform(&self) {
        #[allow(
            unsafe_code,
            reason = "the job lives on the stack of the thread that offers it"
        )]
        // SAFETY: the state is TAKEN, so this thread alone uses both cells, and the owner waits for DONE
        // before the job goes.
        unsafe {
            if let Some(mut job) = *self.job.get() {
                let outcome = catch_unwind(AssertUnwindSafe(|| job.as_mut()()));
                *self.panic.get() = outcome.err();
            }
        }
    }

    /// Offers a job; what is returned does or awaits it when dropped.
    fn offer<'a>(&'a self, job: &'a mut Job<'a>, helper: &Thread) -> Offer<'a> {
        let job = NonNull::from(job);
        #[allow(
            unsafe_code,
            reason = "the job lives on the stack of the thread that offers it"
        )]
        // SAFETY: only the lifetime changes; the offer holds the borrow and does not end before the job
        // is done. The state is EMPTY, so this thread alone uses the cell.
        unsafe {
            let job = std::mem::transmute::<NonNull<Job<'a>>, NonNull<Job<'static>>>(job);
            *self.job.get() = Some(job);
        }
        self.state.store(OFFERED, Ordering::SeqCst);
        if self.sleeping.swap(false, Ordering::SeqCst) {
            helper.unpark();
        }
        Offer {
            slot: self,
            ended: false,
        }
    }
}

/// A job that was offered.
struct Offer<'a> {
    slot: &'a JobSlot,
    ended: bool,
}

impl Offer<'_> {
    /// Does the job if nobody has begun it, or waits for its end; what it panicked with.
    fn end(&mut self) -> Option<Box<dyn Any + Send>> {
        let slot = self.slot;
        self.ended = true;
        let (from, to) = (Ordering::Acquire, Ordering::Relaxed);
        let mine = slot.state.compare_exchange(OFFERED, TAKEN, from, to);
        if mine.is_ok() {
            slot.perform();
        } else {
            let mut looks = 0u32;
            while slot.state.load(Ordering::Acquire) != DONE {
                match looks {
                    0..SPIN_LIMIT => std::hint::spin_loop(),
                    _ => yield_now(),
                }
                looks = looks.saturating_add(1);
            }
        }
        #[allow(unsafe_code, reason = "the helper is done with the cells")]
        // SAFETY: the job is done, and no other begins before the state is EMPTY.
        let panic = unsafe {
            *slot.job.get() = None;
            (*slot.panic.get()).take()
        };
        slot.state.store(EMPTY, Ordering::Release);
        panic
    }
}

impl Drop for Offer<'_> {
    fn drop(&mut self) {
        if !self.ended {
            self.end();
        }
    }
}

/// Ends the helper, however the work ends.
struct Closing<'a>(&'a JobSlot);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.state.store(CLOSED, Ordering::SeqCst);
        if let Some((_, helper)) = HELP.take() {
            helper.unpark();
        }
    }
}

/// Does the work with a second thread beside it, so that [`both`] has help for as long as it takes.
/// Where there is one core alone, or no thread to be had, it is done without.
pub fn with_help<T>(work: impl FnOnce() -> T) -> T {
    let cores = available_parallelism().map_or(1, usize::from);
    if cores < 2 || has_help() {
        return work();
    }
    let slot = Arc::new(JobSlot::default());
    scope(|scope| {
        let serve = || slot.serve();
        let Ok(helper) = Builder::new()
            .name("help".into())
            .spawn_scoped(scope, serve)
        else {
            return work();
        };
        HELP.set(Some((Arc::clone(&slot), helper.thread().clone())));
        let _closing = Closing(&slot);
        work()
    })
}

/// As [`with_help`] on machines with more than `busy` cores, and otherwise without.
pub fn with_help_beyond<T>(busy: usize, work: impl FnOnce() -> T) -> T {
    match available_parallelism().map_or(1, usize::from) > busy {
        true => with_help(work),
        false => work(),
    }
}

/// Whether this thread has help.
#[must_use]
pub fn has_help() -> bool {
    HELP.with_borrow(Option::is_some)
}

/// Does both jobs, at the same time where there is [help](with_help) that is free.
pub fn both<A, B: Send>(one: impl FnOnce() -> A, other: impl FnOnce() -> B + Send) -> (A, B) {
    let help = HELP.with_borrow(Clone::clone);
    let free = help.filter(|(slot, _)| slot.state.load(Ordering::Relaxed) == EMPTY);
    let Some((slot, helper)) = free else {
        return (one(), other());
    };
    let (mut other, mut result) = (Some(other), None);
    let mut job = || result = other.take().map(|other| other());
    let mut offer = slot.offer(&mut job, &helper);
    let first = one();
    let panic = offer.end();
    drop(offer);
    match (result, panic) {
        (Some(second), _) => (first, second),
        (None, Some(panic)) => resume_unwind(panic),
        (None, None) => unreachable!("the job was done"),
    }
}

/// As [`both`] where the jobs are worth it, and otherwise one after the other.
pub fn both_if<A, B: Send>(
    worth: bool,
    one: impl FnOnce() -> A,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    if worth {
        both(one, other)
    } else {
        (one(), other())
    }
}

/// How work is best cut in two, learnt from how long both parts took. It changes nothing but the time.
#[derive(Clone, Debug)]
pub struct Balance {
    /// The first part's share.
    share: f32,
}

/// The least that either part is.
const LEAST: f32 = 0.2;
/// Share of what was found wrong by which the next cut is better.
const LEARNS: f32 = 0.1;

impl Default for Balance {
    fn default() -> Self {
        Self { share: 0.5 }
    }
}

impl Balance {
    /// Where to cut so many pieces of work; at their end where there is no [help](with_help).
    #[must_use]
    pub fn cut(&self, pieces: usize) -> usize {
        match has_help() {
            true => (self.share * pieces as f32) as usize,
            false => pieces,
        }
    }

    /// Does [both] parts, and cuts better the next time.
    pub fn both<A, B: Send>(
        &mut self,
        one: impl FnOnce() -> A,
        other: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if !has_help() {
            return (one(), other());
        }
        let (begun, end) = (Instant::now(), AtomicU64::new(0));
        let done = || begun.elapsed().as_nanos() as u64;
        let ((one, first), other) = both(
            || (one(), done()),
            || {
                let other = other();
                end.store(done(), Ordering::Relaxed);
                other
            },
        );
        let second = end.into_inner();
        let wrong = (second as f32 - first as f32) / (first.max(second).max(1) as f32);
        self.share = (self.share * (1.0 + LEARNS * wrong)).clamp(LEAST, 1.0 - LEAST);
        (one, other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Halves of halves, the first of which share the cores.
    fn sum(numbers: &[u64]) -> u64 {
        match numbers {
            [] => 0,
            [one] => *one,
            _ => {
                let (low, high) = numbers.split_at(numbers.len() / 2);
                let (low, high) = both(|| sum(low), || sum(high));
                low + high
            }
        }
    }

    #[test]
    fn help_changes_nothing_but_the_time() {
        let numbers: Vec<u64> = (0..500).collect();
        assert!(!has_help());
        let expected = 500 * 499 / 2;
        assert_eq!(sum(&numbers), expected);
        with_help(|| {
            let cores = available_parallelism().map_or(1, usize::from);
            assert_eq!(has_help(), cores > 1);
            for round in 0..2000 {
                assert_eq!(sum(&numbers), expected, "{round}");
                let asleep = || {
                    HELP.with_borrow(|help| {
                        help.as_ref()
                            .is_none_or(|(slot, _)| slot.sleeping.load(Ordering::SeqCst))
                    })
                };
                while round % 500 == 0 && !asleep() {
                    yield_now();
                }
            }
        });
        assert!(!has_help());
    }

    #[test]
    fn both_do_work_at_the_same_time() {
        let met = std::sync::Barrier::new(2);
        let cores = available_parallelism().map_or(1, usize::from);
        if cores > 1 {
            // Each waits for the other: one after the other they would wait for ever. The helper
            // takes the job at the latest when it wakes up.
            with_help(|| both(|| met.wait(), || met.wait()));
        }
    }

    #[test]
    fn a_panic_on_either_side_comes_out_and_the_other_side_ends_first() {
        for side in 0..2 {
            let ended = AtomicBool::new(false);
            let caught = catch_unwind(AssertUnwindSafe(|| {
                with_help(|| {
                    let job = |number: usize| {
                        if number == side {
                            panic!("on purpose");
                        }
                        ended.store(true, Ordering::SeqCst);
                    };
                    both(|| job(0), || job(1))
                })
            }));
            assert!(caught.is_err());
            assert!(ended.load(Ordering::SeqCst));
            assert!(!has_help());
            assert_eq!(with_help(|| both(|| 1, || 2)), (1, 2), "and goes on");
        }
    }
}
