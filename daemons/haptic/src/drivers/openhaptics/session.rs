//! An initiated device, shared by the driver and the vendor's clock. All of it is atomic, for the
//! scheduler's thread takes no lock.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU8, AtomicU32, Ordering};

use super::abi::{CURRENT_FORCE, CURRENT_TORQUE, Handle};
use super::calibration_state::CalibrationState;
use super::faults::{Class, Notice, class, device_error, is_wrong_call};
use super::frame::MILLI;
use super::library::{Library, MOST_ERRORS};
use crate::device::driver::{DeviceError, Wrench};

static TAKEN: AtomicBool = AtomicBool::new(false);

/// Exclusive claim to the library, which has one scheduler in a process and so serves one device.
#[derive(Debug)]
pub struct Claim(());

impl Claim {
    /// Takes the claim, unless it is taken.
    #[must_use]
    pub fn take() -> Option<Self> {
        let was_taken = TAKEN.swap(true, Ordering::AcqRel);
        (!was_taken).then_some(Self(()))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        TAKEN.store(false, Ordering::Release);
    }
}

/// Abilities of the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives {
    /// Force.
    Force,
    /// Force and torque.
    ForceAndTorque,
}

/// Session with an initiated device.
#[derive(Debug)]
pub struct Session {
    /// The vendor's library.
    pub library: &'static Library,
    /// The library's handle of the device.
    pub device: Handle,
    drives: Drives,
    is_open: AtomicBool,
    has_force: AtomicBool,
    is_look_due: AtomicBool,
    calibration: AtomicU8,
    told: AtomicU32,
    ended: AtomicU32,
    internal: AtomicI32,
    _claim: Claim,
}

impl Session {
    /// A session with a device just initiated, which is disabled when the session ends.
    #[must_use]
    pub fn new(library: &'static Library, device: Handle, claim: Claim) -> Self {
        Self {
            library,
            device,
            drives: Drives::Force,
            is_open: AtomicBool::new(false),
            has_force: AtomicBool::new(false),
            is_look_due: AtomicBool::new(true),
            calibration: AtomicU8::new(CalibrationState::Unknown as u8),
            told: AtomicU32::new(0),
            ended: AtomicU32::new(0),
            internal: AtomicI32::new(0),
            _claim: claim,
        }
    }

    /// Sets the abilities of the motors and makes the session shareable.
    #[must_use]
    pub fn driving(mut self, drives: Drives) -> Arc<Self> {
        self.drives = drives;
        Arc::new(self)
    }

    /// Begins a frame.
    pub fn begin(&self) {
        self.library.begin_frame(self.device);
        self.is_open.store(true, Ordering::Relaxed);
    }

    /// True while a frame is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.is_open.load(Ordering::Relaxed)
    }

    /// True while the motors are set to a force.
    #[must_use]
    pub fn has_force(&self) -> bool {
        self.has_force.load(Ordering::Relaxed)
    }

    /// Ends the frame and sets the motors, HD's base frame.
    pub fn end(&self, wrench: Wrench) {
        let library = self.library;
        library.set_doubles(CURRENT_FORCE, &wrench.force.to_array());
        if self.drives == Drives::ForceAndTorque {
            library.set_doubles(CURRENT_TORQUE, &(wrench.torque / MILLI).to_array());
        }
        library.end_frame(self.device);
        self.is_open.store(false, Ordering::Relaxed);
        self.has_force
            .store(wrench != Wrench::ZERO, Ordering::Relaxed);
    }

    /// Ends an open frame without force.
    pub fn quieten(&self) {
        if self.is_open() {
            self.end(Wrench::ZERO);
        }
    }

    /// True if the device is calibrated.
    #[must_use]
    pub fn is_calibrated(&self) -> bool {
        self.calibration() == CalibrationState::Calibrated
    }

    /// Calibration state of the device.
    #[must_use]
    pub fn calibration(&self) -> CalibrationState {
        CalibrationState::numbered(self.calibration.load(Ordering::Acquire))
    }

    /// Sets the calibration state.
    pub fn set_calibration(&self, state: CalibrationState) {
        self.calibration.store(state as u8, Ordering::Release);
    }

    /// Asks for a check of the calibration in one of the next frames.
    pub fn ask_look(&self) {
        self.is_look_due.store(true, Ordering::Relaxed);
    }

    /// Takes the request for a check, if there is one.
    #[must_use]
    pub fn takes_look(&self) -> bool {
        self.is_look_due.swap(false, Ordering::Relaxed)
    }

    /// Queues a notice to the user.
    pub fn tell(&self, notice: Notice) {
        self.told.fetch_or(notice.bit(), Ordering::Relaxed);
    }

    /// Collects the library's errors; returns the one that has ended the device, if any. While the scheduler
    /// runs, only its callback may call this: the library has one stack of errors.
    pub fn take_error(&self) -> Option<DeviceError> {
        self.look();
        self.ended().map(|(code, _)| device_error(code))
    }

    /// Collects the library's errors; true if none of them rejects a call.
    #[must_use]
    pub fn answers(&self) -> bool {
        self.note(&mut |code| is_wrong_call(code)) == 0
    }

    fn look(&self) {
        self.note(&mut |_| false);
    }

    /// Collects errors except those that are `excepted`, which it counts.
    fn note(&self, excepted: &mut dyn FnMut(u32) -> bool) -> usize {
        let (mut count, mut cause) = (0, None);
        for _ in 0..MOST_ERRORS {
            let Some(error) = self.library.next_error() else {
                break;
            };
            if excepted(error.code) {
                count += 1;
                continue;
            }
            match class(error.code) {
                Class::Told(notice) => self.tell(notice),
                // The newest comes first: the oldest is the cause.
                Class::Ends => cause = Some(error),
            }
        }
        // The first error is the cause of later ones.
        if let Some(error) = cause
            && self.ended().is_none()
        {
            self.internal.store(error.internal, Ordering::Relaxed);
            self.ended.store(error.code, Ordering::Release);
        }
        count
    }

    /// Code and internal code of the error that has ended the device.
    #[must_use]
    pub fn ended(&self) -> Option<(u32, i32)> {
        match self.ended.load(Ordering::Acquire) {
            0 => None,
            code => Some((code, self.internal.load(Ordering::Relaxed))),
        }
    }

    /// Takes the queued notices, one bit each.
    #[must_use]
    pub fn take_told(&self) -> u32 {
        self.told.swap(0, Ordering::Relaxed)
    }
}

/// Frees the device however the session ends.
impl Drop for Session {
    fn drop(&mut self) {
        self.library.disable_device(self.device);
    }
}
