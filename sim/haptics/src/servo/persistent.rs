//! Servo state that survives the loss of its device.

use super::fault::Fault;
use super::limits::Limits;
use super::motor_thermal::MotorThermal;

/// State for the next servo of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoMemory {
    /// Latched fault.
    pub fault: Option<Fault>,
    /// Thermal state of the motors.
    pub thermal: MotorThermal,
}

impl ServoMemory {
    /// The state without an earlier servo.
    #[must_use]
    pub fn fresh(limits: Limits) -> Self {
        Self {
            fault: None,
            thermal: MotorThermal::cold(limits.max_force_n),
        }
    }

    /// The state after the motors have cooled for `seconds`.
    #[must_use]
    pub fn cooled(mut self, seconds: f64) -> Self {
        self.thermal.warm(0.0, 1.0, seconds.max(0.0));
        self
    }
}
