//! What a device is to the servo, and where it stands on the desk.

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::Held;
use maulstick_num::geometry::{Rigid, canonical};

/// The state of a device at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The brush in the hand: in the device frame as a driver reads it, in the desk frame as
    /// [`Placed`] hands it on.
    pub held: Held,
    /// A bit a pressed switch.
    pub switches: u32,
    /// Whether the stylus counts.
    pub in_range: bool,
    /// The hottest motor, 0 cold to 1 hot; 0 where the device does not say.
    pub motor_temperature: f64,
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
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Its own viscous friction, at least, N·s/m.
    pub damping_n_s_m: f64,
    /// Working area in the device frame: least x, y, z, then greatest, m.
    pub workspace_m: [f64; 6],
}

/// A device whose loop is ours; it knows its own frame only. Its methods run on the real-time
/// thread: no allocation, no lock.
pub trait Driver: Send {
    /// What it can do.
    fn abilities(&self) -> Abilities;
    /// Reads it, `dt` s after the reading before; device frame.
    fn read(&mut self, dt: f64) -> Reading;
    /// Sets the force on the hand, N, device frame.
    fn write(&mut self, force: DVec3);
    /// Switches its amplifiers, where they can be.
    fn switch(&mut self, _amplifiers: Switch) {}
}

/// A device where it stands on the desk. Contact models are in the desk frame, so the servo sees
/// the device through this.
pub struct Placed {
    driver: Box<dyn Driver>,
    to_desk: Rigid,
    to_device: Rigid,
}

impl Placed {
    /// A device whose frame goes to the desk frame by `to_desk`.
    #[must_use]
    pub fn new(driver: Box<dyn Driver>, to_desk: Rigid) -> Self {
        Self {
            driver,
            to_desk,
            to_device: to_desk.inverse(),
        }
    }

    /// What it can do; the working area is the box, in the desk frame, around the turned one.
    #[must_use]
    pub fn abilities(&self) -> Abilities {
        let abilities = self.driver.abilities();
        let [x0, y0, z0, x1, y1, z1] = abilities.workspace_m;
        let (mut least, mut greatest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for x in [x0, x1] {
            for y in [y0, y1] {
                for z in [z0, z1] {
                    let corner = self.to_desk.point(DVec3::new(x, y, z));
                    (least, greatest) = (least.min(corner), greatest.max(corner));
                }
            }
        }
        Abilities {
            workspace_m: [
                least.x, least.y, least.z, greatest.x, greatest.y, greatest.z,
            ],
            ..abilities
        }
    }

    /// Reads it, `dt` s after the reading before; desk frame.
    pub fn read(&mut self, dt: f64) -> Reading {
        let reading = self.driver.read(dt);
        let held = reading.held;
        Reading {
            held: Held {
                position: self.to_desk.point(held.position),
                orientation: canonical(self.to_desk.rotation * held.orientation),
                velocity: self.to_desk.vector(held.velocity),
            },
            ..reading
        }
    }

    /// Sets the force on the hand, N, desk frame.
    pub fn write(&mut self, force: DVec3) {
        self.driver.write(self.to_device.vector(force));
    }

    /// Switches its amplifiers, where they can be.
    pub fn switch(&mut self, amplifiers: Switch) {
        self.driver.switch(amplifiers);
    }
}

/// However the servo ends, also by a panic, no force stays on the hand.
impl Drop for Placed {
    fn drop(&mut self) {
        self.driver.write(DVec3::ZERO);
        self.driver.switch(Switch::Off);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use maulstick_num::geometry::rotation;

    use super::*;
    use crate::simulated::Simulated;

    #[test]
    fn the_working_area_turns_with_the_device() {
        let to_desk = Rigid {
            rotation: rotation(DVec3::X, FRAC_PI_2),
            translation: DVec3::new(1.0, 0.0, 0.0),
        };
        let driver = Simulated::at_rest();
        let [x0, y0, z0, x1, y1, z1] = driver.abilities().workspace_m;
        let placed = Placed::new(Box::new(driver), to_desk);
        // A quarter turn about x: y is minus what z was, z is what y was.
        let expected = [x0 + 1.0, -z1, y0, x1 + 1.0, -z0, y1];
        let got = placed.abilities().workspace_m;
        let off = got.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{got:?} {expected:?}");
    }
}
