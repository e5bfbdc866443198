//! Commands of the painter and of the device: switches, strength, heat.

use super::Servo;
use super::oscillation::Oscillation;
use super::tick::Switch;

/// Permission for force, and its strength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orders {
    switch: Switch,
    /// State of the dead man's switch.
    permitted: Switch,
    strength: f64,
}

impl Default for Orders {
    fn default() -> Self {
        Self {
            switch: Switch::On,
            permitted: Switch::On,
            strength: 1.0,
        }
    }
}

impl Orders {
    /// True where no force is allowed.
    pub(super) fn are_off(&self) -> bool {
        [self.switch, self.permitted].contains(&Switch::Off)
    }

    /// Share of all force, 0 to 1.
    pub(super) fn strength(&self) -> f64 {
        self.strength
    }
}

impl Servo {
    /// Sets the share of the guides' force, 0 to 1.
    pub fn set_guidance(&mut self, share: f64) {
        self.guidance.set_share(share_of(share));
    }

    /// Allows force again after a fault; it engages anew.
    pub fn rearm(&mut self) {
        self.fault = None;
        self.thermal.forget_unknown();
        self.oscillation = Oscillation::default();
        self.guidance.forget();
        self.engage_anew();
    }

    /// Switches the force off at once, or on with a new engagement.
    pub fn switch(&mut self, switch: Switch) {
        self.orders.switch = switch;
        self.wait();
    }

    /// Updates the dead man's switch: released, it stops the force, which then engages anew.
    pub fn permit(&mut self, dead_man: Switch) {
        self.orders.permitted = dead_man;
        if dead_man == Switch::Off {
            self.wait();
        }
    }

    /// Makes both forces engage anew.
    pub(super) fn wait(&mut self) {
        self.engagement.wait_anew();
        self.guidance.engage_anew();
    }

    /// Sets the share of all force, 0 to 1.
    pub fn set_strength(&mut self, share: f64) {
        self.orders.strength = share_of(share);
    }

    /// Updates the temperature of the hottest motor, 0 cold to 1 hot.
    pub fn measure(&mut self, temperature: f64) {
        self.thermal.measure(temperature);
    }
}

/// A share from 0 to 1; NaN counts as 0.
fn share_of(share: f64) -> f64 {
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}
