//! One tick of the servo: evaluate the newest model, age it, limit the force.
//!
//! A model takes the place of the one before without a jump (the recovery time of Mark et al. 1996):
//! at its first tick both are evaluated at the same pose, and their difference, kept as a
//! correction, shrinks to nothing over the recovery time, however many models come meanwhile. As
//! the pose is the same, a model that says the same as the one before corrects nothing: the force
//! follows the hand without lag.

use glam::DVec3;

use crate::contact::{Contact, Held};

/// What a force may be, whatever the models say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest force, N: the least of the device's nominal and the configured one.
    pub max_force_n: f64,
    /// Largest stiffness, N/m.
    pub max_stiffness_n_m: f64,
    /// Fastest change of the force, N/s.
    pub slew_n_s: f64,
    /// Time over which a model past its time to live fades to nothing, s.
    pub fade_s: f64,
    /// Time over which force comes up after a start, a fault or another sender, s.
    pub engage_s: f64,
    /// A tick longer than this has stood still: no force, and engage anew, s.
    pub longest_tick_s: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_force_n: 3.0,
            max_stiffness_n_m: 400.0,
            slew_n_s: 400.0,
            fade_s: 0.075,
            engage_s: 0.5,
            longest_tick_s: 0.005,
        }
    }
}

/// What happened in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each may be so without the others"
)]
pub struct Tick {
    /// A number that was not finite: the servo gives no force until it is re-armed.
    pub fault: bool,
    /// The tick took too long.
    pub late: bool,
    /// The force was cut to its largest size.
    pub clamped: bool,
    /// The model is past its time to live.
    pub stale: bool,
}

/// Who sent a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sender {
    /// Who sent the model before.
    Same,
    /// Another, or the same one started anew: the force engages anew.
    Another,
}

/// The servo's state.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    limits: Limits,
    model: Option<Active>,
    /// Received since the last step.
    arrived: Option<Contact>,
    /// What the force still keeps of the models before, N.
    correction: DVec3,
    /// How fast the correction shrinks, N/s.
    correction_speed: f64,
    engaged_s: f64,
    force: DVec3,
    latched: bool,
}

/// A model and how long ago it arrived.
#[derive(Clone, Copy, Debug)]
struct Active {
    contact: Contact,
    age_s: f64,
}

impl Servo {
    /// A servo without a model.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            model: None,
            arrived: None,
            correction: DVec3::ZERO,
            correction_speed: 0.0,
            engaged_s: 0.0,
            force: DVec3::ZERO,
            latched: false,
        }
    }

    /// A new model has arrived; the next step evaluates it.
    pub fn receive(&mut self, contact: Contact, sender: Sender) {
        if sender == Sender::Another {
            self.engage_anew();
        }
        self.arrived = Some(contact);
    }

    /// Allows force again after a fault; it engages anew.
    pub fn rearm(&mut self) {
        self.latched = false;
        self.engage_anew();
    }

    /// Nothing of what was felt holds any more.
    fn engage_anew(&mut self) {
        self.engaged_s = 0.0;
        self.model = None;
        self.arrived = None;
        self.correction = DVec3::ZERO;
    }

    /// Whether a fault holds the force at zero.
    #[must_use]
    pub fn is_latched(&self) -> bool {
        self.latched
    }

    /// The force on the hand for the next tick, N, `dt` s after the tick before.
    pub fn step(&mut self, held: &Held, dt: f64) -> (DVec3, Tick) {
        let mut tick = Tick::default();
        let sane = dt.is_finite()
            && held.position.is_finite()
            && held.velocity.is_finite()
            && held.orientation.is_finite();
        if !sane {
            self.latched = true;
        }
        if self.latched {
            self.force = DVec3::ZERO;
            tick.fault = true;
            return (self.force, tick);
        }
        if dt > self.limits.longest_tick_s || dt < 0.0 {
            self.force = DVec3::ZERO;
            self.engaged_s = 0.0;
            tick.late = true;
        }
        let dt = dt.clamp(0.0, self.limits.longest_tick_s);
        self.age(dt);
        self.take_in(held, dt);
        let wanted = self.wanted(held, &mut tick);
        let size = wanted.length();
        tick.clamped = size > self.limits.max_force_n;
        let limited = if tick.clamped {
            wanted * (self.limits.max_force_n / size)
        } else {
            wanted
        };
        let change = limited - self.force;
        let most = self.limits.slew_n_s * dt;
        let change = if change.length() > most {
            change.normalize_or_zero() * most
        } else {
            change
        };
        self.force += change;
        // Last of all: whatever went wrong above, no such number reaches the motors.
        if !self.force.is_finite() {
            self.latched = true;
            self.force = DVec3::ZERO;
            tick.fault = true;
        }
        (self.force, tick)
    }

    fn age(&mut self, dt: f64) {
        self.engaged_s += dt;
        if let Some(model) = &mut self.model {
            model.age_s += dt;
        }
        let (size, shrunk) = (self.correction.length(), self.correction_speed * dt);
        if size > shrunk {
            self.correction *= (size - shrunk) / size;
        } else {
            self.correction = DVec3::ZERO;
            self.correction_speed = 0.0;
        }
    }

    /// Evaluates the model that has arrived, if one has, in the place of the one before.
    fn take_in(&mut self, held: &Held, dt: f64) {
        let Some(contact) = self.arrived.take() else {
            return;
        };
        let before = self.model.as_ref().map(|model| self.felt(model, held));
        let arrived = Active { contact, age_s: dt };
        self.model = Some(arrived);
        if let Some(before) = before
            && contact.recovery_s > 0.0
            && before != self.felt(&arrived, held)
        {
            self.correction = before - contact.force(held, self.limits.max_stiffness_n_m);
            // An earlier, larger jump still ends in its own time.
            let speed = self.correction.length() / contact.recovery_s;
            self.correction_speed = self.correction_speed.max(speed);
        }
    }

    /// What a model makes the hand feel, with what is left of those before it.
    fn felt(&self, model: &Active, held: &Held) -> DVec3 {
        let fading = (1.0 - model.overdue_s().max(0.0) / self.limits.fade_s).max(0.0);
        (model.contact.force(held, self.limits.max_stiffness_n_m) + self.correction) * fading
    }

    /// The force that the models ask for.
    fn wanted(&self, held: &Held, tick: &mut Tick) -> DVec3 {
        let Some(model) = &self.model else {
            return DVec3::ZERO;
        };
        tick.stale = model.overdue_s() > 0.0;
        self.felt(model, held) * (self.engaged_s / self.limits.engage_s).min(1.0)
    }
}

impl Active {
    /// Time since the end of its time to live, s; negative before.
    fn overdue_s(&self) -> f64 {
        self.age_s - self.contact.time_to_live_s
    }
}

#[cfg(test)]
mod tests;
