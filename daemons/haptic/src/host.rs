//! The real-time thread.

use std::fs::File;
use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Receiver;
use std::thread::JoinHandle;

use maulstick_haptics::{Kept, Limits};
use thread_priority::unix::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

use crate::beat::{Beat, Before, Channels, Delivery, Ticked};
use crate::driver::{Caller, Pace, Trouble};
use crate::placed::Placed;
use crate::wish::Wish;

/// Bins of the histograms: below 50 µs, doubling, the rest.
pub const BINS: usize = 12;
/// Ticks that fit into the ring to the publisher: two seconds.
const RING: usize = 2048;
/// SCHED_FIFO priority of the servo.
const PRIORITY: u8 = 80;

/// How a servo has ended that has lost its device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// Why it was lost.
    pub trouble: Trouble,
    /// What the next servo is to know.
    pub before: Before,
}

/// The running servo.
pub struct Host {
    /// Ticks, oldest first.
    pub ticks: rtrb::Consumer<Ticked>,
    /// Where models go in.
    pub models: triple_buffer::Input<Delivery>,
    /// Where wishes go in.
    pub wishes: triple_buffer::Input<Wish>,
    /// What hindered real-time scheduling, if anything did.
    pub warnings: Vec<String>,
    stop: Arc<AtomicBool>,
    dropped: Arc<AtomicU64>,
    ended: Receiver<Ended>,
    thread: Option<JoinHandle<()>>,
    /// Keeps the processor from sleeping deeply.
    _awake: Option<File>,
}

impl Host {
    /// Starts the servo over `device`, called by `pace`.
    ///
    /// # Errors
    /// What the system says where no thread can be started.
    pub fn start(device: Placed, pace: Box<dyn Pace>, limits: Limits) -> std::io::Result<Self> {
        let before = Before {
            kept: Kept::nothing(limits),
            armings: 0,
        };
        Self::resume(device, pace, limits, before)
    }

    /// The same, in the place of a servo that has lost the device.
    ///
    /// # Errors
    /// As [`Host::start`].
    pub fn resume(
        device: Placed,
        pace: Box<dyn Pace>,
        limits: Limits,
        before: Before,
    ) -> std::io::Result<Self> {
        Self::with_ring(device, pace, limits, before, RING)
    }

    /// Whether the servo has ended.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.ticks.is_abandoned()
    }

    /// Why it has lost its device, once it has, and what the next servo is to know.
    #[must_use]
    pub fn ended(&self) -> Option<Ended> {
        self.ended.recv().ok()
    }

    /// Why it has lost its device, once it has.
    #[must_use]
    pub fn trouble(&self) -> Option<Trouble> {
        self.ended().map(|ended| ended.trouble)
    }

    /// How many ticks did not fit into the ring, as the publisher was late.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    fn with_ring(
        device: Placed,
        mut pace: Box<dyn Pace>,
        limits: Limits,
        before: Before,
        ring: usize,
    ) -> std::io::Result<Self> {
        let (to_publisher, ticks) = rtrb::RingBuffer::new(ring);
        let (models, from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        // Until the daemon says what it wishes the servo is armed as the one before was.
        let (wishes, wished) = triple_buffer::triple_buffer(&Wish {
            armings: before.armings,
            ..Wish::default()
        });
        let (tell, told) = std::sync::mpsc::channel();
        let (end, ended) = std::sync::mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let dropped = Arc::new(AtomicU64::new(0));
        let channels = Channels {
            ticks: to_publisher,
            models: from_rig,
            wishes: wished,
            stop: Arc::clone(&stop),
            dropped: Arc::clone(&dropped),
        };
        let thread = std::thread::Builder::new()
            .name("servo".into())
            .spawn(move || {
                tell.send(become_real_time(pace.caller())).ok();
                let mut servo = Beat::new(device, limits, before, channels);
                let clock = pace.run(&mut |late_ns| servo.beat(late_ns)).err();
                if let Some(trouble) = servo.trouble().or(clock) {
                    let before = servo.kept();
                    end.send(Ended { trouble, before }).ok();
                }
                // Leaves no force: see what drops a device. The clock of a vendor's library stands by now.
                drop(servo);
            })?;
        let warnings = told.recv().unwrap_or_default();
        Ok(Self {
            ticks,
            models,
            wishes,
            warnings,
            stop,
            dropped,
            ended,
            thread: Some(thread),
            _awake: awake(),
        })
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

impl std::fmt::Debug for Host {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Host")
            .field("warnings", &self.warnings)
            .finish_non_exhaustive()
    }
}

/// Asks the system for wake-ups without delay, for as long as the file is open: a processor that sleeps
/// deeply wakes late (the kernel's `pm_qos_interface`). It takes root, and works without.
fn awake() -> Option<File> {
    let mut file = File::options()
        .write(true)
        .open("/dev/cpu_dma_latency")
        .ok()?;
    file.write_all(&0_i32.to_ne_bytes()).ok()?;
    Some(file)
}

/// Locks memory and asks for real-time scheduling where the servo is called on this thread; returns
/// what was not permitted, with the fix.
fn become_real_time(caller: Caller) -> Vec<String> {
    let mut warnings = Vec::new();
    let all =
        nix::sys::mman::MlockAllFlags::MCL_CURRENT | nix::sys::mman::MlockAllFlags::MCL_FUTURE;
    if let Err(error) = nix::sys::mman::mlockall(all) {
        warnings.push(format!(
            "memory is not locked ({error}): add 'memlock unlimited' for your user to /etc/security/limits.conf"
        ));
    }
    if caller == Caller::Vendor {
        return warnings;
    }
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let priority = ThreadPriorityValue::try_from(PRIORITY).map(ThreadPriority::Crossplatform);
    let set = priority
        .map_err(|error| error.to_string())
        .and_then(|priority| {
            thread_priority::set_thread_priority_and_policy(
                thread_priority::thread_native_id(),
                priority,
                policy,
            )
            .map_err(|error| format!("{error:?}"))
        });
    if let Err(error) = set {
        warnings.push(format!(
            "the servo has no real-time priority ({error}): add 'rtprio 99' for your user to /etc/security/limits.conf"
        ));
    }
    warnings
}

/// The histogram bin of a time.
#[must_use]
pub fn bin(ns: u64) -> usize {
    let mut edge = 50_000;
    for place in 0..BINS - 1 {
        if ns < edge {
            return place;
        }
        edge *= 2;
    }
    BINS - 1
}

#[cfg(test)]
mod tests;
