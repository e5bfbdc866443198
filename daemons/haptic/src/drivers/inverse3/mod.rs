//! Haply's Inverse3 with its VerseGrip, by Haply's Inverse service: JSON over a WebSocket
//! (docs.haply.co, inverseSDK, version 3.5, and what differs before).
//!
//! A force goes out for each state that comes in, at most four per millisecond. A state older than 20 ms is ignored; a
//! force that was not renewed, or not answered, for 20 ms drops to zero. A silent grip releases its switches, and after a
//! second the brush is out of range.
//!
//! | module | holds |
//! | --- | --- |
//! | [`address`] | which device of which service |
//! | [`message`] | the messages of both sides |
//! | [`axes`] | from the service's axes to the device frame |
//! | [`state`] | what is known of a device so far |
//! | [`connection`] | a WebSocket that never waits for long |
//! | [`link`] | the thread that talks to the service |

pub mod address;
pub mod axes;
pub mod connect_error;
pub mod connection;
pub mod link;
pub mod message;
pub mod state;

use std::sync::atomic::AtomicBool;

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::HandleState;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus;

use self::address::Address;
use self::connect_error::{ConnectError, Refusal};
use self::connection::{Connection, End, SILENCE};
use self::link::{FRESH_NS, Link, RequestedForce};
use self::message::{Device, Update};
use self::state::DeviceTracker;
use crate::device::driver::{Abilities, DeviceError, Driver, Opened, Reading, Wrench};
use crate::device::velocity::Velocity;
use crate::servo::clock::{MonotonicClock, monotonic_ns};

/// Largest force by what the service calls the device, N; see [`WEAKEST_N`] for others.
const MAX_FORCES_N: [(&str, f64); 2] = [("inverse3", 10.0), ("inverse3x", 10.0)];
/// Largest force of a Minverse, which is not published, and of what we do not know, N: as an Omni's.
const WEAKEST_N: f64 = 3.0;
/// Share of the largest force that warm motors bear is not published: as of an Omni's. The device tells
/// no temperature.
const CONTINUOUS: f64 = 0.3;
/// Largest stiffness, N/m.
const MAX_STIFFNESS_N_M: f64 = 1000.0;
/// Its own viscous friction, N·s/m, is published by nobody: the least of devices of its kind.
const DAMPING_N_S_M: f64 = 0.1;
/// Its working area: before its foot, as far as its arms reach, m.
const WORKSPACE_M: [f64; 6] = [-0.2, -0.05, -0.05, 0.2, 0.35, 0.3];

/// Opens the Inverse3 of a section: see [`Address`].
///
/// # Errors
/// A [`UserError`] that says what is missing.
pub fn open(device: &DeviceSection) -> Result<Opened, UserError> {
    let address = Address::read(device.address.as_deref())?;
    let driver = Inverse3::connect(&address)?;
    Ok(Opened {
        what: format!("Inverse3 {} at {}", driver.id, address.url),
        driver: Box::new(driver),
        clock: Box::new(MonotonicClock),
    })
}

/// An Inverse3.
#[derive(Debug)]
pub struct Inverse3 {
    link: Link,
    id: String,
    senses: u32,
    /// Largest force, N.
    max_force_n: f64,
    /// The number of the state that was read last.
    seen: u64,
    velocity: Velocity,
    amplifiers: Switch,
}

impl Inverse3 {
    /// Connects to the device of an address.
    ///
    /// # Errors
    /// [`ConnectError`].
    pub fn connect(address: &Address) -> Result<Self, ConnectError> {
        let mut connection = Connection::open(address)?;
        let update = inventory(&mut connection, address)?;
        let device = chosen(&update, address)?;
        let id = device.device_id.clone();
        let refused = |refusal| Err(ConnectError::new(&address.url, refusal));
        if device.is_in_use() {
            return refused(Refusal::InUse(id));
        }
        let max_force_n = max_force_n(device.kind());
        let has_grip = update.grip(address.grip.as_deref()).is_some();
        if let (Some(grip), false) = (&address.grip, has_grip) {
            let others = update.grips().map(str::to_owned).collect();
            return refused(Refusal::NoGrip(grip.clone(), others));
        }
        let mut tracker = DeviceTracker::new(&id, address.grip.as_deref());
        if let state::Seen::Hindered(hindrance) = tracker.take(&update, monotonic_ns()) {
            return refused(Refusal::Hindered(id, hindrance));
        }
        let link = Link::start(connection, tracker, update.dialect()).map_err(|error| {
            ConnectError::new(&address.url, Refusal::NoThread(error.to_string()))
        })?;
        let handle = match has_grip {
            true => stylus::axes::ORIENTATION | stylus::axes::SWITCHES,
            false => 0,
        };
        Ok(Self {
            link,
            id,
            senses: stylus::axes::POSITION | stylus::axes::VELOCITY | handle,
            max_force_n,
            seen: 0,
            velocity: Velocity::default(),
            amplifiers: Switch::On,
        })
    }

