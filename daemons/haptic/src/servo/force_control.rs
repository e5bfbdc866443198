//! The painter's settings of a device's force, for the servo.

use maulstick_haptics::{Servo, Switch};

/// Force settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceControl {
    /// Force on or off.
    pub switch: Switch,
    /// Share of the models' force that is given, 0 to 1.
    pub strength: f64,
    /// Share of the guides' force that is given, 0 to 1.
    pub guidance: f64,
    /// Number of times that the force was re-armed.
    pub rearms: u64,
}

impl Default for ForceControl {
    fn default() -> Self {
        Self {
            switch: Switch::On,
            strength: 1.0,
            guidance: 1.0,
            rearms: 0,
        }
    }
}

impl ForceControl {
    /// Applies to the servo each setting in which `newest` differs.
    pub fn apply(&mut self, newest: Self, servo: &mut Servo) {
        if newest.switch != self.switch {
            servo.switch(newest.switch);
        }
        if newest.strength != self.strength {
            servo.set_strength(newest.strength);
        }
        if newest.guidance != self.guidance {
            servo.set_guidance(newest.guidance);
        }
        if newest.rearms != self.rearms {
            servo.rearm();
        }
        *self = newest;
    }
}
