//! Fork and join: work shared among cores.
//!
//! Results are independent of the number of threads and of the assignment of shares: simultaneous shares write to
//! different places, and their results are combined in a fixed order.
//!
//! A share takes tens of microseconds and the next follows at once, so helpers stay awake between them. Pools whose
//! threads sleep in between (rayon) take longer to wake up than a share takes.

use std::any::Any;
use std::cell::{RefCell, UnsafeCell};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::NonNull;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::{Builder, Thread, available_parallelism, park, scope, yield_now};
use std::time::Instant;

/// Spin iterations before yielding the core.
const SPIN_LIMIT: u32 = 2_000;
/// Iterations, spinning and yielding, before sleeping.
const AWAKE: u32 = SPIN_LIMIT + 200;
/// Greatest number of threads of [`with_cores_beyond`]: above that, the serial part of a step takes longer than a
/// share.
const MOST_THREADS: usize = 16;

const EMPTY: u32 = 0;
const OFFERED: u32 = 1;
/// A thread does the job.
const TAKEN: u32 = 2;
/// The job is done.
const DONE: u32 = 3;
/// The helper is to end.
const CLOSED: u32 = 4;

type Job<'a> = dyn FnMut() + Send + 'a;

/// Slot for one job from a thread to a helper, on cache lines of its own.
#[derive(Default)]
#[repr(align(128))]
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
// SAFETY: the job is `Send`, and its pointer is used only as stated for `Sync`.
unsafe impl Send for JobSlot {}

/// A thread that waits for jobs.
struct Helper {
    slot: Arc<JobSlot>,
    thread: Thread,
}

thread_local! {
    static HELPERS: RefCell<Arc<[Helper]>> = RefCell::new(Arc::new([]));
}

impl JobSlot {
    /// Runs offered jobs until the slot is closed.
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

    /// Offers a job; dropping the result runs or awaits it.
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
    /// Runs the job if it has not begun, or waits for its end; returns its panic.
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

/// Ends the helpers, however the work ends.
struct Closing;

impl Drop for Closing {
    fn drop(&mut self) {
        for helper in &*HELPERS.replace(Arc::new([])) {
            helper.slot.state.store(CLOSED, Ordering::SeqCst);
            helper.thread.unpark();
        }
    }
}

/// Runs `work` with a number of threads, this one included, which [`each`] can use until it returns.
/// If this thread has helpers already, or no thread can be started, it uses those that there are.
pub fn with_threads<T>(threads: usize, work: impl FnOnce() -> T) -> T {
    if threads < 2 || self::threads() > 1 {
        return work();
    }
    let slots: Vec<Arc<JobSlot>> = (1..threads).map(|_| Arc::default()).collect();
    scope(|scope| {
        let helper = |slot: &'_ Arc<JobSlot>| {
            let own = Arc::clone(slot);
            let builder = Builder::new().name("help".into());
            let thread = builder.spawn_scoped(scope, move || own.serve()).ok()?;
            Some(Helper {
                slot: Arc::clone(slot),
                thread: thread.thread().clone(),
            })
        };
        HELPERS.set(slots.iter().map_while(helper).collect());
        let _closing = Closing;
        work()
    })
}

/// [`with_threads`], with one thread for each core except `busy` of them.
pub fn with_cores_beyond<T>(busy: usize, work: impl FnOnce() -> T) -> T {
    let cores = available_parallelism().map_or(1, usize::from);
    with_threads(cores.saturating_sub(busy).min(MOST_THREADS), work)
}

/// Threads that this one may share work among, itself included.
#[must_use]
pub fn threads() -> usize {
    HELPERS.with_borrow(|helpers| helpers.len()) + 1
}

/// Does the work on each share, at the same time where [helpers](with_threads) are free.
///
/// # Panics
/// Like the work on a share, once all helpers have finished.
pub fn each<S: Send>(shares: &mut [S], work: impl Fn(&mut S) + Sync) {
    match shares {
        [] => {}
        [one] => work(one),
        _ => spread(&HELPERS.with_borrow(Arc::clone), shares, &work),
    }
}

