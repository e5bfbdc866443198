//! One tick of the servo: evaluate the newest model, age it, limit the force.
//!
//! A model replaces the one before without a jump (the recovery time of Mark et al. 1996). At its first tick both are
//! evaluated at the same pose; their difference, kept as a correction, shrinks to zero over the recovery time, however
//! many models come meanwhile. Equal models need no correction, so the force follows the hand without lag.
//!
//! | module | holds |
//! | --- | --- |
//! | [`limits`] | bounds of the force |
//! | [`fault`] | faults that latch the force at zero |
//! | [`fast_hand`] | less force to a fast hand |
//! | [`motor_thermal`] | thermal model of the motors, which bounds the force |
//! | [`persistent`] | state that survives the loss of the device |
//! | `active` | a contact model and its age |
//! | `engagement` | begin of a force where the models ask for little |
//! | `guidance` | the guide of the hand, beside the contact models |
//! | `models` | the contact models, and the correction between them |
//! | `orders` | commands of painter and device: switches, strength, heat |
//! | `torque` | torque of the brush about its ferrule |
//! | [`passivity`] | the energy that sampling adds, removed again |
//! | [`oscillation`] | detection of a shaking hand, which makes the force softer |
//! | [`tick`] | input and report of a tick |

mod active;
mod engagement;
pub mod fast_hand;
pub mod fault;
mod guidance;
pub mod limits;
mod models;
pub mod motor_thermal;
mod orders;
pub mod oscillation;
pub mod passivity;
pub mod persistent;
pub mod tick;
mod torque;

use glam::DVec3;

use self::engagement::Engagement;
use self::fast_hand::FastHand;
use self::fault::Fault;
use self::guidance::Guidance;
use self::limits::Limits;
use self::models::Models;
use self::motor_thermal::MotorThermal;
use self::orders::Orders;
use self::oscillation::{Oscillation, Touch};
use self::passivity::Passivity;
use self::persistent::ServoMemory;
use self::tick::{Sender, Tick};
use self::torque::Torque;
use crate::contact::{Contact, ContactForce, HandleState};
use crate::fluid::Fluid;
use crate::guide::Guide;

/// The servo's state.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    limits: Limits,
    orders: Orders,
    models: Models,
    torque: Torque,
    engagement: Engagement,
    /// Time without contact or guide, s.
    idle_s: f64,
    thermal: MotorThermal,
    passivity: Passivity,
    oscillation: Oscillation,
    fast_hand: FastHand,
    guidance: Guidance,
    last: Option<Last>,
    force: DVec3,
    fault: Option<Fault>,
}

/// State at the end of the previous tick.
#[derive(Clone, Copy, Debug)]
struct Last {
    position: DVec3,
    /// Bounded force of models and guide, without its velocity-dependent part, N.
    models: DVec3,
    /// Factor on the models' force.
    share: f64,
    /// Factor on the guide's force.
    guided: f64,
    cap_n: f64,
}

