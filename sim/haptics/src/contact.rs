//! The force of one contact model (Baxter 2004, § 8.7.2), evaluated beside the device.

use glam::{DQuat, DVec3};
use maulstick_types::haptics::ContactModel;

use crate::force_law::{Law, Normal, Penetration};
use crate::friction::{Grip, STUCK_SHARE, Stiction, drag, friction, ramp};
use crate::grain::Texture;
use crate::relief::{Height, Relief, light};

/// State of the handle in the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandleState {
    /// Position of the ferrule, desk frame, m.
    pub position: DVec3,
    /// Brush frame to desk frame.
    pub orientation: DQuat,
    /// Velocity of the ferrule, m/s.
    pub velocity: DVec3,
}

impl HandleState {
    /// An upright brush at rest whose ferrule is at `position`, m.
    #[must_use]
    pub fn upright(position: DVec3) -> Self {
        Self {
            position,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        }
    }
}

/// A contact model in the form that the servo evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    point: DVec3,
    normal: DVec3,
    friction: f64,
    /// Friction at rest, which bounds the tangential part of a local force.
    sticking: f64,
    viscous: f64,
    grain: Texture,
    relief: Option<Relief>,
    law: Law,
    head_length: f64,
    /// Age after which its force fades, s.
    pub time_to_live_s: f64,
    /// Time over which it replaces the model before, s.
    pub recovery_s: f64,
}

/// Contact force on the handle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Whole force on the hand, N.
    pub force: DVec3,
    /// Part of the force that depends on position alone, N: without drag, and without friction except the pull of
    /// sticking bristles.
    pub conservative: DVec3,
    /// Depth of the undeformed point below the surface, m; negative above it.
    pub depth_m: f64,
    /// Hold of the bristles on the surface.
    pub grip: Grip,
    /// Lever of the force: from the ferrule to the undeformed point, m, scaled up with the depth as friction is.
    pub lever: DVec3,
    /// Stiffness along the normal requested by the model, N/m.
    pub asked_n_m: f64,
    /// Stiffness along the normal after its bound, N/m.
    pub stiffness_n_m: f64,
}

/// Least projection of the head onto the normal, as a share of its length: as the head is laid flat, eq. 8.1's
/// stiffness k₁/l_p would grow without bound.
const LEAST_PROJECTION: f64 = 0.2;

