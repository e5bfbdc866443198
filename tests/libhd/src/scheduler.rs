//! The thread that calls back a thousand times a second.

use std::cell::Cell;
use std::ffi::c_void;
use std::sync::{Mutex, PoisonError};
use std::thread::{JoinHandle, ThreadId};
use std::time::{Duration, Instant};

use crate::library::{Whose, with};
use crate::log::Call;

/// Its period.
const PERIOD: Duration = Duration::from_millis(1);

thread_local! {
    static WHOSE: Cell<Whose> = const { Cell::new(Whose::Other) };
}

/// Whose thread this is.
pub(crate) fn whose() -> Whose {
    WHOSE.get()
}

static THREAD: Mutex<Option<JoinHandle<()>>> = Mutex::new(None);

/// Starts it.
pub(crate) fn start() {
    let thread = std::thread::Builder::new()
        .name("libhd".into())
        .spawn(run)
        .ok();
    *THREAD.lock().unwrap_or_else(PoisonError::into_inner) = thread;
}

/// Ends it, and waits until nobody is called any more.
pub(crate) fn stop() {
    with(|state| {
        state.log.push(Call::Stop);
        state.is_running = false;
    });
    let thread = THREAD.lock().unwrap_or_else(PoisonError::into_inner).take();
    let is_other = |id: ThreadId| id != std::thread::current().id();
    if let Some(thread) = thread.filter(|thread| is_other(thread.thread().id())) {
        thread.join().ok();
    }
}

fn run() {
    WHOSE.set(Whose::Scheduler);
    let mut deadline = Instant::now();
    loop {
        deadline += PERIOD;
        let now = Instant::now();
        match deadline.checked_duration_since(now) {
            // The vendor's clock: each tick has its own deadline.
            Some(left) => std::thread::sleep(left),
            None => deadline = now,
        }
        let Some(entries) = with(|state| state.is_running.then(|| state.due())) else {
            return;
        };
        for entry in entries {
            #[allow(
                unsafe_code,
                reason = "the interface has the callback and its pointer go together"
            )]
            // SAFETY: who schedules a callback keeps its pointer valid until it is unscheduled.
            let code = unsafe { (entry.callback)(entry.data as *mut c_void) };
            with(|state| {
                if code == 0 {
                    state.log.push(Call::Returned(state.tick, code));
                    state.entries.retain(|other| other.handle != entry.handle);
                }
            });
        }
        with(|state| state.end_tick());
    }
}
