//! What a device is to the servo.

use glam::DVec3;
use maulstick_haptics::contact::Held;

/// The state of a device at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The brush in the hand, desk frame.
    pub held: Held,
    /// A bit a pressed switch.
    pub switches: u32,
    /// Whether the stylus counts.
    pub in_range: bool,
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
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Working area in the desk frame: least x, y, z, then greatest, m.
    pub workspace_m: [f64; 6],
}

/// A device whose loop is ours. Its methods run on the real-time thread: no allocation, no lock.
pub trait Driver: Send {
    /// What it can do.
    fn abilities(&self) -> Abilities;
    /// Reads it, `dt` s after the reading before.
    fn read(&mut self, dt: f64) -> Reading;
    /// Sets the force on the hand, N, desk frame.
    fn write(&mut self, force: DVec3);
}
