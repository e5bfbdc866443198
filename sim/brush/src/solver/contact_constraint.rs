//! Contact of a joint with a half space: open, sticking or sliding.

use glam::DVec3;

use super::Settings;
use crate::energy::friction::{Anisotropy, Friction, friction};
use crate::spine::{Spine, SpineShape};

/// Slip, in multiples of the rounding of friction, above which a sticking contact breaks loose: its force is then
/// within .5 % of its bound.
const SLIP_EPSILONS: f64 = 10.0;
/// Slip, in multiples of the rounding of friction, below which a sliding contact sticks.
const STUCK: f64 = 3.0;

/// Relative change of the normal force from which friction is recomputed.
const LAG: f64 = 2e-3;

/// A half-space that joints stay in: n·x ≥ offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Unit normal, pointing out of the obstacle.
    pub normal: DVec3,
    /// Its distance from the origin along the normal, m.
    pub offset_m: f64,
}

impl HalfSpace {
    /// The surface z = 0.
    pub const SURFACE: Self = Self {
        normal: DVec3::Z,
        offset_m: 0.0,
    };

    /// Distance of a point, negative within, m.
    #[must_use]
    pub fn gap(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset_m
    }

    fn along(&self, v: DVec3) -> DVec3 {
        v - self.normal * self.normal.dot(v)
    }
}

/// The constraint that keeps the far end of a joint in a half space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactConstraint {
    /// The joint.
    pub joint: usize,
    /// The half space.
    pub half_space: HalfSpace,
    /// Normal force, N: the multiplier of the constraint, 0 in the air.
    pub force_n: f64,
    /// Point where it touched, or where it began to stick; `None` if it was in the air.
    pub anchor: Option<DVec3>,
    /// True if the contact sticks: the coefficient of friction is then the static one.
    pub sticks: bool,
    /// Preferred direction d_p of Baxter 2004, eq. 3.14.
    preferred: DVec3,
}

impl ContactConstraint {
    /// A joint that does not touch.
    #[must_use]
    pub fn new(joint: usize, half_space: HalfSpace) -> Self {
        Self {
            joint,
            half_space,
            force_n: 0.0,
            anchor: None,
            sticks: false,
            preferred: DVec3::ZERO,
        }
    }

    /// One for each joint of a spine against the surface z = 0.
    #[must_use]
    pub fn on_surface(joints: usize) -> Vec<Self> {
        (0..joints)
            .map(|joint| Self::new(joint, HalfSpace::SURFACE))
            .collect()
    }

    /// True if it touches.
    #[must_use]
    pub fn touches(&self) -> bool {
        self.force_n > 0.0
    }

    /// Releases the contact.
    pub fn clear(&mut self) {
        *self = Self::new(self.joint, self.half_space);
    }

    /// Updates the preferred direction of its segment: the unit projection onto the half space's plane of the vector
    /// from the end of the segment to its root.
    pub fn update_preferred(&mut self, spine: &Spine, shape: &SpineShape) {
        let back = -shape.directions[self.joint];
        let lies = self.half_space.along(back);
        let short = 1e-6 * spine.lengths_m[self.joint];
        self.preferred = if lies.length() > short {
            lies.normalize()
        } else {
            DVec3::ZERO
        };
    }

    /// The friction of a joint that is at `p`.
    pub(super) fn friction(&self, p: DVec3, settings: &Settings) -> Option<Friction> {
        let slip = self.half_space.along(p - self.anchor?);
        let coefficient = if self.sticks {
            settings.friction_static.max(settings.friction)
        } else {
            settings.friction
        };
        let anisotropy = Anisotropy {
            preferred: self.preferred,
            ..settings.anisotropy
        };
        let weight = coefficient * self.force_n;
        Some(friction(
            weight,
            slip,
            self.half_space.normal,
            settings.epsilon_m,
            &anisotropy,
        ))
    }

    /// Sets the normal force of a joint at `p` to that of a solve, and frees the joint where it has broken loose;
    /// true if that changes its friction. Forces below `least_n` count as none.
    ///
    /// A lifted contact keeps its anchor until the pose is settled, since without friction it may touch again.
    pub(super) fn update(
        &mut self,
        force_n: f64,
        p: DVec3,
        least_n: f64,
        settings: &Settings,
    ) -> bool {
        let Some(anchor) = self.anchor else {
            return false;
        };
        let loose = self.half_space.along(p - anchor).length() > SLIP_EPSILONS * settings.epsilon_m;
        let breaks = self.sticks && loose && settings.friction_static > settings.friction;
        self.sticks &= !loose;
        let lags = (force_n - self.force_n).abs() > LAG * force_n.max(least_n);
        self.force_n = force_n;
        breaks || lags
    }

    /// Stores the result of a solve that put the joint to `p`.
    pub(super) fn commit(&mut self, force_n: f64, p: DVec3, settings: &Settings) {
        if force_n <= 0.0 {
            self.clear();
            return;
        }
        self.force_n = force_n;
        match self.anchor {
            Some(_) if self.sticks => {}
            Some(anchor) => {
                let slip = self.half_space.along(p - anchor).length();
                self.sticks = slip < STUCK * settings.epsilon_m;
                self.anchor = Some(p);
            }
            None => {
                self.sticks = true;
                self.anchor = Some(p);
            }
        }
    }
}