impl Servo {
    /// A servo without a model, switched on at full strength.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self::after(limits, ServoMemory::fresh(limits))
    }

    /// A servo that continues from one that lost its device: a fault stays latched, motors stay warm.
    #[must_use]
    pub fn after(limits: Limits, memory: ServoMemory) -> Self {
        Self {
            limits,
            orders: Orders::default(),
            models: Models::default(),
            torque: Torque::default(),
            engagement: Engagement::NEW,
            idle_s: 0.0,
            thermal: memory.thermal,
            passivity: Passivity::default(),
            oscillation: Oscillation::default(),
            fast_hand: FastHand::default(),
            guidance: Guidance::new(),
            last: None,
            force: DVec3::ZERO,
            fault: memory.fault,
        }
    }

    /// Stores a new model, for the next step.
    pub fn receive(&mut self, contact: Contact, sender: Sender) {
        if sender == Sender::Another {
            self.engage_anew();
        }
        self.models.receive(contact);
    }

    /// Stores a new guide, for the next step.
    pub fn receive_guide(&mut self, guide: Guide, sender: Sender) {
        self.guidance.receive(guide, sender);
    }

    /// Stores a new force of paint; it acts where the head touches.
    pub fn receive_fluid(&mut self, fluid: Fluid) {
        self.models.receive_fluid(fluid, self.limits.fade_s);
    }

    /// Discards models and correction; the force engages anew.
    fn engage_anew(&mut self) {
        self.engagement.wait_anew();
        self.models.discard();
        self.last = None;
        self.passivity.forgive();
    }

    /// Latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// State for the next servo of the device.
    #[must_use]
    pub fn memory(&self) -> ServoMemory {
        let mut thermal = self.thermal;
        thermal.forget_unknown();
        ServoMemory {
            fault: self.fault,
            thermal,
        }
    }

    /// The force on the hand for the next tick, N, `dt` s after the tick before.
    pub fn step(&mut self, handle: &HandleState, dt: f64) -> (DVec3, Tick) {
        let mut tick = Tick::default();
        let cap_n = self.thermal.follow(self.force.length(), &self.limits, dt);
        self.check(handle, dt);
        if self.fault.is_some() {
            return self.nothing(tick);
        }
        tick.late = dt > self.limits.longest_tick_s || dt < 0.0;
        if tick.late {
            self.stand_still(dt);
        }
        let passed_s = dt.max(0.0);
        let dt = passed_s.min(self.limits.longest_tick_s);
        self.observe(handle, dt);
        self.age(dt, passed_s);
        self.models.replace(handle, &self.limits, dt);
        let contact_force = self.models.evaluate(handle, &self.limits);
        tick.contact = contact_force.is_some_and(|force| force.depth_m > 0.0);
        let touch = if tick.contact {
            Touch::Contact
        } else {
            Touch::Air
        };
        self.watch(handle, touch, dt);
        let speed = handle.velocity.length() / self.limits.max_speed_m_s;
        self.fast_hand.follow(speed, touch);
        let shakes = self.guidance.follow(handle, &self.limits, dt, self.force);
        if shakes {
            self.fault = Some(self.fault.unwrap_or(Fault::Oscillation));
        }
        tick.guided = self.guidance.is_alive(&self.limits);
        self.rest(touch, dt);
        tick.resting = self.orders.are_off() || self.idle_s >= self.limits.idle_s;
        if self.fault.is_some() || tick.resting {
            return self.nothing(tick);
        }
        tick.cap_n = cap_n;
        self.hold(handle, contact_force.as_ref(), dt);
        let wanted = self.wanted(handle, contact_force, dt, &mut tick);
        self.give(wanted, dt, &mut tick);
        // The last check: no value that is not finite reaches the motors.
        if !self.force.is_finite() {
            self.fault = Some(Fault::NotANumber);
            return self.nothing(tick);
        }
        let lever = contact_force.map_or(DVec3::ZERO, |contact| contact.lever);
        tick.torque_n_m = self.torque.follow(lever, self.force, &self.limits, dt);
        (self.force, tick)
    }

    /// No force after a tick that was too long, and the ramp starts again.
    fn stand_still(&mut self, dt: f64) {
        self.force = DVec3::ZERO;
        self.torque = Torque::default();
        self.engagement.ramp_anew();
        self.guidance.ramp_anew();
        self.last = None;
        self.passivity.forgive();
        if dt > self.limits.standstill_s {
            // The hand may have moved anywhere meanwhile.
            self.wait();
        }
    }

    /// Moves the force toward the wanted one, N, within the bounds of its magnitude and of its change.
    fn give(&mut self, wanted: DVec3, dt: f64, tick: &mut Tick) {
        let size = wanted.length();
        tick.clamped = size > tick.cap_n;
        let limited = if tick.clamped {
            wanted * (tick.cap_n / size)
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
    }

    /// No force, with the report.
    fn nothing(&mut self, tick: Tick) -> (DVec3, Tick) {
        self.force = DVec3::ZERO;
        self.torque = Torque::default();
        self.models.release();
        self.last = None;
        self.passivity.forgive();
        let fault = self.fault;
        (DVec3::ZERO, Tick { fault, ..tick })
    }

    /// Latches a value that is not finite, and a hand that the device drives.
    fn check(&mut self, handle: &HandleState, dt: f64) {
        let sane = dt.is_finite()
            && handle.position.is_finite()
            && handle.velocity.is_finite()
            && handle.orientation.is_finite()
            && self.thermal.is_known();
        if !sane {
            self.fault = Some(Fault::NotANumber);
        } else if self.force != DVec3::ZERO && handle.velocity.length() > self.limits.max_speed_m_s
        {
            self.fault = Some(self.fault.unwrap_or(Fault::TooFast));
        }
    }

    /// Adds the energy of the step that ends, from the force held over it and the models during it.
    fn observe(&mut self, handle: &HandleState, dt: f64) {
        let Some(last) = self.last else {
            return;
        };
        let mut here = self.guidance.asked(handle, &self.limits) * last.guided;
        let mut is_free = true;
        if let Some(contact_force) = self.models.evaluate(handle, &self.limits) {
            here += (contact_force.conservative + self.models.correction()) * last.share;
            is_free = contact_force.depth_m <= 0.0;
        }
        let here = here.clamp_length_max(last.cap_n);
        let way = handle.position - last.position;
        let models = (last.models + here) * 0.5;
        let damping = self.limits.damping_n_s_m;
        self.passivity.observe(self.force, models, way, damping, dt);
        if is_free && self.force == DVec3::ZERO {
            self.passivity.forgive();
        }
    }

    /// Advances the ramp and the recovery by a tick, and the age of models by the whole time passed.
    fn age(&mut self, dt: f64, passed_s: f64) {
        self.engagement.age(dt);
        self.guidance.age(&self.limits, dt, passed_s);
        if self.models.age(&self.limits, dt, passed_s) {
            // Its force has vanished: a hand that has gone deep meanwhile must not be pushed out when models return.
            self.engagement.wait_anew();
        }
    }

    /// Updates sticking bristles, which slip under a pull; until force begins nothing holds the hand.
    fn hold(&mut self, handle: &HandleState, contact_force: Option<&ContactForce>, dt: f64) {
        let has_begun = self.engagement.has_begun();
        let touch = contact_force.filter(|felt| has_begun && felt.depth_m > 0.0);
        self.models.hold(handle, touch, dt);
    }

    /// Latches the fault of a hand that keeps shaking; without force no device shakes it.
    fn watch(&mut self, handle: &HandleState, touch: Touch, dt: f64) {
        let Some(model) = self.models.active() else {
            return;
        };
        let touch = if self.force == DVec3::ZERO {
            Touch::Air
        } else {
            touch
        };
        let place = handle.position.dot(model.contact.normal());
        if self
            .oscillation
            .watch(place, self.limits.oscillation_m, touch, dt)
        {
            self.fault = Some(self.fault.unwrap_or(Fault::Oscillation));
        }
    }

    /// Counts the time without contact or guide; a touch starts the ramp again.
    fn rest(&mut self, touch: Touch, dt: f64) {
        if touch == Touch::Air && !self.guidance.holds(&self.limits) {
            self.idle_s += dt;
            return;
        }
        if self.idle_s >= self.limits.idle_s {
            self.engagement.ramp_anew();
            self.guidance.ramp_anew();
        }
        self.idle_s = 0.0;
    }

    /// Force requested by models and guide, and the brake.
    fn wanted(
        &mut self,
        handle: &HandleState,
        contact_force: Option<ContactForce>,
        dt: f64,
        tick: &mut Tick,
    ) -> DVec3 {
        let contact = self.contact(contact_force, tick);
        let guiding = self.guidance.give(&self.limits, self.orders.strength());
        if contact.is_none() && guiding.share == 0.0 {
            self.last = None;
            return DVec3::ZERO;
        }
        let (force, conservative, share) = contact.unwrap_or_default();
        self.last = Some(Last {
            position: handle.position,
            models: (conservative + guiding.conservative).clamp_length_max(tick.cap_n),
            share,
            guided: guiding.share,
            cap_n: tick.cap_n,
        });
        let brake = self.passivity.brake(dt);
        tick.braked = brake != DVec3::ZERO;
        force + guiding.force + brake
    }

    /// Force of the models, N, its part that depends on position alone, and the factor applied; `None` until force
    /// begins.
    fn contact(
        &mut self,
        contact_force: Option<ContactForce>,
        tick: &mut Tick,
    ) -> Option<(DVec3, DVec3, f64)> {
        tick.waiting = !self.engagement.has_begun();
        let (Some(model), Some(contact_force)) = (self.models.active(), contact_force) else {
            return None;
        };
        tick.stale = model.overdue_s() > 0.0;
        let softer =
            self.orders.strength() * self.oscillation.softness() * self.fast_hand.softness();
        tick.asked_n_m = contact_force.asked_n_m;
        tick.stiffness_n_m = contact_force.stiffness_n_m * softer;
        // A model past its time to live says nothing about the canvas.
        let correction = self.models.correction();
        let asked_n = if tick.stale {
            f64::NAN
        } else {
            (contact_force.force + correction).length()
        };
        if self.engagement.waits(asked_n, self.limits.engage_n) {
            return None;
        }
        let ramp = self.engagement.ramp(self.limits.engage_s);
        let share = model.left(&self.limits) * ramp * softer;
        Some((
            (contact_force.force + correction) * share,
            (contact_force.conservative + correction) * share,
            share,
        ))
    }
}

#[cfg(test)]
mod tests;
