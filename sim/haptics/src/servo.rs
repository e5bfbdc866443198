//! One tick of the servo: evaluate the newest model, age it, limit the force.
//!
//! A model takes the place of the one before without a jump (the recovery time of Mark et al. 1996):
//! at its first tick both are evaluated at the same pose, and their difference, kept as a
//! correction, shrinks to nothing over the recovery time, however many models come meanwhile. As
//! the pose is the same, a model that says the same as the one before corrects nothing: the force
//! follows the hand without lag.
//!
//! | module | holds |
//! | --- | --- |
//! | [`limits`] | bounds of the force |
//! | [`fault`] | faults that latch the force at zero |
//! | [`fast_hand`] | less force to a fast hand |
//! | [`motor_thermal`] | thermal model of the motors, which bounds the force |
//! | [`persistent`] | state that survives the loss of the device |
//! | `active` | a contact model and its age |
//! | `engagement` | force that begins where little is asked for |
//! | `guidance` | the guide of the hand, beside the contact models |
//! | `orders` | what painter and device say: switches, strength, heat |
//! | `torque` | torque of the brush about its ferrule |
//! | [`passivity`] | the energy that sampling gives, taken back |
//! | [`oscillation`] | detection of a shaking hand, which makes the force softer |
//! | [`tick`] | input and report of a tick |

mod active;
mod engagement;
pub mod fast_hand;
pub mod fault;
mod guidance;
pub mod limits;
pub mod motor_thermal;
mod orders;
pub mod oscillation;
pub mod passivity;
pub mod persistent;
pub mod tick;
mod torque;

use glam::DVec3;

use self::active::Active;
use self::engagement::Engagement;
use self::fast_hand::FastHand;
use self::fault::Fault;
use self::guidance::Guidance;
use self::limits::Limits;
use self::motor_thermal::MotorThermal;
use self::oscillation::{Oscillation, Touch};
use self::passivity::Passivity;
use self::persistent::ServoMemory;
use self::tick::{Sender, Switch, Tick};
use self::torque::Torque;
use crate::contact::{Contact, ContactForce, HandleState};
use crate::fluid::{Fluid, FluidStage};
use crate::friction::{Stiction, ramp};
use crate::guide::Guide;

/// The servo's state.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    limits: Limits,
    switch: Switch,
    permitted: Switch,
    strength: f64,
    model: Option<Active>,
    /// Received since the last step.
    arrived: Option<Contact>,
    fluid: FluidStage,
    stiction: Stiction,
    torque: Torque,
    /// What the force still keeps of the models before, N.
    correction: DVec3,
    /// How fast the correction shrinks, N/s.
    correction_speed: f64,
    engagement: Engagement,
    engaged_s: f64,
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

/// The end of the tick before.
#[derive(Clone, Copy, Debug)]
struct Last {
    position: DVec3,
    /// Force that models and guide asked for, with all its bounds, without the part that depends on velocity, N.
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

