//! The force of one contact model (Baxter 2004, § 8.7.2), evaluated beside the device.

use glam::{DQuat, DVec3};
use maulstick_types::haptics::ContactModel;

use crate::force_law::{Law, Normal, Penetration};
use crate::friction::{drag, friction, ramp};
use crate::grain::Texture;

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
    law: Law,
    head_length: f64,
    /// Age beyond which it decays, s.
    pub time_to_live_s: f64,
    /// Time over which it takes the place of the one before, s.
    pub recovery_s: f64,
}

/// Contact force on the handle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Whole force on the hand, N.
    pub force: DVec3,
    /// Part that depends on position alone, N: without friction and drag.
    pub conservative: DVec3,
    /// Depth of the undeformed point below the plane, m; negative above it.
    pub depth_m: f64,
    /// Stiffness along the normal that the model asks for, N/m.
    pub asked_n_m: f64,
    /// Stiffness along the normal that is given, N/m.
    pub stiffness_n_m: f64,
}

/// The head counts as projected onto the normal by at least this share of its length: as it is laid
/// flat, eq. 8.1's stiffness k₁/l_p would grow without bound.
const LEAST_PROJECTION: f64 = 0.2;

impl Contact {
    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with it: a number that is not finite, a normal that is not a unit vector, a
    /// negative stiffness, a force that falls with depth, more than five knots, a grain out of range, a
    /// time to live or a recovery of more than a second.
    pub fn new(model: &ContactModel) -> Result<Self, &'static str> {
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
            law: Law::new(&model.law)?,
            head_length: model.head_length_m,
            time_to_live_s: model.time_to_live_ns as f64 * 1e-9,
            recovery_s: model.recovery_ns as f64 * 1e-9,
        })
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

    /// The force on the handle; stiffness never exceeds `max_stiffness`, N/m.
    #[must_use]
    pub fn evaluate(&self, handle: &HandleState, max_stiffness: f64) -> ContactForce {
        let penetration = self.penetration(handle);
        let depth_m = penetration.depth_m;
        let none = ContactForce {
            depth_m,
            ..ContactForce::default()
        };
        if depth_m <= 0.0 {
            return none;
        }
        let n = self.normal;
        let (normal, asked_n_m, leaning) = match &self.law {
            Law::Local(local) => {
                let force = local.force(handle.position, max_stiffness);
                // A force that is there at the first touch would be a step in the hand.
                let force_n = force.dot(n).max(0.0).min(max_stiffness * depth_m);
                let normal = Normal {
                    force_n,
                    stiffness_n_m: local.stiffness_along(n, max_stiffness),
                };
                let asked = local.stiffness_along(n, f64::INFINITY);
                (normal, asked, force - n * force.dot(n))
            }
            law => (
                law.normal(&penetration, max_stiffness),
                law.normal(&penetration, f64::INFINITY).stiffness_n_m,
                DVec3::ZERO,
            ),
        };
        let velocity = handle.velocity - n * handle.velocity.dot(n);
        let ramp = ramp(depth_m);
        let leaning = leaning.clamp_length_max(self.sticking * normal.force_n * ramp);
        // What leans already sticks the less.
        let bound = (self.friction * normal.force_n * ramp)
            .min(self.sticking * normal.force_n * ramp - leaning.length());
        let sliding = friction(velocity, bound) + drag(velocity, self.viscous * ramp);
        let place = self.tip(handle) - self.point;
        let grain = self
            .grain
            .force(place, n, velocity, normal.force_n * ramp, max_stiffness);
        let conservative = n * normal.force_n + leaning + grain;
        ContactForce {
            force: conservative + sliding,
            conservative,
            asked_n_m,
            stiffness_n_m: normal.stiffness_n_m,
            ..none
        }
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
