//! Controllers of a headset as styluses, through the OpenXR runtime that the user has.
//!
//! The brush sticks out where the controller points. The trigger pushes it forward along its bristles, and the controller
//! vibrates by the force that a device with motors would give. It is polled by our own clock.
//!
//! | module | holds |
//! | --- | --- |
//! | [`runtime`] | the runtime, its session and its actions |
//! | [`bindings`] | the parts of each kind of controller |
//! | [`vibration`] | from a force to a vibration |

pub mod bindings;
pub mod runtime;
pub mod vibration;

use glam::{DQuat, DVec3};
use maulstick_haptics::contact::HandleState;
use maulstick_num::geometry::canonical;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus::axes;

use self::bindings::Hand;
use self::runtime::{ControllerInputs, Runtime};
use self::vibration::Vibration;
use crate::device::driver::{Abilities, DeviceError, Driver, Opened, Reading, Wrench};
use crate::device::velocity::Velocity;
use crate::servo::clock::MonotonicClock;

/// Way by which a trigger that is pulled fully pushes the brush forward, m.
const PUSH_M: f64 = 0.02;
/// The middle of the canvas from where the headset was as the session began, m: a bit below, at arm's length.
const CANVAS_M: DVec3 = DVec3::new(0.0, -0.25, -0.45);
/// Half of the reach of an arm about it, m.
const REACH_M: f64 = 0.35;
/// Ticks between two looks at what is pressed.
const PRESSED_EVERY: u32 = 4;
/// Force that makes it vibrate fully, N.
const FULL_N: f64 = 3.0;

/// Opens the controller of a section: that of the hand `address`, or the right one.
///
/// # Errors
/// A [`UserError`] that says what is missing.
pub fn open(device: &DeviceSection) -> Result<Opened, UserError> {
    let hand = Hand::named(device.address.as_deref())?;
    let runtime = Runtime::start(device.library.as_deref(), hand)?;
    let what = format!("the {hand} controller of {}", runtime.name());
    Ok(Opened {
        driver: Box::new(Controller {
            runtime,
            inputs: ControllerInputs::default(),
            newest: HandleState {
                position: DVec3::ZERO,
                orientation: DQuat::IDENTITY,
                velocity: DVec3::ZERO,
            },
            velocity: Velocity::default(),
            vibration: Vibration::default(),
            ticks: 0,
        }),
        clock: Box::new(MonotonicClock),
        what,
    })
}

/// A controller in a hand.
pub struct Controller {
    runtime: Runtime,
    inputs: ControllerInputs,
    newest: HandleState,
    velocity: Velocity,
    vibration: Vibration,
    ticks: u32,
}

impl Driver for Controller {
    fn abilities(&self) -> Abilities {
        Abilities {
            senses: axes::POSITION | axes::ORIENTATION | axes::VELOCITY | axes::SWITCHES,
            drives: axes::FORCE,
            max_force_n: FULL_N,
            continuous_force_n: FULL_N,
            max_torque_nm: 0.0,
            max_stiffness_n_m: 400.0,
            max_slew_n_s: f64::INFINITY,
            max_speed_m_s: f64::INFINITY,
            damping_n_s_m: 0.1,
            workspace_m: [-REACH_M, -REACH_M, -REACH_M, REACH_M, REACH_M, REACH_M],
        }
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        if self.ticks.is_multiple_of(PRESSED_EVERY) {
            self.inputs = self.runtime.inputs()?;
        }
        self.ticks = self.ticks.wrapping_add(1);
        let place = if self.inputs.is_there {
            self.runtime.pose()?
        } else {
            None
        };
        if let Some(place) = place {
            let orientation = canonical(place.orientation);
            let forward = orientation * -DVec3::Z;
            let position = place.position - CANVAS_M + forward * (PUSH_M * self.inputs.trigger);
            self.newest = HandleState {
                position,
                orientation,
                velocity: self.velocity.after(position, dt),
            };
        } else {
            self.velocity = Velocity::default();
        }
        Ok(Some(Reading {
            handle: self.newest,
            switches: self.inputs.switches,
            in_range: place.is_some(),
            is_permitted: place.is_some(),
            motor_temperature: 0.0,
        }))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        match self.vibration.follow(wrench.force / FULL_N) {
            Some(amplitude) => self.runtime.vibrate(amplitude),
            None => Ok(()),
        }
    }
}

/// However it ends, it vibrates no more.
impl Drop for Controller {
    fn drop(&mut self) {
        self.runtime.vibrate(0.0).ok();
    }
}
