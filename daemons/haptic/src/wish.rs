//! What a painter wants of a device's force, on its way to the servo.

use maulstick_haptics::{Servo, Switch};

/// What a painter wants of the force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Whether there is any.
    pub switch: Switch,
    /// Share of what the models ask for, 0 to 1.
    pub strength: f64,
    /// Counts how often it was armed again.
    pub armings: u64,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            switch: Switch::On,
            strength: 1.0,
            armings: 0,
        }
    }
}

impl Wish {
    /// Has the servo do what is wanted now and was not before.
    pub fn follow(&mut self, wanted: Self, servo: &mut Servo) {
        if wanted.switch != self.switch {
            servo.switch(wanted.switch);
        }
        if wanted.strength != self.strength {
            servo.set_strength(wanted.strength);
        }
        if wanted.armings != self.armings {
            servo.rearm();
        }
        *self = wanted;
    }
}