/// Offers the last of the shares to the first free helper, spreads the others, and awaits its own offer.
fn spread<S: Send>(helpers: &[Helper], shares: &mut [S], work: &(impl Fn(&mut S) + Sync)) {
    let (Some((helper, others)), 2..) = (helpers.split_first(), shares.len()) else {
        return shares.iter_mut().for_each(work);
    };
    if helper.slot.state.load(Ordering::Relaxed) != EMPTY {
        return spread(others, shares, work);
    }
    let offered = shares.len() / shares.len().min(helpers.len() + 1);
    let (own, offered) = shares.split_at_mut(shares.len() - offered);
    let mut job = || offered.iter_mut().for_each(work);
    let mut offer = helper.slot.offer(&mut job, &helper.thread);
    spread(others, own, work);
    let panic = offer.end();
    drop(offer);
    if let Some(panic) = panic {
        resume_unwind(panic);
    }
}

/// Cuts of work into shares, learnt from the time that shares took. Results do not depend on them.
#[derive(Clone, Debug, Default)]
pub struct Balance {
    /// Begin of each share but the first, as a fraction of the work.
    cuts: Vec<f32>,
}

/// Fraction of the error that one step of learning corrects.
const LEARNS: f32 = 0.2;

impl Balance {
    /// Cuts a number of pieces into a number of shares.
    #[must_use]
    pub fn cut(&mut self, pieces: usize, shares: usize) -> Vec<Range<usize>> {
        if self.cuts.len() + 1 != shares {
            let even = |share| share as f32 / shares as f32;
            self.cuts = (1..shares).map(even).map(|share| self.at(share)).collect();
        }
        let ends = self.cuts.iter().map(|cut| (cut * pieces as f32) as usize);
        let mut from = 0;
        let share = |to| std::mem::replace(&mut from, to)..to;
        ends.chain([pieces]).map(share).collect()
    }

    /// Begin of a share, by a number that may have a fraction; as a fraction of the work.
    fn at(&self, share: f32) -> f32 {
        let place = share * (self.cuts.len() + 1) as f32;
        let [low, high] = [0, 1].map(|on| self.edge(place as usize + on));
        low + (high - low) * place.fract()
    }

    /// Begin of a share, as a fraction of the work.
    fn edge(&self, share: usize) -> f32 {
        let before = share.checked_sub(1);
        before.map_or(0.0, |at| self.cuts.get(at).copied().unwrap_or(1.0))
    }

    /// [`each`] with shares that were [cut](Self::cut), adapting the next cuts.
    pub fn each<S: Send>(&mut self, shares: &mut [S], work: impl Fn(&mut S) + Sync) {
        if shares.len() < 2 || threads() < 2 {
            return shares.iter_mut().for_each(work);
        }
        let begun = Instant::now();
        let mut timed: Vec<(&mut S, f32)> = shares.iter_mut().map(|share| (share, 0.0)).collect();
        each(&mut timed, |(share, took)| {
            work(share);
            *took = begun.elapsed().as_nanos() as f32;
        });
        let took: Vec<f32> = timed.iter().map(|(_, took)| took.max(1.0)).collect();
        self.learn(&took);
    }

