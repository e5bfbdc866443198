//! Energy ledger of a hand: its gain beyond the work of the newest model's own force along the true path without
//! sampling, which vanishes along a closed path.
//!
//! A model that takes over is spread over the recovery time, as a plane that moves is. A servo reports its softening; a
//! wall that hardens again under a hand stores energy without a source. Energy stored in a film of paint and the
//! device's mass came from the hand and may return.

use glam::DVec3;

use maulstick_haptics::contact::{Contact, HandleState};
use maulstick_haptics::plant::Plant;

use super::{DT, GuideLine, HEAD_M, MAX_STIFFNESS_N_M, RECOVERY_S};

/// Length of a path out along the normal that ends beyond all contact, m.
const OUT_M: f64 = 1.2e-2;

/// The ferrule over the tip of an upright brush, m.
const FERRULE: DVec3 = DVec3::new(0.0, 0.0, HEAD_M);

/// The books of one hand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ledger {
    contact: Contact,
    correction: DVec3,
    /// Rate at which the correction shrinks, N/s.
    speed: f64,
    /// Share of the stiffness that the servo gives, and whether the head touched at the last tick.
    softness: f64,
    touched: bool,
    guide: Option<GuideLine>,
    net_j: f64,
    least_j: f64,
    /// Greatest energy given without a source, J.
    pub(super) most_j: f64,
    /// Greatest energy given from some time on to the hand, the device's mass and the film, J.
    pub(super) rise_j: f64,
}

impl Ledger {
    /// The books of a hand in the air, without its guide.
    pub(super) fn new(contact: Contact, guide: Option<GuideLine>) -> Self {
        Self {
            contact,
            correction: DVec3::ZERO,
            speed: 0.0,
            softness: 1.0,
            touched: false,
            guide,
            net_j: 0.0,
            least_j: 0.0,
            most_j: 0.0,
            rise_j: 0.0,
        }
    }

    /// The newest model's unit normal.
    pub(super) fn normal(&self) -> DVec3 {
        self.contact.normal()
    }

    /// Depth of the tip of a ferrule at a place, m.
    pub(super) fn depth(&self, position: DVec3) -> f64 {
        let handle = HandleState::upright(position);
        self.contact.evaluate(&handle, MAX_STIFFNESS_N_M).depth_m
    }

    /// Force of the newest model on a ferrule at a place, N.
    pub(super) fn force(&self, position: DVec3) -> DVec3 {
        let handle = HandleState::upright(position);
        let felt = self.contact.evaluate(&handle, MAX_STIFFNESS_N_M);
        felt.conservative
    }

    /// A tick begins.
    pub(super) fn age(&mut self) {
        let (size, shrunk) = (self.correction.length(), self.speed * DT);
        if size > shrunk {
            self.correction *= (size - shrunk) / size;
        } else {
            (self.correction, self.speed) = (DVec3::ZERO, 0.0);
        }
    }

    /// A model takes over, with the ferrule at a place.
    pub(super) fn change(&mut self, contact: Contact, position: DVec3) {
        let before = self.force(position) + self.correction;
        self.contact = contact;
        self.correction = before - self.force(position);
        self.speed = self.speed.max(self.correction.length() / RECOVERY_S);
    }

    /// Work of the model on a short straight path, J, by Simpson's rule.
    fn work(&self, from: DVec3, to: DVec3) -> f64 {
        let middle = self.force((from + to) * 0.5);
        let mean = (self.force(from) + middle * 4.0 + self.force(to)) / 6.0;
        (mean + self.correction).dot(to - from) * self.softness
    }

    /// Energy stored in the model at a place without softening, J: its work on a path out along the normal, by
    /// Simpson's rule.
    fn stored(&self, position: DVec3) -> f64 {
        const STEPS: u32 = 64;
        let step = self.contact.normal() * (OUT_M / f64::from(STEPS));
        let along = |i: f64| self.force(position + step * i).dot(step);
        let piece = |i: u32| {
            let i = f64::from(i);
            (along(i) + 4.0 * along(i + 0.5) + along(i + 1.0)) / 6.0
        };
        (0..STEPS).map(piece).sum()
    }

    /// Reports the servo's stiffness, N/m, for a handle as read, with the ferrule truly at `position`.
    pub(super) fn soften(&mut self, handle: &HandleState, given_n_m: f64, position: DVec3) {
        let felt = self.contact.evaluate(handle, MAX_STIFFNESS_N_M);
        let touches = felt.depth_m > 0.0 && felt.stiffness_n_m > 0.0;
        let before = self.softness;
        if touches {
            self.softness = given_n_m / felt.stiffness_n_m;
        }
        let was_in_contact = std::mem::replace(&mut self.touched, touches);
        if touches && was_in_contact && self.softness != before {
            self.net_j += (self.softness - before) * self.stored(position);
        }
    }

    /// Ends a tick that moved the hand from `before` to `after`; `kept_j` is the energy of a film then, J.
    pub(super) fn book(&mut self, before: &Plant, after: &Plant, kept_j: f64) {
        let (from, to) = (before.true_position(), after.true_position());
        let guided_j = self.guide.map_or(0.0, |guide| {
            guide.stored(from - FERRULE) - guide.stored(to - FERRULE)
        });
        self.net_j += after.given_j() - before.given_j() - self.work(from, to) - guided_j;
        self.most_j = self.most_j.max(self.net_j + kept_j);
        // The energy of the device's mass is not given to the hand yet.
        let with_motion_j = self.net_j + kept_j + after.kinetic_j();
        self.least_j = self.least_j.min(with_motion_j);
        self.rise_j = self.rise_j.max(with_motion_j - self.least_j);
    }
}
