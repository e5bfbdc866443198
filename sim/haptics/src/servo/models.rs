//! Contact models of a servo: the newest one, the paint, sticking bristles, and the correction that makes a new model
//! continuous.

use glam::DVec3;

use super::active::Active;
use super::limits::Limits;
use crate::contact::{Contact, ContactForce, HandleState};
use crate::fluid::{Fluid, FluidStage};
use crate::friction::{Stiction, ramp};

/// Models of the force.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Models {
    active: Option<Active>,
    /// Model received since the last step.
    arrived: Option<Contact>,
    fluid: FluidStage,
    stiction: Stiction,
    /// Remaining correction of the force from earlier models, N.
    correction: DVec3,
    /// Speed at which the correction shrinks, N/s.
    correction_speed: f64,
}

impl Models {
    /// Stores a new model.
    pub(super) fn receive(&mut self, contact: Contact) {
        self.arrived = Some(contact);
    }

    /// Stores a new force of paint.
    pub(super) fn receive_fluid(&mut self, fluid: Fluid, fade_s: f64) {
        self.fluid.receive(fluid, fade_s);
    }

    /// Discards all of them; a later jump still ends in the time of an earlier, larger one.
    pub(super) fn discard(&mut self) {
        *self = Self {
            correction_speed: self.correction_speed,
            ..Self::default()
        };
    }

    /// Releases the sticking bristles.
    pub(super) fn release(&mut self) {
        self.stiction = Stiction::default();
    }

    /// Model in use.
    pub(super) fn active(&self) -> Option<&Active> {
        self.active.as_ref()
    }

    /// Remaining correction of the force from earlier models, N.
    pub(super) fn correction(&self) -> DVec3 {
        self.correction
    }

    /// Shrinks the correction by a tick, and ages models by the whole time passed; true once the model's force has
    /// vanished.
    pub(super) fn age(&mut self, limits: &Limits, dt: f64, passed_s: f64) -> bool {
        self.fluid.age(passed_s);
        if let Some(model) = &mut self.active {
            model.age_s += passed_s;
        }
        let is_over = self.active.is_some_and(|model| model.left(limits) <= 0.0);
        if is_over {
            self.correction = DVec3::ZERO;
        }
        let (size, shrunk) = (self.correction.length(), self.correction_speed * dt);
        if size > shrunk {
            self.correction *= (size - shrunk) / size;
        } else {
            self.correction = DVec3::ZERO;
            self.correction_speed = 0.0;
        }
        is_over
    }

    /// Replaces the model by one that has arrived.
    pub(super) fn replace(&mut self, handle: &HandleState, limits: &Limits, dt: f64) {
        let Some(contact) = self.arrived.take() else {
            return;
        };
        let has_force = |model: &&Active| model.left(limits) > 0.0;
        let most = limits.max_stiffness_n_m;
        let force = |contact: &Contact| {
            let felt = contact.evaluate_stuck(handle, &self.stiction, most);
            felt.force
        };
        let before = self
            .active
            .as_ref()
            .filter(has_force)
            .map(|model| (force(&model.contact) + self.correction) * model.left(limits));
        let now = force(&contact);
        self.active = Some(Active { contact, age_s: dt });
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

    /// Force of the newest model and the paint. Paint is not conservative, so the observer counts all its work.
    pub(super) fn evaluate(&self, handle: &HandleState, limits: &Limits) -> Option<ContactForce> {
        let model = self.active.as_ref()?;
        let most = limits.max_stiffness_n_m;
        let mut felt = model.contact.evaluate_stuck(handle, &self.stiction, most);
        let fluid = self.fluid.force(handle.velocity, limits.fade_s);
        felt.force += fluid * ramp(felt.depth_m);
        Some(felt)
    }

    /// Updates sticking bristles, which slip under a pull; without a touch nothing holds the hand.
    pub(super) fn hold(&mut self, handle: &HandleState, touch: Option<&ContactForce>, dt: f64) {
        let grip = touch.map(|felt| &felt.grip);
        self.stiction.follow(handle.position, grip, dt);
    }
}
