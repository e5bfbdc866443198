//! Guidance of the hand: the newest guide, its ageing, and the same guards as for a contact's force.
//!
//! A guide acts beside the contact models, and each engages separately. Its force follows the hand as fast as its
//! stiffness allows. Any faster change (a new piece of path, a change of the nearest point, another strength) becomes a
//! correction, which shrinks to zero without a knock.

use glam::DVec3;

use super::engagement::Engagement;
use super::fast_hand::FastHand;
use super::limits::Limits;
use super::oscillation::{Oscillation, Touch};
use super::tick::Sender;
use crate::contact::HandleState;
use crate::guide::{Foot, Guide, GuideBounds, Pull};

/// Time in which a correction as large as the largest guiding force shrinks to zero, s.
const RECOVERY_S: f64 = 0.2;
/// Force below which a guide does not hold the hand, as a share of the engagement's bound.
const LITTLE: f64 = 0.1;

/// The guide of a servo.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guidance {
    share: f64,
    active: Option<Active>,
    arrived: Option<Guide>,
    /// Part of the previous force that still fades, N.
    correction: DVec3,
    engagement: Engagement,
    oscillation: Oscillation,
    fast_hand: FastHand,
}

/// A guide, the hand's nearest point on it, and its age.
#[derive(Clone, Copy, Debug)]
struct Active {
    guide: Guide,
    foot: Foot,
    age_s: f64,
    /// Force that it requested at the last tick, and the hand's place then.
    asked: Pull,
    position: DVec3,
}

/// Force of the guidance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Guiding {
    /// Whole force, N.
    pub(super) force: DVec3,
    /// Part that depends on position alone, N.
    pub(super) conservative: DVec3,
    /// Factor on the guide's force.
    pub(super) share: f64,
}

impl Active {
    /// Tracks the hand, with a share of the guide's force.
    fn follow(&mut self, handle: &HandleState, bounds: &GuideBounds, share: f64) {
        self.foot = self.guide.follow(self.foot, handle);
        let pull = self.guide.pull(self.foot, handle, bounds);
        self.asked = Pull {
            conservative: pull.conservative * share,
            damping: pull.damping * share,
            ..pull
        };
        self.position = handle.position;
    }
}

impl Guidance {
    pub(super) fn new() -> Self {
        Self {
            share: 1.0,
            active: None,
            arrived: None,
            correction: DVec3::ZERO,
            engagement: Engagement::NEW,
            oscillation: Oscillation::default(),
            fast_hand: FastHand::default(),
        }
    }

    pub(super) fn receive(&mut self, guide: Guide, sender: Sender) {
        if sender == Sender::Another {
            self.forget();
        }
        self.arrived = Some(guide);
    }

    /// Sets the share of the guides' force that is applied.
    pub(super) fn set_share(&mut self, share: f64) {
        self.share = share;
    }

    /// Discards guide and correction; the force engages anew.
    pub(super) fn forget(&mut self) {
        let share = self.share;
        *self = Self {
            share,
            ..Self::new()
        };
    }

    /// Makes the force engage anew.
    pub(super) fn engage_anew(&mut self) {
        self.engagement.wait_anew();
    }

    /// Restarts the ramp.
    pub(super) fn ramp_anew(&mut self) {
        self.engagement.ramp_anew();
    }

    /// True while a guide is alive.
    pub(super) fn is_alive(&self, limits: &Limits) -> bool {
        self.fading(limits) > 0.0
    }

    /// Share of the guide's force past its time to live; 0 without a guide.
    fn fading(&self, limits: &Limits) -> f64 {
        self.active.map_or(0.0, |active| {
            let overdue_s = (active.age_s - active.guide.time_to_live_s).max(0.0);
            (1.0 - overdue_s / limits.fade_s).max(0.0)
        })
    }

    /// Force that the last tick's guide requests at the hand's current place, N, before its factor.
    pub(super) fn asked(&self, handle: &HandleState, limits: &Limits) -> DVec3 {
        let Some(active) = &self.active else {
            return DVec3::ZERO;
        };
        let foot = active.guide.follow(active.foot, handle);
        let pull = active.guide.pull(foot, handle, &limits.guide_bounds());
        pull.conservative * self.share + self.correction
    }

