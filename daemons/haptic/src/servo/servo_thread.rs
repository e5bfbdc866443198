//! The real-time thread of the servo.

use std::fs::File;
use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Receiver;
use std::thread::JoinHandle;

use maulstick_haptics::{Contact, Fluid, Guide, Limits, ServoMemory};
use thread_priority::unix::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

use super::channels::{Channels, Delivery, TickRecord};
use super::force_control::ForceControl;
use super::servo_loop::{PreviousServo, ServoLoop};
use crate::device::driver::{Caller, DeviceError, ServoClock};
use crate::device::mounted_device::MountedDevice;

/// Bins of the histograms: below 50 µs, doubling, the rest.
pub const BINS: usize = 12;
/// Ticks that fit into the ring to the publisher: two seconds.
const RING: usize = 2048;
/// SCHED_FIFO priority of the servo.
pub const PRIORITY: u8 = 80;

/// End of a servo that lost its device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// The error by which it was lost.
    pub error: DeviceError,
    /// State for the next servo.
    pub previous: PreviousServo,
}

/// The running servo.
pub struct ServoThread {
    /// Tick records, oldest first.
    pub ticks: rtrb::Consumer<TickRecord>,
    /// Contact models, in.
    pub models: triple_buffer::Input<Delivery<Contact>>,
    /// Guides, in.
    pub guides: triple_buffer::Input<Delivery<Guide>>,
    /// Forces of paint, in.
    pub fluids: triple_buffer::Input<Delivery<Fluid>>,
    /// Force settings, in.
    pub controls: triple_buffer::Input<ForceControl>,
    /// Obstacles to real-time scheduling.
    pub warnings: Vec<String>,
    stop: Arc<AtomicBool>,
    dropped: Arc<AtomicU64>,
    ended: Receiver<Ended>,
    thread: Option<JoinHandle<()>>,
    /// Open while the processor is kept from deep sleep.
    _awake: Option<File>,
}

impl ServoThread {
    /// Starts the servo over `device` on `clock`.
    ///
    /// # Errors
    /// The system's, if no thread can be started.
    pub fn start(
        device: MountedDevice,
        clock: Box<dyn ServoClock>,
        limits: Limits,
    ) -> std::io::Result<Self> {
        let previous = PreviousServo {
            memory: ServoMemory::fresh(limits),
            rearms: 0,
        };
        Self::resume(device, clock, limits, previous)
    }

    /// Starts the servo in succession to one that lost the device.
    ///
    /// # Errors
    /// As [`ServoThread::start`].
    pub fn resume(
        device: MountedDevice,
        clock: Box<dyn ServoClock>,
        limits: Limits,
        previous: PreviousServo,
    ) -> std::io::Result<Self> {
        Self::with_ring(device, clock, limits, previous, RING)
    }

    /// True once the servo has ended.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.ticks.is_abandoned()
    }

    /// The end of the servo, once it has lost its device.
    #[must_use]
    pub fn ended(&self) -> Option<Ended> {
        self.ended.recv().ok()
    }

    /// The error by which the device was lost, once it was.
    #[must_use]
    pub fn error(&self) -> Option<DeviceError> {
        self.ended().map(|ended| ended.error)
    }

    /// Number of tick records dropped because the publisher was late.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    fn with_ring(
        device: MountedDevice,
        mut clock: Box<dyn ServoClock>,
        limits: Limits,
        previous: PreviousServo,
        ring: usize,
    ) -> std::io::Result<Self> {
        let (to_publisher, ticks) = rtrb::RingBuffer::new(ring);
        let (models, models_from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        let (guides, guides_from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        let (fluids, fluids_from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        // Until the daemon sends its settings the servo counts as armed as its predecessor was.
        let (controls, from_daemon) = triple_buffer::triple_buffer(&ForceControl {
            rearms: previous.rearms,
            ..ForceControl::default()
        });
        let (send_warnings, receive_warnings) = std::sync::mpsc::channel();
        let (end, ended) = std::sync::mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let dropped = Arc::new(AtomicU64::new(0));
        let channels = Channels {
            ticks: to_publisher,
            models: models_from_rig,
            guides: guides_from_rig,
            fluids: fluids_from_rig,
            controls: from_daemon,
            stop: Arc::clone(&stop),
            dropped: Arc::clone(&dropped),
        };
        let thread = std::thread::Builder::new()
            .name("servo".into())
            .spawn(move || {
                send_warnings.send(become_real_time(clock.caller())).ok();
                let mut servo = ServoLoop::new(device, limits, previous, channels);
                let failed = clock.run(&mut |late_ns| servo.tick(late_ns)).err();
                if let Some(error) = servo.error().or(failed) {
                    let previous = servo.memory();
                    end.send(Ended { error, previous }).ok();
                }
                // Dropping the device leaves no force. The clock of a vendor's library stands by now.
                drop(servo);
            })?;
        let warnings = receive_warnings.recv().unwrap_or_default();
        Ok(Self {
            ticks,
            models,
            guides,
            fluids,
            controls,
            warnings,
            stop,
            dropped,
            ended,
            thread: Some(thread),
            _awake: awake(),
        })
    }
}

impl Drop for ServoThread {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
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
    if let Err(error) = take_priority() {
        warnings.push(format!(
            "the servo has no real-time priority ({error}): add 'rtprio 99' for your user to /etc/security/limits.conf"
        ));
    }
    warnings
}

/// Gives this thread the servo's priority.
///
/// # Errors
/// The system's refusal.
pub fn take_priority() -> Result<(), thread_priority::Error> {
    let priority = ThreadPriorityValue::try_from(PRIORITY)
        .map_err(|_| thread_priority::Error::Priority("out of range"))?;
    thread_priority::set_thread_priority_and_policy(
        thread_priority::thread_native_id(),
        ThreadPriority::Crossplatform(priority),
        ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo),
    )
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