impl Contact {
    /// Converts a model for the servo.
    ///
    /// # Errors
    /// The fault: a number that is not finite, a normal that is not a unit vector, a negative stiffness, a
    /// force that falls with depth, more than five knots, a grain or a relief out of range, a time to live or a
    /// recovery of more than a second.
    pub fn new(model: &ContactModel) -> Result<Self, &'static str> {
        Self::with_relief(model, 1.0)
    }

    /// Converts a model with its relief scaled by `share`, 0 to 1.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_relief(model: &ContactModel, share: f64) -> Result<Self, &'static str> {
        let point = DVec3::from_array(model.plane_point_m);
        let normal = DVec3::from_array(model.plane_normal);
        let scalars = [
            model.friction_static,
            model.friction_kinetic,
            model.viscous_n_s_m,
            model.head_length_m,
        ];
        if !point.is_finite() || !normal.is_finite() || !scalars.iter().all(|s| s.is_finite()) {
            return Err("a number is not finite");
        }
        if (normal.length() - 1.0).abs() > 1e-6 {
            return Err("the plane's normal is not a unit vector");
        }
        if scalars.iter().any(|scalar| *scalar < 0.0) || model.head_length_m < 1e-4 {
            return Err("friction, drag or head length is out of range");
        }
        if model.time_to_live_ns > ContactModel::TIME_TO_LIVE_MOST_NS
            || model.recovery_ns > ContactModel::RECOVERY_MOST_NS
        {
            return Err("the time to live or the recovery is longer than a second");
        }
        Ok(Self {
            point,
            normal,
            friction: model.friction_kinetic,
            sticking: model.friction_static.max(model.friction_kinetic),
            viscous: model.viscous_n_s_m,
            grain: Texture::new(&model.grain)?,
            relief: Relief::new(&model.relief, normal, share)?,
            law: Law::new(&model.law)?,
            head_length: model.head_length_m,
            time_to_live_s: model.time_to_live_ns as f64 * 1e-9,
            recovery_s: model.recovery_ns as f64 * 1e-9,
        })
    }

    /// Replaces the relief.
    #[cfg(test)]
    pub(crate) fn set_relief(&mut self, relief: Relief) {
        self.relief = Some(relief);
    }

    /// The plane's unit normal, toward the painter.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The undeformed point of the head, desk frame, m.
    fn tip(&self, handle: &HandleState) -> DVec3 {
        handle.position + handle.orientation * DVec3::NEG_Z * self.head_length
    }

    /// Penetration of the head into the plane.
    #[must_use]
    pub fn penetration(&self, handle: &HandleState) -> Penetration {
        let cosine = -(handle.orientation * DVec3::NEG_Z).dot(self.normal);
        Penetration {
            depth_m: (self.point - self.tip(handle)).dot(self.normal),
            projected_m: self.head_length * cosine.max(LEAST_PROJECTION),
            cosine,
        }
    }

    /// Force of the law along the normal at a depth, over relief of a height, m.
    fn normal_force(
        &self,
        handle: &HandleState,
        at: &Penetration,
        height_m: f64,
        most: f64,
    ) -> Normal {
        let Law::Local(local) = &self.law else {
            return self.law.normal(at, most);
        };
        let n = self.normal;
        let force_n = local.force(handle.position - n * height_m, most).dot(n);
        Normal {
            // A force at the first touch would be a step in the hand.
            force_n: force_n.max(0.0).min(most * at.depth_m.max(0.0)),
            stiffness_n_m: local.stiffness_along(n, most),
        }
    }

    /// Stiffness along the normal without a bound, N/m.
    fn asked(&self, at: &Penetration) -> f64 {
        match &self.law {
            Law::Local(local) => local.stiffness_along(self.normal, f64::INFINITY),
            law => law.normal(at, f64::INFINITY).stiffness_n_m,
        }
    }

    /// Force of the law on a relief, N, and the magnitude of the pressing force, N.
    fn pressing(
        &self,
        handle: &HandleState,
        height: &Height,
        across: f64,
        most: f64,
    ) -> (DVec3, Normal) {
        let plane = self.penetration(handle);
        let Some(relief) = &self.relief else {
            let normal = self.normal_force(handle, &plane, 0.0, most);
            return (self.normal * normal.force_n, normal);
        };
        let surface = Penetration {
            depth_m: plane.depth_m + height.height_m,
            ..plane
        };
        let most = relief.law_stiffness(across, most);
        let on_relief = self.normal_force(handle, &surface, height.height_m, most);
        let on_plane = self.normal_force(handle, &plane, 0.0, most);
        let [felt_n, felt_share] = light(on_relief.force_n);
        let [flat_n, flat_share] = light(on_plane.force_n);
        let deep_n = on_plane.force_n - flat_n;
        let force = (self.normal - height.slope) * felt_n + self.normal * deep_n;
        let stiffness_n_m =
            on_relief.stiffness_n_m * felt_share + on_plane.stiffness_n_m * (1.0 - flat_share);
        let force_n = felt_n + deep_n;
        (
            force,
            Normal {
                force_n,
                stiffness_n_m,
            },
        )
    }

    /// Force on the handle if no bristle sticks; its stiffness is at most `max_stiffness`, N/m.
    #[must_use]
    pub fn evaluate(&self, handle: &HandleState, max_stiffness: f64) -> ContactForce {
        self.evaluate_stuck(handle, &Stiction::default(), max_stiffness)
    }

    /// Force on the handle; its stiffness is at most `max_stiffness`, N/m.
    #[must_use]
    pub fn evaluate_stuck(
        &self,
        handle: &HandleState,
        stiction: &Stiction,
        max_stiffness: f64,
    ) -> ContactForce {
        let (tip, plane) = (self.tip(handle), self.penetration(handle));
        let relief = self.relief.as_ref();
        let height = relief.map_or_else(Height::default, |relief| relief.at(tip, max_stiffness));
        let depth_m = plane.depth_m + height.height_m;
        let none = ContactForce {
            depth_m,
            ..ContactForce::default()
        };
        if depth_m <= 0.0 && plane.depth_m <= 0.0 {
            return none;
        }
        let (n, ramp) = (self.normal, ramp(depth_m));
        let stuck_n_m = if self.sticking > 0.0 {
            STUCK_SHARE * max_stiffness
        } else {
            0.0
        };
        let across = stuck_n_m + self.grain.stiffness(max_stiffness);
        let (pressing, normal) = self.pressing(handle, &height, across, max_stiffness);
        let velocity = handle.velocity - n * handle.velocity.dot(n);
        let still_n = self.sticking * normal.force_n * ramp;
        let leaning = self.leaning(handle, still_n, max_stiffness);
        // What leans already sticks the less.
        let still_n = still_n - leaning.length();
        let moving_n = (self.friction * normal.force_n * ramp).min(still_n);
        let grip = Grip {
            normal: n,
            still_n,
            moving_n,
            stiffness_n_m: stuck_n_m,
        };
        let stuck = stiction.force(handle.position, &grip);
        let sliding =
            (stuck + friction(velocity, moving_n)).clamp_length_max(stiction.bound_n(&grip));
        let grain = self.grain.force(
            tip - self.point,
            n,
            velocity,
            normal.force_n * ramp,
            max_stiffness,
        );
        let steady = pressing + leaning + grain;
        ContactForce {
            force: steady + sliding + drag(velocity, self.viscous * ramp),
            conservative: steady + stuck,
            asked_n_m: self.asked(&Penetration { depth_m, ..plane }),
            stiffness_n_m: normal.stiffness_n_m,
            grip,
            lever: (tip - handle.position) * ramp,
            ..none
        }
    }

    /// Force of a local model along the surface, at most `most_n`.
    fn leaning(&self, handle: &HandleState, most_n: f64, max_stiffness: f64) -> DVec3 {
        let Law::Local(local) = &self.law else {
            return DVec3::ZERO;
        };
        let (n, force) = (self.normal, local.force(handle.position, max_stiffness));
        (force - n * force.dot(n)).clamp_length_max(most_n)
    }

    /// The force on the hand, N; stiffness never exceeds `max_stiffness`, N/m.
    #[must_use]
    pub fn force(&self, handle: &HandleState, max_stiffness: f64) -> DVec3 {
        self.evaluate(handle, max_stiffness).force
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use maulstick_num::geometry::rotation;
    use maulstick_types::Pose;
    use maulstick_types::haptics::ForceLaw;
    use proptest::prelude::*;

    use super::*;

    pub(crate) fn model(law: ForceLaw) -> ContactModel {
        ContactModel {
            friction_static: 0.3,
            friction_kinetic: 0.2,
            time_to_live_ns: 50_000_000,
            recovery_ns: 10_000_000,
            ..ContactModel::bare(law, 0.025)
        }
    }

    pub(crate) fn linear() -> ForceLaw {
        ForceLaw::Linear {
            k1_n: 0.8,
            k2_n: 6.0,
        }
    }

    fn at(depth: f64, tilt: f64, velocity: DVec3) -> HandleState {
        let orientation = rotation(DVec3::Y, tilt);
        let tip = DVec3::new(0.0, 0.0, -depth);
        HandleState {
            position: tip + orientation * DVec3::Z * 0.025,
            orientation,
            velocity,
        }
    }

    #[test]
    fn equation_8_1_has_its_two_straight_pieces() {
        let contact = Contact::new(&model(linear())).expect("a model");
        for (depth, expected) in [
            (-0.001, 0.0),
            (0.0, 0.0),
            (0.0125, 0.4),
            (0.025, 0.8),
            (0.0375, 0.8 + 3.0),
        ] {
            let force = contact.force(&at(depth, 0.0, DVec3::ZERO), 1e9);
            println!("{depth}: {force}, expected {expected}");
            assert!((force - DVec3::Z * expected).length() < 1e-12);
        }
    }

    #[test]
    fn a_brush_laid_flat_does_not_become_a_wall() {
        let contact = Contact::new(&model(linear())).expect("a model");
        let force = contact.force(&at(0.001, 1.5, DVec3::ZERO), 1e9).z;
        assert!(
            (force - 0.8 / (0.2 * 0.025) * 0.001).abs() < 1e-9,
            "{force}"
        );
        assert!((contact.force(&at(0.001, 0.0, DVec3::ZERO), 10.0).z - 0.01).abs() < 1e-12);
    }

    #[test]
    fn bad_models_are_refused() {
        let refused = |change: fn(&mut ContactModel)| {
            let mut model = model(linear());
            change(&mut model);
            Contact::new(&model).is_err()
        };
        assert!(!refused(|_| {}));
        assert!(refused(|m| m.plane_point_m[1] = f64::NAN));
        assert!(refused(|m| m.plane_normal = [0.0, 0.0, 2.0]));
        assert!(refused(|m| m.friction_kinetic = -1.0));
        assert!(refused(|m| m.head_length_m = 0.0));
        assert!(refused(|m| m.law = ForceLaw::Rigid {
            stiffness_n_m: f64::INFINITY
        }));
        assert!(refused(|m| m.law = ForceLaw::Hermite { knots: Vec::new() }));
        assert!(refused(|m| m.law = ForceLaw::Local {
            pose: Pose::IDENTITY,
            force_n: [f64::NAN; 3],
            stiffness_n_m: [[0.0; 3]; 3],
        }));
        assert!(refused(|m| m.grain.wavelength_m = 0.0));
        for endless in [1_000_000_001, u64::MAX] {
            let with = |change: fn(&mut ContactModel, u64)| {
                let mut model = model(linear());
                change(&mut model, endless);
                Contact::new(&model).err()
            };
            let told = Some("the time to live or the recovery is longer than a second");
            assert_eq!(with(|m, ns| m.time_to_live_ns = ns), told);
            assert_eq!(with(|m, ns| m.recovery_ns = ns), told);
        }
        assert!(!refused(|m| m.time_to_live_ns = 1_000_000_000));
        assert!(!refused(|m| m.recovery_ns = 1_000_000_000));
    }

    #[test]
    fn a_soft_device_gives_what_it_can_and_says_so() {
        let rigid = ForceLaw::Rigid {
            stiffness_n_m: 800.0,
        };
        let felt = Contact::new(&model(rigid))
            .expect("a model")
            .evaluate(&at(0.002, 0.0, DVec3::ZERO), 300.0);
        assert_eq!((felt.asked_n_m, felt.stiffness_n_m), (800.0, 300.0));
        assert!((felt.force.z - 0.6).abs() < 1e-12);
    }

    #[test]
    fn a_local_force_acts_in_contact_alone_and_within_friction() {
        let law = ForceLaw::Local {
            pose: Pose::IDENTITY,
            force_n: [9.0, 0.0, 0.5],
            stiffness_n_m: [[0.0; 3], [0.0; 3], [0.0, 0.0, -50.0]],
        };
        let contact = Contact::new(&model(law)).expect("a model");
        let felt = |depth: f64| contact.evaluate(&at(depth, 0.0, DVec3::ZERO), 500.0);
        assert_eq!(felt(-1e-3).force, DVec3::ZERO);
        assert!(felt(1e-5).force.length() < 0.01, "no step at the touch");
        let pressed = felt(0.025).force;
        // The pose of the linearisation: the ferrule at the plane.
        assert!((pressed.z - 0.5).abs() < 1e-12, "{pressed}");
        assert!((pressed.x - 0.3 * 0.5).abs() < 1e-12, "{pressed}");
    }

    #[test]
    fn grain_is_felt_in_contact_alone() {
        let mut grainy = model(linear());
        grainy.grain.amplitude = 0.1;
        let contact = Contact::new(&grainy).expect("a model");
        let across = |depth| {
            contact
                .force(&at(depth, 0.0, DVec3::ZERO), 400.0)
                .truncate()
        };
        assert!(across(0.01).length() > 0.0 && across(0.01).length() < 0.1 * 0.32);
        assert_eq!(across(-0.01).length(), 0.0);
    }

    proptest! {
        #[test]
        fn friction_opposes_motion_within_its_bound(
            depth in 0.0..0.03f64, vx in -1.0..1.0f64, vy in -1.0..1.0f64, tilt in 0.0..1.5f64,
        ) {
            let contact = Contact::new(&model(linear())).expect("a model");
            let handle = at(depth, tilt, DVec3::new(vx, vy, 0.3));
            let force = contact.force(&handle, 1e9);
            let across = force.truncate();
            prop_assert!(across.dot(handle.velocity.truncate()) <= 0.0);
            prop_assert!(across.length() <= 0.2 * force.z * (1.0 + 1e-9));
        }
    }
}
