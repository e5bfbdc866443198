//! WoodenHaptics and Polhem styluses at a serial port, which do their own kinematics: they receive forces and
//! send poses (forsslund/haptikfabrikenapi, uAPI v0.2).
//!
//! A lost answer takes the force away for 20 ms; the device's watchdog ends it 100 ms after the last command, so none stays
//! after a crash. Commands have 63 bytes, or 64 if the firmware does not answer 63 with a pose. Poses do not hold the
//! button: it is asked for 20 times a second while there is no force. Velocity is a low pass of the positions at 60 Hz.
//!
//! | module | holds |
//! | --- | --- |
//! | [`frame`] | the lines of both sides |
//! | [`axes`] | from the device's axes to the device frame |
//! | [`link`] | the dialogue: one line, one answer |
//! | [`mod@handshake`] | the first words |
//! | [`port`] | a serial port |
//! | [`find`] | which serial port it is |

pub mod axes;
pub mod find;
pub mod frame;
pub mod handshake;
pub mod link;
pub mod port;

use std::time::Duration;

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::HandleState;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus;

use self::frame::{Answer, Length, Line, MAX_FORCE_N, Pose};
use self::handshake::{HandshakeError, handshake};
use self::link::{Link, Wire};
use self::port::Port;
use crate::device::driver::{Abilities, DeviceError, Driver, Opened, Reading, Wrench};
use crate::device::velocity::Velocity;
use crate::servo::clock::MonotonicClock;

/// Force that warm motors bear, N: of 5 N as much as a Phantom Desktop's of its 7.9 N. The device tells
/// no temperature.
const CONTINUOUS_N: f64 = 1.1;
/// Largest stiffness that its authors name, N/m.
const MAX_STIFFNESS_N_M: f64 = 1000.0;
/// Its own viscous friction, N·s/m, is published by nobody: the least of devices of its kind.
const DAMPING_N_S_M: f64 = 0.1;
/// Half of its working area, m.
const REACH_M: f64 = 0.2;
/// Time between two questions for the button, s.
const BUTTON_S: f64 = 0.05;

/// Opens the stylus of a section: at its `address`, a serial port, or at the only port that may be one.
///
/// # Errors
/// A [`UserError`] that says what is missing.
pub fn open(device: &DeviceSection) -> Result<Opened, UserError> {
    let path = match &device.address {
        Some(path) => path.clone(),
        None => find::only(&find::ports()?)?.to_owned(),
    };
    let mut port = Port::open(&path)?;
    // Opening may take its time: it is not the servo that waits.
    let length = handshake(&mut port, &mut || {
        std::thread::sleep(Duration::from_millis(1))
    })
    .map_err(|error| refused(&path, error))?;
    Ok(Opened {
        driver: Box::new(Polhem::new(port, length)),
        clock: Box::new(MonotonicClock),
        what: format!("a WoodenHaptics or Polhem stylus at {path}"),
    })
}

/// The error of a port whose device cannot be used.
#[must_use]
pub fn refused(path: &str, error: HandshakeError) -> UserError {
    match error {
        HandshakeError::Silent => UserError::failure(format!("nothing answers at {path}")).help(
            "switch the stylus on; if this is another device's port, name the stylus' own as the \
             device's `address`",
        ),
        HandshakeError::Foreign(said) => UserError::failure(format!(
            "what answers at {path} is no WoodenHaptics or Polhem stylus: it says {}",
            match said.chars().all(|c| c.is_ascii_graphic() || c == ' ') {
                true => format!("{said:?}"),
                // Noise is other noise each time, and is logged once.
                false => "what cannot be read".into(),
            }
        ))
        .help("name the stylus' own port as the device's `address`"),
        HandshakeError::NoPoses => {
            UserError::failure(format!("the stylus at {path} tells encoders, but no poses"))
                .help("give it firmware that knows forces (command 2), of November 2020 or later")
        }
        HandshakeError::Broken(errno) => UserError::failure(format!("{path} is gone: {errno}"))
            .help("unplug the stylus and plug it in again"),
    }
}