    /// Advances the ramp and the correction by a tick, and the guide's age by the whole time passed.
    pub(super) fn age(&mut self, limits: &Limits, dt: f64, passed_s: f64) {
        self.engagement.age(dt);
        if let Some(active) = &mut self.active {
            active.age_s += passed_s;
        }
        if !self.is_alive(limits) {
            self.active = None;
            self.correction = DVec3::ZERO;
            self.engagement.wait_anew();
        }
        let (size, shrunk) = (
            self.correction.length(),
            limits.guide.force_n * (dt / RECOVERY_S),
        );
        self.correction = if size > shrunk {
            self.correction * ((size - shrunk) / size)
        } else {
            DVec3::ZERO
        };
    }

    /// Tracks the hand along the newest guide; `given` is the servo's force, N. True if the hand shakes at the softest
    /// guide.
    pub(super) fn follow(
        &mut self,
        handle: &HandleState,
        limits: &Limits,
        dt: f64,
        given: DVec3,
    ) -> bool {
        let bounds = limits.guide_bounds();
        let mut change = DVec3::ZERO;
        if let Some(active) = &mut self.active {
            let before = *active;
            active.follow(handle, &bounds, self.share);
            let way = (active.position - before.position).length();
            change = active.asked.conservative - before.asked.conservative;
            change -= change.clamp_length_max(bounds.stiffness_n_m * way);
        }
        if let Some(guide) = self.arrived.take() {
            let foot = match &self.active {
                Some(active) => guide.nearest(active.guide.point(active.foot)),
                None => guide.first(handle),
            };
            let mut newest = Active {
                guide,
                foot,
                age_s: dt,
                asked: Pull::default(),
                position: handle.position,
            };
            newest.follow(handle, &bounds, self.share);
            if let Some(before) = &self.active {
                change += newest.asked.conservative - before.asked.conservative;
            }
            self.active = Some(newest);
        }
        let Some(Active { asked, .. }) = self.active else {
            return false;
        };
        // From the largest force to the largest opposite one.
        self.correction = (self.correction - change).clamp_length_max(2.0 * bounds.force_n);
        let touch = if self.engagement.has_begun() && self.holds(limits) {
            Touch::Contact
        } else {
            Touch::Air
        };
        // A released hand gets the guide's force again from the path on, like that of a wall.
        let speed = handle.velocity.length() / limits.max_speed_m_s;
        self.fast_hand.follow(speed, touch);
        // Without force no device shakes it.
        let touch = if given == DVec3::ZERO {
            Touch::Air
        } else {
            touch
        };
        self.oscillation
            .watch(asked.left_m, limits.oscillation_m, touch, dt)
    }

    /// True while the guide requests a noticeable force.
    pub(super) fn holds(&self, limits: &Limits) -> bool {
        let is_held =
            |active: Active| active.asked.conservative.length() > LITTLE * limits.engage_n;
        self.active.is_some_and(is_held)
    }

    /// The force of the guidance at `strength`, the share of all forces.
    pub(super) fn give(&mut self, limits: &Limits, strength: f64) -> Guiding {
        let fading = self.fading(limits);
        let Some(active) = &self.active else {
            return Guiding::default();
        };
        let asked = active.asked.conservative + self.correction;
        let asked_n = if active.age_s > active.guide.time_to_live_s {
            f64::NAN
        } else {
            asked.length()
        };
        if self.engagement.waits(asked_n, limits.engage_n) {
            self.correction = DVec3::ZERO;
            return Guiding::default();
        }
        let most = limits.guide_bounds().force_n;
        let ramp = self.engagement.ramp(limits.engage_s);
        let softer = strength * self.oscillation.softness() * self.fast_hand.softness();
        let share = fading * ramp * softer;
        Guiding {
            force: ((asked + active.asked.damping) * share).clamp_length_max(most),
            conservative: asked.clamp_length_max(most) * share,
            share,
        }
    }
}
