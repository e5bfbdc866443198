//! The real-time thread: absolute deadlines a millisecond apart, the measured time goes to the law.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;

use glam::DVec3;
use maulstick_haptics::contact::Contact;
use maulstick_haptics::{Limits, Sender, Servo, Switch, Tick};
use maulstick_types::Origin;
use nix::sys::time::TimeSpec;
use nix::time::{ClockId, ClockNanosleepFlags, clock_gettime, clock_nanosleep};
use thread_priority::unix::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

use crate::driver::{Placed, Reading};
use crate::wish::Wish;

/// Period of the servo, ns.
pub const PERIOD_NS: u64 = 1_000_000;
/// Bins of the histograms: below 50 µs, doubling, the rest.
pub const BINS: usize = 12;
/// Ticks that fit into the ring to the publisher: two seconds.
const RING: usize = 2048;
/// SCHED_FIFO priority of the servo.
const PRIORITY: u8 = 80;

/// A tick as it goes to the publisher.
#[derive(Clone, Copy, Debug)]
pub struct Ticked {
    /// When the device was read, `CLOCK_MONOTONIC`, ns.
    pub monotonic_ns: u64,
    /// What was read, desk frame.
    pub reading: Reading,
    /// The force applied, N, desk frame.
    pub force: DVec3,
    /// How late the wake-up was, ns.
    pub late_ns: u64,
    /// How long the tick took, ns.
    pub spent_ns: u64,
    /// What the servo did.
    pub tick: Tick,
    /// The [`Wish`]'s armings that it has done.
    pub armings: u64,
}

/// A model on its way to the servo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Delivery {
    /// The model.
    pub contact: Option<Contact>,
    /// Who sent it.
    pub sender: Option<Origin>,
    /// Counts deliveries.
    pub number: u64,
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
    thread: Option<JoinHandle<()>>,
}

fn monotonic_ns() -> u64 {
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

impl Host {
    /// Starts the servo over `device`.
    ///
    /// # Errors
    /// What the system says where no thread can be started.
    pub fn start(device: Placed, limits: Limits) -> std::io::Result<Self> {
        Self::with_ring(device, limits, RING)
    }

    /// How many ticks did not fit into the ring, as the publisher was late.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    fn with_ring(mut device: Placed, limits: Limits, ring: usize) -> std::io::Result<Self> {
        let (mut to_publisher, ticks) = rtrb::RingBuffer::new(ring);
        let (models, mut from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        let (wishes, mut wished) = triple_buffer::triple_buffer(&Wish::default());
        let (tell, told) = std::sync::mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let dropped = Arc::new(AtomicU64::new(0));
        let drops = Arc::clone(&dropped);
        let thread = std::thread::Builder::new()
            .name("servo".into())
            .spawn(move || {
                tell.send(become_real_time()).ok();
                let mut servo = Servo::new(limits);
                let (mut seen, mut sender) = (0, None);
                let mut followed = Wish::default();
                let mut amplifiers = Switch::On;
                let mut last_ns = monotonic_ns();
                let mut deadline_ns = last_ns + PERIOD_NS;
                while !stopped.load(Ordering::Relaxed) {
                    sleep_until(deadline_ns);
                    let now_ns = monotonic_ns();
                    let dt = (now_ns - last_ns) as f64 * 1e-9;
                    last_ns = now_ns;
                    let delivery = *from_rig.read();
                    if delivery.number != seen
                        && let Some(contact) = delivery.contact
                    {
                        let whose = if delivery.sender == sender {
                            Sender::Same
                        } else {
                            Sender::Another
                        };
                        servo.receive(contact, whose);
                        (seen, sender) = (delivery.number, delivery.sender);
                    }
                    followed.follow(*wished.read(), &mut servo);
                    let reading = device.read(dt);
                    servo.measure(reading.motor_temperature);
                    let (force, tick) = servo.step(&reading.held, dt);
                    device.write(force);
                    let wanted = if tick.resting || tick.fault.is_some() {
                        Switch::Off
                    } else {
                        Switch::On
                    };
                    if wanted != amplifiers {
                        amplifiers = wanted;
                        device.switch(amplifiers);
                    }
                    let ticked = Ticked {
                        monotonic_ns: now_ns,
                        reading,
                        force,
                        late_ns: now_ns.saturating_sub(deadline_ns),
                        spent_ns: monotonic_ns() - now_ns,
                        tick,
                        armings: followed.armings,
                    };
                    if to_publisher.push(ticked).is_err() {
                        drops.fetch_add(1, Ordering::Relaxed);
                    }
                    // After an overrun the next deadline is the next grid point: no burst to catch up.
                    deadline_ns += PERIOD_NS;
                    let now_ns = monotonic_ns();
                    if deadline_ns <= now_ns {
                        deadline_ns += (now_ns - deadline_ns).div_ceil(PERIOD_NS) * PERIOD_NS;
                    }
                }
                // Leaves no force: see what drops a device.
                drop(device);
            })?;
        let warnings = told.recv().unwrap_or_default();
        Ok(Self {
            ticks,
            models,
            wishes,
            warnings,
            stop,
            dropped,
            thread: Some(thread),
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

/// Locks memory and asks for real-time scheduling; returns what was not permitted, with the fix.
fn become_real_time() -> Vec<String> {
    let mut warnings = Vec::new();
    let all =
        nix::sys::mman::MlockAllFlags::MCL_CURRENT | nix::sys::mman::MlockAllFlags::MCL_FUTURE;
    if let Err(error) = nix::sys::mman::mlockall(all) {
        warnings.push(format!(
            "memory is not locked ({error}): add 'memlock unlimited' for your user to /etc/security/limits.conf"
        ));
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
