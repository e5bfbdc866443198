//! What outlasts a servo: a device that is lost and found again is no other device.

use super::fault::Fault;
use super::heat::Heat;
use super::limits::Limits;

/// What the next servo over a device is to know of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// The fault that is latched.
    pub fault: Option<Fault>,
    /// How warm the motors are.
    pub heat: Heat,
}

impl Kept {
    /// There was none before.
    #[must_use]
    pub fn nothing(limits: Limits) -> Self {
        Self {
            fault: None,
            heat: Heat::cold(limits.max_force_n),
        }
    }

    /// The motors have cooled for so long, s.
    #[must_use]
    pub fn rested(mut self, seconds: f64) -> Self {
        self.heat.warm(0.0, 1.0, seconds.max(0.0));
        self
    }
}