    /// A servo in the place of one that has lost its device: a fault stays latched, motors warm.
    #[must_use]
    pub fn after(limits: Limits, memory: ServoMemory) -> Self {
        Self {
            limits,
            switch: Switch::On,
            permitted: Switch::On,
            strength: 1.0,
            model: None,
            arrived: None,
            fluid: FluidStage::default(),
            stiction: Stiction::default(),
            torque: Torque::default(),
            correction: DVec3::ZERO,
            correction_speed: 0.0,
            engagement: Engagement::ANEW,
            engaged_s: 0.0,
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

    /// A new model has arrived; the next step evaluates it.
    pub fn receive(&mut self, contact: Contact, sender: Sender) {
        if sender == Sender::Another {
            self.engage_anew();
        }
        self.arrived = Some(contact);
    }

    /// A new guide has arrived; the next step evaluates it.
    pub fn receive_guide(&mut self, guide: Guide, sender: Sender) {
        self.guidance.receive(guide, sender);
    }

    /// A new force of paint has arrived; it acts where the head touches.
    pub fn receive_fluid(&mut self, fluid: Fluid) {
        self.fluid.receive(fluid, self.limits.fade_s);
    }

    /// Discards models and correction; the force engages anew.
    fn engage_anew(&mut self) {
        self.engagement = Engagement::ANEW;
        self.model = None;
        self.arrived = None;
        self.fluid = FluidStage::default();
        self.stiction = Stiction::default();
        self.correction = DVec3::ZERO;
        self.last = None;
        self.passivity.forgive();
    }

    /// Latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// State for the next servo over the device.
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
        if dt > self.limits.longest_tick_s || dt < 0.0 {
            self.force = DVec3::ZERO;
            self.torque = Torque::default();
            self.engaged_s = 0.0;
            self.guidance.ramp_anew();
            self.last = None;
            self.passivity.forgive();
            tick.late = true;
            if dt > self.limits.standstill_s {
                // The hand may have gone anywhere meanwhile.
                self.wait();
            }
        }
        let passed_s = dt.max(0.0);
        let dt = passed_s.min(self.limits.longest_tick_s);
        self.observe(handle, dt);
        self.age(dt, passed_s);
        self.take_in(handle, dt);
        let contact_force = self.evaluate_newest(handle);
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
        let off = [self.switch, self.permitted].contains(&Switch::Off);
        tick.resting = off || self.idle_s >= self.limits.idle_s;
        if self.fault.is_some() || tick.resting {
            return self.nothing(tick);
        }
        tick.cap_n = cap_n;
        self.hold(handle, contact_force.as_ref(), dt);
        let wanted = self.wanted(handle, contact_force, dt, &mut tick);
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
        // Last of all: whatever went wrong above, no such number reaches the motors.
        if !self.force.is_finite() {
            self.fault = Some(Fault::NotANumber);
            return self.nothing(tick);
        }
        let lever = contact_force.map_or(DVec3::ZERO, |contact| contact.lever);
        tick.torque_n_m = self.torque.follow(lever, self.force, &self.limits, dt);
        (self.force, tick)
    }

    /// No force, and why.
    fn nothing(&mut self, tick: Tick) -> (DVec3, Tick) {
        self.force = DVec3::ZERO;
        self.torque = Torque::default();
        self.stiction = Stiction::default();
        self.last = None;
        self.passivity.forgive();
        let fault = self.fault;
        (DVec3::ZERO, Tick { fault, ..tick })
    }

    /// Latches what is no number, and a hand that the device drives.
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

    /// Sums the energy of the step that ends, by the force that was held over it and the models as
    /// they were in it.
    fn observe(&mut self, handle: &HandleState, dt: f64) {
        let Some(last) = self.last else {
            return;
        };
        let mut here = self.guidance.asked(handle, &self.limits) * last.guided;
        let mut is_free = true;
        if let Some(contact_force) = self.evaluate_newest(handle) {
            here += (contact_force.conservative + self.correction) * last.share;
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

    /// The ramp and the recovery continue by a tick, and models age by all the time that has passed.
    fn age(&mut self, dt: f64, passed_s: f64) {
        self.engaged_s += dt;
        self.guidance.age(&self.limits, dt, passed_s);
        self.fluid.age(passed_s);
        if let Some(model) = &mut self.model {
            model.age_s += passed_s;
        }
        if self
            .model
            .is_some_and(|model| model.left(&self.limits) <= 0.0)
        {
            // Nothing of it is felt any more: a hand that has gone deep meanwhile is not to be pushed out as
            // models come again.
            self.engagement = Engagement::ANEW;
            self.correction = DVec3::ZERO;
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
    fn take_in(&mut self, handle: &HandleState, dt: f64) {
        let Some(contact) = self.arrived.take() else {
            return;
        };
        let has_force = |model: &&Active| model.left(&self.limits) > 0.0;
        let most = self.limits.max_stiffness_n_m;
        let force = |contact: &Contact| {
            let felt = contact.evaluate_stuck(handle, &self.stiction, most);
            felt.force
        };
        let before = self
            .model
            .as_ref()
            .filter(has_force)
            .map(|model| (force(&model.contact) + self.correction) * model.left(&self.limits));
        let now = force(&contact);
        self.model = Some(Active { contact, age_s: dt });
        if let Some(before) = before
            && contact.recovery_s > 0.0
            && before != now + self.correction
        {
            self.correction = before - now;
            // An earlier, larger jump still ends in its own time.
            let speed = self.correction.length() / contact.recovery_s;
            self.correction_speed = self.correction_speed.max(speed);
        }
    }

    /// Force of the newest model and of the paint. That of paint is not conservative, so the observer
    /// sees all its work.
    fn evaluate_newest(&self, handle: &HandleState) -> Option<ContactForce> {
        let model = self.model.as_ref()?;
        let most = self.limits.max_stiffness_n_m;
        let mut felt = model.contact.evaluate_stuck(handle, &self.stiction, most);
        let fluid = self.fluid.force(handle.velocity, self.limits.fade_s);
        felt.force += fluid * ramp(felt.depth_m);
        Some(felt)
    }

    /// Bristles that touch stick, and give way to a hand that pulls; until force begins nothing holds it.
    fn hold(&mut self, handle: &HandleState, contact_force: Option<&ContactForce>, dt: f64) {
        let begun = self.engagement == Engagement::Begun;
        let touching = contact_force.filter(|felt| begun && felt.depth_m > 0.0);
        let grip = touching.map(|felt| &felt.grip);
        self.stiction.follow(handle.position, grip, dt);
    }

    /// Latches the fault of a hand that keeps shaking; without force no device shakes it.
    fn watch(&mut self, handle: &HandleState, touch: Touch, dt: f64) {
        let Some(model) = &self.model else {
            return;
        };
        let touch = match self.force == DVec3::ZERO {
            true => Touch::Air,
            false => touch,
        };
        let place = handle.position.dot(model.contact.normal());
        if self
            .oscillation
            .watch(place, self.limits.oscillation_m, touch, dt)
        {
            self.fault = Some(self.fault.unwrap_or(Fault::Oscillation));
        }
    }

    /// Counts the time without contact or guide; a touch brings the force up anew.
    fn rest(&mut self, touch: Touch, dt: f64) {
        if touch == Touch::Air && !self.guidance.holds(&self.limits) {
            self.idle_s += dt;
            return;
        }
        if self.idle_s >= self.limits.idle_s {
            self.engaged_s = 0.0;
            self.guidance.ramp_anew();
        }
        self.idle_s = 0.0;
    }

    /// The force that models and guide ask for, and the brake.
    fn wanted(
        &mut self,
        handle: &HandleState,
        contact_force: Option<ContactForce>,
        dt: f64,
        tick: &mut Tick,
    ) -> DVec3 {
        let contact = self.contact(contact_force, tick);
        let guiding = self.guidance.give(&self.limits, self.strength);
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

    /// Force of the models, N, the part of it that depends on position alone, and what they were multiplied by; `None` until
    /// it begins.
    fn contact(
        &mut self,
        contact_force: Option<ContactForce>,
        tick: &mut Tick,
    ) -> Option<(DVec3, DVec3, f64)> {
        tick.waiting = self.engagement != Engagement::Begun;
        let (Some(model), Some(contact_force)) = (&self.model, contact_force) else {
            return None;
        };
        tick.stale = model.overdue_s() > 0.0;
        let softer = self.strength * self.oscillation.softness() * self.fast_hand.softness();
        tick.asked_n_m = contact_force.asked_n_m;
        tick.stiffness_n_m = contact_force.stiffness_n_m * softer;
        // A model that is past its time says nothing of the canvas.
        let asked_n = match tick.stale {
            true => f64::NAN,
            false => (contact_force.force + self.correction).length(),
        };
        if self.engagement.waits(asked_n, self.limits.engage_n) {
            self.engaged_s = 0.0;
            return None;
        }
        let ramp = (self.engaged_s / self.limits.engage_s).min(1.0);
        let share = model.left(&self.limits) * ramp * softer;
        Some((
            (contact_force.force + self.correction) * share,
            (contact_force.conservative + self.correction) * share,
            share,
        ))
    }
}

#[cfg(test)]
mod tests;