    /// Requests a force; resting amplifiers get a force of 0, which must be sent as well.
    fn ask(&mut self, force: DVec3) {
        self.link.ask(RequestedForce {
            force: match self.amplifiers {
                Switch::On => force,
                Switch::Off => DVec3::ZERO,
            },
            at_ns: monotonic_ns(),
        });
    }
}

fn max_force_n(kind: Option<&str>) -> f64 {
    MAX_FORCES_N
        .into_iter()
        .find_map(|(known, newtons)| (kind == Some(known)).then_some(newtons))
        .unwrap_or(WEAKEST_N)
}

/// The service's first message, which names all devices.
fn inventory(connection: &mut Connection, address: &Address) -> Result<Update, ConnectError> {
    let foreign = |why: String| ConnectError::new(&address.url, Refusal::Foreign(why));
    let bytes = connection
        .receive(&AtomicBool::new(false), SILENCE)
        .map_err(|end| match end {
            End::Closed | End::Stopped => foreign("it closes the connection".into()),
            End::Silent => foreign("it does not say what devices there are".into()),
            End::Foreign => foreign("its first message is no message".into()),
        })?;
    Update::read(&bytes).map_err(|error| foreign(format!("its first message is {error}")))
}

/// The device that an address means.
fn chosen<'a>(update: &'a Update, address: &Address) -> Result<&'a Device, ConnectError> {
    let devices = update.devices().iter();
    let ids = devices.map(|device| device.device_id.clone()).collect();
    let refused = |refusal| ConnectError::new(&address.url, refusal);
    match (&address.device, update.devices()) {
        (_, []) => Err(refused(Refusal::Absent)),
        (Some(id), _) => {
            let device = update.device(id);
            device.ok_or_else(|| refused(Refusal::NoDevice(id.clone(), ids)))
        }
        (None, [device]) => Ok(device),
        (None, _) => Err(refused(Refusal::Several(ids))),
    }
}

impl Driver for Inverse3 {
    fn abilities(&self) -> Abilities {
        Abilities {
            senses: self.senses,
            drives: stylus::axes::FORCE,
            max_force_n: self.max_force_n,
            continuous_force_n: self.max_force_n * CONTINUOUS,
            max_torque_nm: 0.0,
            max_stiffness_n_m: MAX_STIFFNESS_N_M,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: DAMPING_N_S_M,
            workspace_m: WORKSPACE_M,
        }
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        let told = self.link.newest()?;
        if told.number == self.seen {
            return Ok(None);
        }
        self.seen = told.number;
        if monotonic_ns().saturating_sub(told.at_ns) > FRESH_NS {
            return Ok(None);
        }
        let pose = told.pose;
        let found = self.velocity.after(pose.position, dt);
        Ok(Some(Reading {
            handle: HandleState {
                position: pose.position,
                orientation: pose.orientation,
                velocity: pose.velocity.unwrap_or(found),
            },
            switches: pose.switches,
            in_range: pose.in_range,
            is_permitted: true,
            motor_temperature: 0.0,
        }))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        let force = if wrench.force.is_finite() {
            wrench.force.clamp_length_max(self.max_force_n)
        } else {
            DVec3::ZERO
        };
        self.ask(force);
        Ok(())
    }

    fn switch(&mut self, amplifiers: Switch) {
        self.amplifiers = amplifiers;
        self.ask(DVec3::ZERO);
    }
}
