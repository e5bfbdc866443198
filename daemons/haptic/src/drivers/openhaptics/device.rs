//! The driver: a frame of the library is opened as it is read and ended as it is written.

use std::sync::Arc;

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_types::stylus::axes;

use super::abi::{
    CURRENT_BUTTONS, CURRENT_INKWELL_SWITCH, CURRENT_SAFETY_SWITCH, CURRENT_TRANSFORM,
    CURRENT_VELOCITY, FORCE_OUTPUT, MOTOR_TEMPERATURE,
};
use super::calibration::Calibration;
use super::faults::Notice;
use super::frame::{Frame, bounded};
use super::model::DeadMan;
use super::session::Session;
use crate::device::driver::{Abilities, DeviceError, Driver, Reading, Wrench};

/// Frames in a row that say nothing of use, after which the device is lost: a second's.
const MOST_UNREAD: u32 = 1000;

/// Time for which the force is held over unusable frames, as with a device that sends nothing new; the servo takes a
/// longer one for a stand-still. A force dropped and given again would be a blow, s.
const HELD_S: f64 = 0.005;

/// The device reports no place.
pub const UNREADABLE: DeviceError = DeviceError {
    what: "the haptic device says no place that it could be at",
    code: 0,
    help: "calibrate it by the vendor's setup program",
};

/// Support of the model for a query that not all answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answers {
    /// Not asked yet.
    Unknown,
    /// Supported.
    Yes,
    /// Not supported.
    No,
}

/// A Phantom.
pub struct Device {
    session: Arc<Session>,
    abilities: Abilities,
    dead_man: DeadMan,
    calibration: Calibration,
    inkwell: Answers,
    safety: Answers,
    temperature: Answers,
    /// State of the amplifiers from the next frame on.
    amplifiers: Option<Switch>,
    unread: u32,
    /// Force of the motors.
    given: Wrench,
}

impl Device {
    /// The device of a session.
    #[must_use]
    pub fn new(
        session: Arc<Session>,
        abilities: Abilities,
        dead_man: DeadMan,
        calibration: Calibration,
    ) -> Self {
        Self {
            session,
            abilities,
            dead_man,
            calibration,
            inkwell: Answers::Unknown,
            safety: match dead_man {
                DeadMan::Senses => Answers::Unknown,
                DeadMan::Absent => Answers::No,
            },
            temperature: Answers::Unknown,
            amplifiers: None,
            unread: 0,
            given: Wrench::ZERO,
        }
    }

    /// All that a frame says.
    fn frame(&mut self) -> Frame {
        let session = &self.session;
        let library = session.library;
        let mut frame = Frame {
            transform: library.doubles(CURRENT_TRANSFORM, f64::NAN),
            velocity: library.doubles(CURRENT_VELOCITY, f64::NAN),
            buttons: library.integer(CURRENT_BUTTONS),
            inkwell: 0,
            safety: 0,
            temperatures: [0.0; 6],
        };
        if self.abilities.senses & axes::ORIENTATION == 0 {
            frame.point_away();
        }
        if self.inkwell == Answers::Unknown {
            // Earlier errors are not attributed to the queries that follow.
            session.take_error();
        }
        frame.inkwell = asked(session, &mut self.inkwell, frame.inkwell, || {
            library.boolean(CURRENT_INKWELL_SWITCH, 0)
        });
        let was_asked = self.safety != Answers::Unknown;
        frame.safety = asked(session, &mut self.safety, frame.safety, || {
            library.boolean(CURRENT_SAFETY_SWITCH, 0)
        });
        if !was_asked && self.safety == Answers::No {
            session.tell(Notice::NoSwitch);
        }
        frame.temperatures = asked(session, &mut self.temperature, frame.temperatures, || {
            library.doubles(MOTOR_TEMPERATURE, 0.0)
        });
        frame
    }
}

/// An answer, or what stands for it where the model gives none.
fn asked<T>(session: &Session, answers: &mut Answers, none: T, ask: impl FnOnce() -> T) -> T {
    if *answers == Answers::No {
        return none;
    }
    let answer = ask();
    if *answers == Answers::Unknown {
        *answers = if session.answers() {
            Answers::Yes
        } else {
            Answers::No
        };
    }
    match *answers {
        Answers::No => none,
        _ => answer,
    }
}

impl Driver for Device {
    fn abilities(&self) -> Abilities {
        self.abilities
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        self.session.begin();
        match self.amplifiers.take() {
            Some(Switch::On) => self.session.library.enable(FORCE_OUTPUT),
            Some(Switch::Off) => self.session.library.disable(FORCE_OUTPUT),
            None => {}
        }
        let frame = self.frame();
        self.calibration.follow(&self.session, frame.buttons);
        let reading = frame.reading(self.dead_man);
        let is_calibrated = self.session.is_calibrated();
        if let Some(error) = self.session.take_error() {
            self.session.quieten();
            return Err(error);
        }
        let Some(reading) = reading else {
            if dt > HELD_S || !is_calibrated {
                self.given = Wrench::ZERO;
            }
            self.session.end(self.given);
            self.unread += 1;
            return if self.unread < MOST_UNREAD {
                Ok(None)
            } else {
                Err(UNREADABLE)
            };
        };
        self.unread = 0;
        Ok(Some(Reading {
            in_range: reading.in_range && is_calibrated,
            // A device that does not know where it is would push at random.
            is_permitted: reading.is_permitted && is_calibrated,
            ..reading
        }))
    }

    /// Outside of a frame there is nothing to be written: no frame leaves a force behind that its
    /// scheduler has not taken back before it stops.
    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        if !self.session.is_open() {
            return Ok(());
        }
        let Abilities {
            max_force_n,
            max_torque_nm,
            ..
        } = self.abilities;
        self.given = bounded(wrench, max_force_n, max_torque_nm);
        self.session.end(self.given);
        self.session.take_error().map_or(Ok(()), Err)
    }

    /// A capability is part of the state, which can be set within a frame only: the next one.
    fn switch(&mut self, amplifiers: Switch) {
        self.amplifiers = Some(amplifiers);
    }
}

impl Frame {
    /// A model that senses no turning holds its stylus away from the user.
    fn point_away(&mut self) {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        for (column, axis) in self.transform.chunks_mut(4).zip(axes) {
            column[..3].copy_from_slice(&axis.to_array());
        }
    }
}
