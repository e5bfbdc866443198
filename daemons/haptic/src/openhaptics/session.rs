//! A device that has been initiated, as the driver and the vendor's clock share it. All of it is
//! atomic: the scheduler's thread takes no lock.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU8, AtomicU32, Ordering};

use super::abi::{CURRENT_FORCE, CURRENT_TORQUE, Handle};
use super::calibration::Standing;
use super::faults::{Class, Notice, class, is_wrong_call, trouble};
use super::frame::MILLI;
use super::library::{Library, MOST_ERRORS};
use crate::driver::{Trouble, Wrench};

static TAKEN: AtomicBool = AtomicBool::new(false);

/// The right to the library: it has one scheduler in a process, so one device is used at a time.
#[derive(Debug)]
pub struct Claim(());

impl Claim {
    /// The right, unless somebody has it.
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

/// What the motors can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives {
    /// Force.
    Force,
    /// Force and torque.
    ForceAndTorque,
}

/// The device.
#[derive(Debug)]
pub struct Session {
    /// The vendor's library.
    pub library: &'static Library,
    /// The device in it.
    pub device: Handle,
    drives: Drives,
    is_open: AtomicBool,
    has_force: AtomicBool,
    is_look_due: AtomicBool,
    standing: AtomicU8,
    told: AtomicU32,
    ended: AtomicU32,
    internal: AtomicI32,
    _claim: Claim,
}

impl Session {
    /// A device that has just been initiated; it is disabled as the session ends.
    #[must_use]
    pub fn new(library: &'static Library, device: Handle, claim: Claim) -> Self {
        Self {
            library,
            device,
            drives: Drives::Force,
            is_open: AtomicBool::new(false),
            has_force: AtomicBool::new(false),
            is_look_due: AtomicBool::new(true),
            standing: AtomicU8::new(Standing::Unknown as u8),
            told: AtomicU32::new(0),
            ended: AtomicU32::new(0),
            internal: AtomicI32::new(0),
            _claim: claim,
        }
    }

    /// Says what its motors can do, and shares it.
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

    /// Whether a frame is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.is_open.load(Ordering::Relaxed)
    }

    /// Whether the motors were told to give a force, and not since to give none.
    #[must_use]
    pub fn has_force(&self) -> bool {
        self.has_force.load(Ordering::Relaxed)
    }

    /// Ends the frame; the motors do this from now on, HD's base frame.
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

    /// Ends the frame, if one is open, without force.
    pub fn quieten(&self) {
        if self.is_open() {
            self.end(Wrench::ZERO);
        }
    }

    /// Whether the device knows where it is.
    #[must_use]
    pub fn is_calibrated(&self) -> bool {
        self.standing() == Standing::Calibrated
    }

    /// How it stands with its calibration.
    #[must_use]
    pub fn standing(&self) -> Standing {
        Standing::numbered(self.standing.load(Ordering::Acquire))
    }

    /// Says how it stands.
    pub fn stand(&self, standing: Standing) {
        self.standing.store(standing as u8, Ordering::Release);
    }

    /// Asks for a look at the calibration, in one of the next frames.
    pub fn ask_look(&self) {
        self.is_look_due.store(true, Ordering::Relaxed);
    }

    /// Whether one was asked for, since this was last asked.
    #[must_use]
    pub fn takes_look(&self) -> bool {
        self.is_look_due.swap(false, Ordering::Relaxed)
    }

    /// Has the user told something.
    pub fn tell(&self, notice: Notice) {
        self.told.fetch_or(notice.bit(), Ordering::Relaxed);
    }

    /// Takes note of all errors since. Why the device is lost, if it is. While the scheduler runs, only what
    /// it calls asks this: the library has one stack of errors.
    pub fn trouble(&self) -> Option<Trouble> {
        self.look();
        self.ended().map(|(code, _)| trouble(code))
    }

    /// Takes note of all errors since; whether none of them says that a call was wrong.
    #[must_use]
    pub fn answers(&self) -> bool {
        self.note(&mut |code| is_wrong_call(code)) == 0
    }

    fn look(&self) {
        self.note(&mut |_| false);
    }

    /// Takes note of errors but of those that are `excepted`, which it counts.
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
        // What was noted earlier is the cause of what comes later.
        if let Some(error) = cause
            && self.ended().is_none()
        {
            self.internal.store(error.internal, Ordering::Relaxed);
            self.ended.store(error.code, Ordering::Release);
        }
        count
    }

    /// The code and the internal code of the error that has ended the device.
    #[must_use]
    pub fn ended(&self) -> Option<(u32, i32)> {
        match self.ended.load(Ordering::Acquire) {
            0 => None,
            code => Some((code, self.internal.load(Ordering::Relaxed))),
        }
    }

    /// Notices since this was last asked, a bit each.
    #[must_use]
    pub fn take_told(&self) -> u32 {
        self.told.swap(0, Ordering::Relaxed)
    }
}

/// However it ends, the device is free for the next one.
impl Drop for Session {
    fn drop(&mut self) {
        self.library.disable_device(self.device);
    }
}
