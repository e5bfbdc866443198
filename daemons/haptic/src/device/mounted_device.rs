//! A device mounted on the desk: pose, scale, lever to the ferrule, clutch.
//!
//! Desk lengths are s device lengths. The hand is given f/s where the desk asks for f, so stiffness
//! and damping are the same in both frames; see [`Limits::scaled`](maulstick_haptics::Limits::scaled)
//! for what that means to the servo's bounds.

use glam::DVec3;
use maulstick_device::registration::Registration;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::HandleState;

use crate::device::driver::{Abilities, DeviceError, Driver, Reading, Wrench};

/// Corner of the filter on the velocity of the ferrule about the point that is sensed, rad/s (60 Hz):
/// it is a difference of readings.
const VELOCITY_CORNER: f64 = 377.0;

/// Clutch that lets the hand move without the brush, as a mouse is lifted and put down elsewhere. While
/// one of its switches is pressed the ferrule stays in place, the brush is out of range and turns on the
/// spot with the hand, and there is no force; after release the motion goes on from that place. The
/// offset lasts until the device is opened again.
#[derive(Clone, Copy, Debug, Default)]
struct Clutch {
    /// Bits of its switches.
    switches: u32,
    /// Offset of the hand by all clutched motion so far, desk frame, m.
    moved: DVec3,
    /// Place of the ferrule while the clutch is pressed, desk frame, m.
    aside: Option<DVec3>,
}

impl Clutch {
    /// Place of the ferrule that the device alone puts at `place`.
    fn follow(&mut self, place: DVec3, switches: u32) -> DVec3 {
        let aside = self.aside.unwrap_or(place + self.moved);
        if switches & self.switches != 0 {
            self.aside = Some(aside);
            return aside;
        }
        if self.aside.take().is_some() {
            self.moved = aside - place;
        }
        aside
    }
}

/// Lever from the sensed point to the ferrule, device frame.
#[derive(Clone, Copy, Debug, Default)]
struct Lever {
    /// Offset of the ferrule, m.
    arm: DVec3,
    /// Velocity of the ferrule about the sensed point, m/s.
    velocity: DVec3,
    /// True after the first reading.
    is_known: bool,
}

impl Lever {
    fn turn(&mut self, arm: DVec3, dt: f64) {
        // Velocity from a difference, as the vendors' libraries do where a device senses none.
        if self.is_known && dt > 0.0 {
            let raw = (arm - self.arm) / dt;
            self.velocity += (raw - self.velocity) * (VELOCITY_CORNER * dt).min(1.0);
        }
        (self.arm, self.is_known) = (arm, true);
    }
}

/// A device mounted on the desk. Contact models are in the desk frame, so the servo sees the device
/// through this.
pub struct MountedDevice {
    driver: Box<dyn Driver>,
    registration: Registration,
    max_torque_nm: f64,
    lever: Lever,
    clutch: Clutch,
}

impl MountedDevice {
    /// Mounts a device by its registration; the switches of the bits `clutch` are its clutch.
    #[must_use]
    pub fn new(driver: Box<dyn Driver>, registration: Registration, clutch: u32) -> Self {
        let max_torque_nm = driver.abilities().max_torque_nm.max(0.0);
        Self {
            driver,
            registration,
            max_torque_nm,
            lever: Lever::default(),
            clutch: Clutch {
                switches: clutch,
                ..Clutch::default()
            },
        }
    }

    /// Abilities of the device; forces are those of the motors, the working area is the desk frame's
    /// bounding box of the turned one.
    #[must_use]
    pub fn abilities(&self) -> Abilities {
        let abilities = self.driver.abilities();
        let [x0, y0, z0, x1, y1, z1] = abilities.workspace_m;
        let (mut least, mut greatest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for x in [x0, x1] {
            for y in [y0, y1] {
                for z in [z0, z1] {
                    let corner = self.registration.to_desk.point(DVec3::new(x, y, z));
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

    /// Desk lengths per device length.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.registration.to_desk.scale
    }

    /// Reads the device, `dt` s after the previous reading; desk frame.
    ///
    /// # Errors
    /// As [`Driver::read`].
    pub fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        let Some(reading) = self.driver.read(dt)? else {
            return Ok(None);
        };
        let (handle, to_desk) = (reading.handle, &self.registration.to_desk);
        self.lever
            .turn(handle.orientation * self.registration.ferrule_m, dt);
        let place = to_desk.point(handle.position + self.lever.arm);
        let place = self.clutch.follow(place, reading.switches);
        let handle = HandleState {
            position: place,
            orientation: to_desk.turned(handle.orientation),
            velocity: to_desk.vector(handle.velocity + self.lever.velocity),
        };
        Ok(Some(match self.clutch.aside {
            None => Reading { handle, ..reading },
            Some(_) => Reading {
                handle: HandleState {
                    velocity: DVec3::ZERO,
                    ..handle
                },
                in_range: false,
                is_permitted: false,
                ..reading
            },
        }))
    }

    /// Force on the hand for a force of the desk, N, in the desk's axes.
    #[must_use]
    pub fn on_hand(&self, force: DVec3) -> DVec3 {
        force / self.scale()
    }

    /// Sets the force at the ferrule, N, and the brush's torque about it, N·m, desk frame. A device that drives torque
    /// gives that and the force's torque about the sensed point, together up to its largest. Force and lever are both s
    /// times as large on the desk, so torque is s² times.
    ///
    /// # Errors
    /// As [`Driver::write`].
    pub fn write(&mut self, force: DVec3, torque: DVec3) -> Result<(), DeviceError> {
        let to_desk = &self.registration.to_desk;
        let force = to_desk.turn_back(self.on_hand(force));
        let own = to_desk.turn_back(torque / (self.scale() * self.scale()));
        let torque = self.lever.arm.cross(force) + own;
        self.driver.write(Wrench {
            force,
            torque: torque.clamp_length_max(self.max_torque_nm),
        })
    }

    /// Switches the amplifiers, if the device has a switch for them.
    pub fn switch(&mut self, amplifiers: Switch) {
        self.driver.switch(amplifiers);
    }
}

/// Takes the force off the hand however the servo ends, also by a panic.
impl Drop for MountedDevice {
    fn drop(&mut self) {
        self.driver.write(Wrench::ZERO).ok();
        self.driver.switch(Switch::Off);
    }
}

#[cfg(test)]
mod tests;
