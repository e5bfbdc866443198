//! What outlasts a servo: a device that is lost and found again is no other device.

use super::fault::Fault;
use super::limits::Limits;
use super::motor_thermal::MotorThermal;

/// What the next servo over a device is to know of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoMemory {
    /// The fault that is latched.
    pub fault: Option<Fault>,
    /// How warm the motors are.
    pub thermal: MotorThermal,
}

impl ServoMemory {
    /// There was none before.
    #[must_use]
    pub fn fresh(limits: Limits) -> Self {
        Self {
            fault: None,
            thermal: MotorThermal::cold(limits.max_force_n),
        }
    }

    /// The motors have cooled for so long, s.
    #[must_use]
    pub fn cooled(mut self, seconds: f64) -> Self {
        self.thermal.warm(0.0, 1.0, seconds.max(0.0));
        self
    }
}
