//! Driver interface: a haptic device as the servo sees it.

use std::ops::ControlFlow;

use glam::DVec3;
use maulstick_haptics::contact::HandleState;
use maulstick_haptics::{Limits, Switch};

/// The state of a device at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The handle, in the device frame as a driver reads it, in the desk frame as
    /// [`MountedDevice`](crate::MountedDevice) hands it on.
    pub handle: HandleState,
    /// Pressed switches, one bit each.
    pub switches: u32,
    /// True while the stylus is in range.
    pub in_range: bool,
    /// True while the dead man's switch is held, or the device has none.
    pub is_permitted: bool,
    /// Temperature of the hottest motor, 0 cold to 1 hot; 0 if the device does not report it.
    pub motor_temperature: f64,
}

/// Force and torque of the motors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force on the hand, N.
    pub force: DVec3,
    /// Torque about the point that the device senses, N·m.
    pub torque: DVec3,
}

impl Wrench {
    /// Motors without force.
    pub const ZERO: Self = Self {
        force: DVec3::ZERO,
        torque: DVec3::ZERO,
    };
}

/// Loss of a device. It is made on the real-time thread, so it owns no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceError {
    /// Description.
    pub what: &'static str,
    /// The device's or the system's own error code, or 0.
    pub code: i64,
    /// Remedy.
    pub help: &'static str,
}

impl std::fmt::Display for DeviceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.code {
            0 => write!(f, "{}", self.what),
            code => write!(f, "{} ({code:#x})", self.what),
        }
    }
}

/// Abilities of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abilities {
    /// Sensed quantities, as in [`maulstick_types::stylus::axes`].
    pub senses: u32,
    /// Driven quantities, likewise.
    pub drives: u32,
    /// Largest force, N.
    pub max_force_n: f64,
    /// Largest force that its motors bear continuously, N.
    pub continuous_force_n: f64,
    /// Largest torque, N·m, or 0.
    pub max_torque_nm: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Fastest change of the force that it takes, N/s; infinite where it names none.
    pub max_slew_n_s: f64,
    /// Speed of the hand above which it gives no force, m/s; infinite where it names none.
    pub max_speed_m_s: f64,
    /// Lower bound of its own viscous friction, N·s/m.
    pub damping_n_s_m: f64,
    /// Working area in the device frame: least x, y, z, then greatest, m.
    pub workspace_m: [f64; 6],
}

impl Abilities {
    /// Bounds of a servo over the device that gives at most `max_force_n`, device frame.
    #[must_use]
    pub fn limits(&self, max_force_n: f64) -> Limits {
        let usual = Limits::default();
        Limits {
            max_force_n: max_force_n.min(self.max_force_n),
            continuous_force_n: max_force_n.min(self.continuous_force_n),
            max_stiffness_n_m: self.max_stiffness_n_m,
            damping_n_s_m: self.damping_n_s_m,
            slew_n_s: usual.slew_n_s.min(self.max_slew_n_s),
            max_speed_m_s: usual.max_speed_m_s.min(self.max_speed_m_s),
            ..usual
        }
    }
}

/// Driver of a device; it knows its own frame only. Its methods run on the real-time thread: no allocation,
/// no lock, no system call except the device's own. Each reading is followed by one writing.
pub trait Driver: Send {
    /// Abilities of the device.
    fn abilities(&self) -> Abilities;
    /// Reads the device, `dt` s after the previous reading; device frame. None if it has nothing new: the
    /// servo skips the tick, and after a few such ticks there is no force.
    ///
    /// # Errors
    /// [`DeviceError`] if the device is lost: it is closed, and opened again when it is back.
    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError>;
    /// Sets force and torque of the motors, device frame.
    ///
    /// # Errors
    /// As [`Driver::read`].
    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError>;
    /// Switches the amplifiers, if the device has a switch for them.
    fn switch(&mut self, _amplifiers: Switch) {}
}

/// Owner of the thread that runs the servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caller {
    /// The daemon.
    Us,
    /// The vendor's library, which sets the thread's priority.
    Vendor,
}

/// Clock of the servo: the system's, or the scheduler of a vendor's library.
pub trait ServoClock: Send {
    /// Calls `tick` a thousand times a second with its lateness, ns, until it breaks off; then returns.
    ///
    /// # Errors
    /// [`DeviceError`] if the clock itself fails.
    fn run(
        &mut self,
        tick: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), DeviceError>;
    /// Owner of the thread that calls `tick`.
    fn caller(&self) -> Caller {
        Caller::Us
    }
}

/// An open device.
pub struct Opened {
    /// Its driver.
    pub driver: Box<dyn Driver>,
    /// The clock of its servo.
    pub clock: Box<dyn ServoClock>,
    /// Description for the log: model, serial number, port.
    pub what: String,
}
