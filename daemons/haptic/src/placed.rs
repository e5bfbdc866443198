//! Where a device stands on the desk.

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::Held;
use maulstick_num::geometry::{Rigid, canonical};

use crate::driver::{Abilities, Driver, Reading, Trouble, Wrench};

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
    ///
    /// # Errors
    /// As [`Driver::read`].
    pub fn read(&mut self, dt: f64) -> Result<Option<Reading>, Trouble> {
        let Some(reading) = self.driver.read(dt)? else {
            return Ok(None);
        };
        let held = reading.held;
        Ok(Some(Reading {
            held: Held {
                position: self.to_desk.point(held.position),
                orientation: canonical(self.to_desk.rotation * held.orientation),
                velocity: self.to_desk.vector(held.velocity),
            },
            ..reading
        }))
    }

    /// Sets the force on the hand, N, desk frame.
    ///
    /// # Errors
    /// As [`Driver::write`].
    pub fn write(&mut self, force: DVec3) -> Result<(), Trouble> {
        self.driver.write(Wrench {
            force: self.to_device.vector(force),
            torque: DVec3::ZERO,
        })
    }

    /// Switches its amplifiers, where they can be.
    pub fn switch(&mut self, amplifiers: Switch) {
        self.driver.switch(amplifiers);
    }
}

/// However the servo ends, also by a panic, no force stays on the hand.
impl Drop for Placed {
    fn drop(&mut self) {
        self.driver.write(Wrench::ZERO).ok();
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
