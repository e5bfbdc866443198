//! What a device is to the servo.

use std::ops::ControlFlow;

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::Held;

/// The state of a device at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The brush in the hand: in the device frame as a driver reads it, in the desk frame as
    /// [`Placed`](crate::Placed) hands it on.
    pub held: Held,
    /// A bit a pressed switch.
    pub switches: u32,
    /// Whether the stylus counts.
    pub in_range: bool,
    /// Whether the dead man's switch is held, where the device has one; true where it has none.
    pub is_permitted: bool,
    /// The hottest motor, 0 cold to 1 hot; 0 where the device does not say.
    pub motor_temperature: f64,
}

/// What the motors do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force on the hand, N.
    pub force: DVec3,
    /// Torque about the point that the device senses, N·m.
    pub torque: DVec3,
}

impl Wrench {
    /// Nothing.
    pub const ZERO: Self = Self {
        force: DVec3::ZERO,
        torque: DVec3::ZERO,
    };
}

/// Why a device gives nothing any more. It is made on the real-time thread, so it owns nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trouble {
    /// What is wrong.
    pub what: &'static str,
    /// The device's or the system's own number for it; 0 where there is none.
    pub code: i64,
    /// What to do.
    pub help: &'static str,
}

impl std::fmt::Display for Trouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.code {
            0 => write!(f, "{}", self.what),
            code => write!(f, "{} ({code:#x})", self.what),
        }
    }
}

/// What a device can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abilities {
    /// What it senses, see [`maulstick_types::stylus::axes`].
    pub senses: u32,
    /// What it drives.
    pub drives: u32,
    /// Largest force, N.
    pub max_force_n: f64,
    /// Largest force that warm motors bear, N.
    pub continuous_force_n: f64,
    /// Largest torque, N·m; 0 where it drives none.
    pub max_torque_nm: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Its own viscous friction, at least, N·s/m.
    pub damping_n_s_m: f64,
    /// Working area in the device frame: least x, y, z, then greatest, m.
    pub workspace_m: [f64; 6],
}

/// A device; it knows its own frame only. Its methods run on the real-time thread: no allocation, no
/// lock, no call of the system but what the device needs. Each reading is followed by one writing.
pub trait Driver: Send {
    /// What it can do.
    fn abilities(&self) -> Abilities;
    /// Reads it, `dt` s after the reading before; device frame. None where nothing new has come: the
    /// servo lets the tick pass, and after a few such ticks there is no force.
    ///
    /// # Errors
    /// A [`Trouble`] where the device is lost: it is closed, and opened again when it is back.
    fn read(&mut self, dt: f64) -> Result<Option<Reading>, Trouble>;
    /// Sets what the motors do, device frame.
    ///
    /// # Errors
    /// As [`Driver::read`].
    fn write(&mut self, wrench: Wrench) -> Result<(), Trouble>;
    /// Switches its amplifiers, where they can be.
    fn switch(&mut self, _amplifiers: Switch) {}
}

/// Whose thread a servo is called on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caller {
    /// The one that runs the clock.
    Us,
    /// The vendor's, who has seen to its priority.
    Vendor,
}

/// Who calls the servo: our own clock, or the thread of a vendor's library.
pub trait Pace: Send {
    /// Calls `beat` a thousand times a second, with how late it is, ns, until it says that it is over;
    /// then returns.
    ///
    /// # Errors
    /// A [`Trouble`] where the clock itself fails.
    fn run(&mut self, beat: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send))
    -> Result<(), Trouble>;
    /// On whose thread it calls.
    fn caller(&self) -> Caller {
        Caller::Us
    }
}

/// A device that has been opened.
pub struct Opened {
    /// The device.
    pub driver: Box<dyn Driver>,
    /// Who calls the servo.
    pub pace: Box<dyn Pace>,
    /// What it is, in words: model, serial number, port.
    pub what: String,
}
