//! Force Dimension's omega, delta, sigma and lambda, and Novint's Falcon, through the vendor's libdhd (SDK 3.16), which is
//! polled by our own clock.
//!
//! A call that fails, values that are not finite, or 200 readings without anything new end the force. The amplifiers are
//! off while nothing is touched, after a fault, and once the daemon ends.
//!
//! | module | holds |
//! | --- | --- |
//! | [`library`] | the vendor's functions |
//! | [`model`] | limits of the models |
//! | [`axes`] | from the vendor's axes to the device frame |

pub mod axes;
pub mod library;
pub mod model;

use glam::DVec3;
use maulstick_haptics::Switch;
use maulstick_haptics::contact::HandleState;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus;

use self::library::{Dhd, Library};
use self::model::Model;
use crate::device::driver::{Abilities, DeviceError, Driver, Opened, Reading, Wrench};
use crate::servo::clock::MonotonicClock;

/// Half of the working area of the smallest model, m.
const REACH_M: f64 = 0.05;
/// Readings without anything new, one after the other, after which the device is taken for lost.
const MOST_EMPTY: u32 = 200;

/// Opens the device of a section: that of the serial number `address`, or the first.
///
/// # Errors
/// A [`UserError`] that says what is missing.
pub fn open(device: &DeviceSection) -> Result<Opened, UserError> {
    let library = Library::find(device.library.as_deref())?;
    let dhd = library.open(device.address.as_deref())?;
    let model = Model::of(dhd.system_type());
    let what = format!("{}, libdhd {}", dhd.name(), library.version());
    Ok(Opened {
        driver: Box::new(ForceDimension::new(dhd, model)),
        clock: Box::new(MonotonicClock),
        what,
    })
}

/// An open device.
#[derive(Debug)]
pub struct ForceDimension {
    dhd: Dhd,
    model: Model,
    has_wrist: bool,
    has_force: bool,
    empty: u32,
}

impl ForceDimension {
    fn new(dhd: Dhd, model: Model) -> Self {
        // Brakes are on as it is opened.
        dhd.set_force(DVec3::ZERO).ok();
        dhd.enable_force(true);
        Self {
            has_wrist: dhd.has_wrist(),
            dhd,
            model,
            has_force: true,
            empty: 0,
        }
    }
}

impl Driver for ForceDimension {
    fn abilities(&self) -> Abilities {
        let wrist = if self.has_wrist {
            stylus::axes::ORIENTATION
        } else {
            0
        };
        Abilities {
            senses: stylus::axes::POSITION
                | stylus::axes::VELOCITY
                | stylus::axes::SWITCHES
                | wrist,
            drives: stylus::axes::FORCE,
            max_force_n: self.model.force_n,
            continuous_force_n: self.model.continuous_n,
            max_torque_nm: 0.0,
            max_stiffness_n_m: self.model.stiffness_n_m,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: model::DAMPING_N_S_M,
            workspace_m: [-REACH_M, -REACH_M, -REACH_M, REACH_M, REACH_M, REACH_M],
        }
    }

    fn read(&mut self, _dt: f64) -> Result<Option<Reading>, DeviceError> {
        let Some(pose) = self.dhd.pose()? else {
            // The library guards its time: nothing is new. A device that never says more is gone.
            self.empty += 1;
            return if self.empty < MOST_EMPTY {
                Ok(None)
            } else {
                Err(library::SILENT)
            };
        };
        let velocity = self.dhd.velocity()?;
        let switches = self.dhd.buttons();
        if !(pose.is_finite() && velocity.is_finite()) {
            return Err(library::NOT_FINITE);
        }
        self.empty = 0;
        Ok(Some(Reading {
            handle: HandleState {
                position: axes::to_ours(pose.position),
                orientation: axes::orientation(&pose.frame),
                velocity: axes::to_ours(velocity),
            },
            switches,
            in_range: true,
            is_permitted: true,
            motor_temperature: 0.0,
        }))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        self.dhd.set_force(axes::to_theirs(wrench.force))
    }

    fn switch(&mut self, amplifiers: Switch) {
        let on = amplifiers == Switch::On;
        if on != self.has_force {
            self.dhd.enable_force(on);
            self.has_force = on;
        }
    }
}

/// However it ends, the last word is no force, and the amplifiers are off.
impl Drop for ForceDimension {
    fn drop(&mut self) {
        self.dhd.set_force(DVec3::ZERO).ok();
        self.dhd.enable_force(false);
    }
}