    /// Moves the cuts towards equal times of all shares.
    fn learn(&mut self, took: &[f32]) {
        let whole: f32 = took.iter().sum();
        let even = whole / took.len() as f32;
        let (mut share, mut done) = (0, 0.0);
        let better: Vec<f32> = (1..took.len())
            .map(|number| {
                let wanted = even * number as f32;
                while share + 1 < took.len() && done + took[share] < wanted {
                    done += took[share];
                    share += 1;
                }
                let [low, high] = [self.edge(share), self.edge(share + 1)];
                low + (high - low) * ((wanted - done) / took[share]).min(1.0)
            })
            .collect();
        let cuts = self.cuts.iter_mut().zip(better);
        cuts.for_each(|(cut, better)| *cut += LEARNS * (better - *cut));
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use super::*;

    const THREADS: [usize; 6] = [1, 2, 4, 8, 16, 64];

    /// Halves of halves, the first of which share the cores.
    fn sum(numbers: &[u64]) -> u64 {
        match numbers {
            [] => 0,
            [one] => *one,
            _ => {
                let (low, high) = numbers.split_at(numbers.len() / 2);
                let mut halves = [(low, 0), (high, 0)];
                each(&mut halves, |(numbers, total)| *total = sum(numbers));
                halves.iter().map(|(_, total)| total).sum()
            }
        }
    }

    #[test]
    fn help_changes_nothing_but_the_time() {
        let numbers: Vec<u64> = (0..500).collect();
        let expected = 500 * 499 / 2;
        for count in THREADS {
            assert_eq!(threads(), 1);
            with_threads(count, || {
                assert_eq!(threads(), count);
                for round in 0..200 {
                    assert_eq!(sum(&numbers), expected, "{count} threads, {round}");
                    // Every so often the helpers have gone to sleep.
                    while round % 100 == 0 && !are_asleep() {
                        yield_now();
                    }
                }
            });
        }
        assert_eq!(threads(), 1);
    }

    /// True if none of the helpers is awake.
    fn are_asleep() -> bool {
        let asleep = |helper: &Helper| helper.slot.sleeping.load(Ordering::SeqCst);
        HELPERS.with_borrow(|helpers| helpers.iter().all(asleep))
    }

    #[test]
    fn every_share_is_done_once_however_many_there_are() {
        for count in THREADS {
            with_threads(count, || {
                for shares in [0, 1, 2, 3, 5, 8, 63, 64, 65, 200] {
                    let mut done = vec![0; shares];
                    each(&mut done, |done| *done += 1);
                    assert!(done.iter().all(|done| *done == 1), "{count}, {shares}");
                }
            });
        }
    }

    #[test]
    fn shares_are_done_at_the_same_time() {
        for count in [2, 4, 16] {
            let met = Barrier::new(count);
            // Each waits for all: one after the other they would wait for ever. A helper takes its share at the
            // latest when it wakes up.
            with_threads(count, || {
                each(&mut vec![(); count], |()| {
                    met.wait();
                })
            });
        }
    }

    #[test]
    fn a_panic_on_any_share_comes_out_once_the_others_are_done() {
        for count in [2, 4, 16] {
            for bad in 0..count {
                let ended: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::default()).collect();
                let caught = catch_unwind(AssertUnwindSafe(|| {
                    with_threads(count, || {
                        let mut shares: Vec<usize> = (0..count).collect();
                        each(&mut shares, |share| {
                            assert_ne!(*share, bad, "on purpose");
                            ended[*share].store(true, Ordering::SeqCst);
                        });
                    });
                }));
                assert!(caught.is_err());
                let ended = ended.iter().filter(|ended| ended.load(Ordering::SeqCst));
                assert_eq!(ended.count(), count - 1);
                assert_eq!(threads(), 1);
                let mut again = [1, 2];
                with_threads(count, || each(&mut again, |share| *share += 1));
                assert_eq!(again, [2, 3], "and goes on");
            }
        }
    }

    #[test]
    fn cuts_come_to_where_all_shares_take_as_long() {
        // The first half of the pieces is three times as much work.
        let work = |range: &Range<usize>| -> f32 {
            let piece = |at: usize| if at < 500 { 3.0 } else { 1.0 };
            range.clone().map(piece).sum()
        };
        let mut balance = Balance::default();
        for shares in [2, 8, 3, 64] {
            let worst = |balance: &mut Balance| {
                let took: Vec<f32> = balance.cut(1000, shares).iter().map(work).collect();
                let worst = took.iter().fold(0.0f32, |most, took| most.max(*took));
                (took, worst * shares as f32 / 2000.0)
            };
            assert!(
                shares != 2 || worst(&mut balance).1 > 1.4,
                "even cuts are not even work"
            );
            for _ in 0..100 {
                let (took, _) = worst(&mut balance);
                balance.learn(&took);
            }
            let ranges = balance.cut(1000, shares);
            assert_eq!((ranges[0].start, ranges[shares - 1].end), (0, 1000));
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start));
            let (_, worst) = worst(&mut balance);
            assert!(worst < 1.2, "{shares} shares: {worst}");
        }
    }
}