/// A stylus at a wire.
#[derive(Debug)]
pub struct Polhem<W: Wire> {
    link: Link<W>,
    length: Length,
    amplifiers: Switch,
    velocity: Velocity,
    /// Time elapsed since the last reading, s.
    waited_s: f64,
    /// Time since the last pose, s.
    since_pose_s: f64,
    /// State of the handle at that reading.
    last: Option<HandleState>,
    /// Time since the button was last queried, s.
    unasked_s: f64,
    pressed: bool,
}

impl<W: Wire> Polhem<W> {
    /// A stylus that is awake and takes lines of `length`.
    pub fn new(wire: W, length: Length) -> Self {
        Self {
            link: Link::new(wire),
            length,
            amplifiers: Switch::On,
            velocity: Velocity::default(),
            waited_s: 0.0,
            since_pose_s: 0.0,
            last: None,
            unasked_s: 0.0,
            pressed: false,
        }
    }

    /// Answers that were given up so far.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.link.lost()
    }

    fn handle(&mut self, pose: &Pose) -> HandleState {
        let position = axes::position(pose);
        let since_s = std::mem::take(&mut self.since_pose_s);
        HandleState {
            position,
            orientation: axes::orientation(pose),
            velocity: self.velocity.after(position, since_s),
        }
    }

    fn reading(&mut self, handle: HandleState) -> Reading {
        self.waited_s = 0.0;
        Reading {
            handle,
            switches: u32::from(self.pressed),
            in_range: true,
            is_permitted: true,
            motor_temperature: 0.0,
        }
    }

    /// Sends what is to be said next: a force; where there is none, from time to time the question for
    /// the button, which poses do not tell. Each is a command and holds off the watchdog, so amplifiers
    /// that rest have no current but are not off: neither poses nor the button are reported without one.
    fn say(&mut self, force: DVec3) -> Result<(), DeviceError> {
        if !self.link.is_free() {
            return Ok(());
        }
        let force = match self.amplifiers {
            Switch::On => force,
            Switch::Off => DVec3::ZERO,
        };
        if force == DVec3::ZERO && self.unasked_s >= BUTTON_S {
            self.unasked_s = 0.0;
            return self.link.send(Line::encoders(self.length).as_bytes());
        }
        let line = Line::force(axes::to_theirs(force), self.length);
        self.link.send(line.as_bytes())
    }
}

impl<W: Wire> Driver for Polhem<W> {
    fn abilities(&self) -> Abilities {
        Abilities {
            senses: stylus::axes::POSITION
                | stylus::axes::ORIENTATION
                | stylus::axes::VELOCITY
                | stylus::axes::SWITCHES,
            drives: stylus::axes::FORCE,
            max_force_n: MAX_FORCE_N,
            continuous_force_n: CONTINUOUS_N,
            max_torque_nm: 0.0,
            max_stiffness_n_m: MAX_STIFFNESS_N_M,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: DAMPING_N_S_M,
            workspace_m: [-REACH_M, -REACH_M, -REACH_M, REACH_M, REACH_M, REACH_M],
        }
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        let step_s = if dt >= self.waited_s {
            dt - self.waited_s
        } else {
            dt
        };
        self.unasked_s += step_s;
        self.since_pose_s += step_s;
        self.waited_s = dt;
        match self.link.poll(step_s)? {
            Some(Answer::Pose(pose)) => {
                let handle = self.handle(&pose);
                self.last = Some(handle);
                return Ok(Some(self.reading(handle)));
            }
            Some(Answer::Encoders(encoders)) => {
                self.pressed = encoders.is_pressed();
                // However slow the exchange was, a pose comes before the next question.
                self.unasked_s = 0.0;
                // Our own question is no stall of the device's: the hand is where it was, an exchange
                // ago, and there was no force.
                if let Some(handle) = self.last {
                    return Ok(Some(self.reading(handle)));
                }
            }
            None => {}
        }
        // Nobody writes where nothing was read, so the dialogue goes on by itself, without force.
        self.say(DVec3::ZERO)?;
        Ok(None)
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        self.say(wrench.force)
    }

    fn switch(&mut self, amplifiers: Switch) {
        self.amplifiers = amplifiers;
    }
}

/// However it ends, the last word is no force.
impl<W: Wire> Drop for Polhem<W> {
    fn drop(&mut self) {
        self.link
            .part(Line::force(DVec3::ZERO, self.length).as_bytes());
    }
}
