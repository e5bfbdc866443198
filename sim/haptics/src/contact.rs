//! The force of one contact model (Baxter 2004, § 8.7.2), evaluated beside the device.

use glam::{DMat3, DQuat, DVec3};
use maulstick_types::haptics::{ContactModel, ForceLaw, HermiteKnot};

/// The brush in the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Where head and ferrule meet, desk frame, m.
    pub position: DVec3,
    /// Brush frame to desk frame.
    pub orientation: DQuat,
    /// Velocity of the ferrule, m/s.
    pub velocity: DVec3,
}

/// Knots of a Hermite curve at most.
pub const KNOTS: usize = 5;

/// Force by depth, ready for the servo: no allocation in it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    None,
    Linear {
        k1_n: f64,
        k2_n: f64,
    },
    Hermite {
        knots: [[f64; 3]; KNOTS],
        count: usize,
    },
    Local {
        at: DVec3,
        force: DVec3,
        stiffness: DMat3,
    },
    Rigid {
        stiffness: f64,
    },
}

/// A contact model in the form that the servo evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    point: DVec3,
    normal: DVec3,
    friction: f64,
    viscous: f64,
    law: Law,
    head_length: f64,
    /// Age beyond which it decays, s.
    pub time_to_live_s: f64,
    /// Time over which it takes the place of the one before, s.
    pub recovery_s: f64,
}

/// The head counts as projected onto the normal by at least this share of its length: as it is laid
/// flat, eq. 8.1's stiffness k₁/l_p would grow without bound.
const LEAST_PROJECTION: f64 = 0.2;
/// Friction grows to its full size over this depth, m.
const FRICTION_RAMP_M: f64 = 5e-4;
/// Speed at which friction reaches its bound μ·f_n, m/s.
const FRICTION_SPEED: f64 = 0.02;

impl Contact {
    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with it: a number that is not finite, a normal that is not a unit vector, a
    /// negative stiffness or more than five knots.
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
        Ok(Self {
            point,
            normal,
            friction: model.friction_kinetic,
            viscous: model.viscous_n_s_m,
            law: Law::new(&model.law)?,
            head_length: model.head_length_m,
            time_to_live_s: model.time_to_live_ns as f64 * 1e-9,
            recovery_s: model.recovery_ns as f64 * 1e-9,
        })
    }

    /// The depth of the undeformed point below the plane and the head's length along the normal, m.
    fn depth(&self, held: &Held) -> (f64, f64) {
        let along = held.orientation * DVec3::NEG_Z;
        let tip = held.position + along * self.head_length;
        let projected =
            (self.head_length * -along.dot(self.normal)).max(LEAST_PROJECTION * self.head_length);
        ((self.point - tip).dot(self.normal), projected)
    }

    /// The force on the hand, N; stiffness never exceeds `max_stiffness`, N/m.
    #[must_use]
    pub fn force(&self, held: &Held, max_stiffness: f64) -> DVec3 {
        let (depth, projected) = self.depth(held);
        if let Law::Local {
            at,
            force,
            stiffness,
        } = self.law
        {
            return if depth > 0.0 {
                force + stiffness * (held.position - at)
            } else {
                DVec3::ZERO
            };
        }
        if depth <= 0.0 {
            return DVec3::ZERO;
        }
        let normal_force = self
            .law
            .normal_force(depth, projected, max_stiffness)
            .max(0.0);
        let across = held.velocity - self.normal * held.velocity.dot(self.normal);
        let ramp = (depth / FRICTION_RAMP_M).min(1.0);
        let bound = self.friction * normal_force * ramp;
        let speed = across.length();
        let sliding = if speed > 0.0 {
            across * (-bound * (speed / FRICTION_SPEED).min(1.0) / speed)
        } else {
            DVec3::ZERO
        };
        self.normal * normal_force + sliding - across * (self.viscous * ramp)
    }
}

impl Law {
    fn new(law: &ForceLaw) -> Result<Self, &'static str> {
        let good = |values: &[f64]| values.iter().all(|v| v.is_finite() && *v >= 0.0);
        match law {
            ForceLaw::None => Ok(Self::None),
            ForceLaw::Linear { k1_n, k2_n } if good(&[*k1_n, *k2_n]) => Ok(Self::Linear {
                k1_n: *k1_n,
                k2_n: *k2_n,
            }),
            ForceLaw::Hermite { knots } => Self::hermite(knots),
            ForceLaw::Local {
                pose,
                force_n,
                stiffness_n_m,
            } => {
                let force = DVec3::from_array(*force_n);
                let stiffness = DMat3::from_cols_array_2d(stiffness_n_m).transpose();
                if !(pose.is_valid() && force.is_finite() && stiffness.is_finite()) {
                    return Err("the local force is not finite");
                }
                Ok(Self::Local {
                    at: DVec3::from_array(pose.position_m),
                    force,
                    stiffness,
                })
            }
            ForceLaw::Rigid { stiffness_n_m } if good(&[*stiffness_n_m]) => Ok(Self::Rigid {
                stiffness: *stiffness_n_m,
            }),
            _ => Err("a stiffness is negative or not finite"),
        }
    }

    fn hermite(knots: &[HermiteKnot]) -> Result<Self, &'static str> {
        if !(2..=KNOTS).contains(&knots.len()) {
            return Err("a Hermite curve has two to five knots");
        }
        let mut table = [[0.0; 3]; KNOTS];
        for (row, knot) in table.iter_mut().zip(knots) {
            *row = [knot.depth, knot.force_n, knot.slope_n];
        }
        let rising = knots.windows(2).all(|pair| pair[0].depth < pair[1].depth);
        if !rising || !table.iter().flatten().all(|value| value.is_finite()) {
            return Err("a Hermite curve's knots are not finite and in order of depth");
        }
        Ok(Self::Hermite {
            knots: table,
            count: knots.len(),
        })
    }

    /// Normal force at `depth` for a head of `projected` length along the normal.
    fn normal_force(&self, depth: f64, projected: f64, max_stiffness: f64) -> f64 {
        match *self {
            Self::None | Self::Local { .. } => 0.0,
            Self::Linear { k1_n, k2_n } => {
                let soft = (k1_n / projected).min(max_stiffness);
                let hard = (k2_n / projected).min(max_stiffness);
                soft * depth.min(projected) + hard * (depth - projected).max(0.0)
            }
            Self::Hermite { knots, count } => {
                (hermite(&knots[..count], depth / projected)).min(max_stiffness * depth)
            }
            Self::Rigid { stiffness } => stiffness.min(max_stiffness) * depth,
        }
    }
}

/// The cubic through knots of (place, value, slope); beyond the ends it goes on straight.
fn hermite(knots: &[[f64; 3]], x: f64) -> f64 {
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    if x <= first[0] {
        return first[1] + first[2] * (x - first[0]);
    }
    if x >= last[0] {
        return last[1] + last[2] * (x - last[0]);
    }
    let place = knots.iter().rposition(|knot| knot[0] <= x).unwrap_or(0);
    let ([x0, y0, m0], [x1, y1, m1]) = (knots[place], knots[place + 1]);
    let h = x1 - x0;
    let t = (x - x0) / h;
    let u = 1.0 - t;
    y0 * (1.0 + 2.0 * t) * u * u + h * m0 * t * u * u + y1 * t * t * (3.0 - 2.0 * t)
        - h * m1 * t * t * u
}

#[cfg(test)]
pub(crate) mod tests {
    use maulstick_num::geometry::rotation;
    use maulstick_types::Pose;
    use maulstick_types::haptics::Grain;
    use proptest::prelude::*;

    use super::*;

    pub(crate) fn model(law: ForceLaw) -> ContactModel {
        ContactModel {
            device: 1,
            device_epoch: 1,
            brush: "main".into(),
            plane_point_m: [0.0; 3],
            plane_normal: [0.0, 0.0, 1.0],
            friction_static: 0.3,
            friction_kinetic: 0.2,
            viscous_n_s_m: 0.0,
            grain: Grain {
                amplitude: 0.0,
                wavelength_m: 1e-3,
                seed: 1,
            },
            law,
            head_length_m: 0.025,
            time_to_live_ns: 50_000_000,
            recovery_ns: 10_000_000,
        }
    }

    pub(crate) fn linear() -> ForceLaw {
        ForceLaw::Linear {
            k1_n: 0.8,
            k2_n: 6.0,
        }
    }

    fn at(depth: f64, tilt: f64, velocity: DVec3) -> Held {
        let orientation = rotation(DVec3::Y, tilt);
        let tip = DVec3::new(0.0, 0.0, -depth);
        Held {
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
    fn hermite_goes_through_its_knots() {
        let knots = [
            [0.0, 0.0, 5.0],
            [0.1, 0.4, 0.0],
            [0.5, 0.5, 1.0],
            [1.0, 1.2, 2.0],
        ];
        for knot in knots {
            assert!((hermite(&knots, knot[0]) - knot[1]).abs() < 1e-12);
            let slope = (hermite(&knots, knot[0] + 1e-6) - hermite(&knots, knot[0] - 1e-6)) / 2e-6;
            assert!((slope - knot[2]).abs() < 1e-4, "{slope} {}", knot[2]);
        }
        assert!((hermite(&knots, 1.5) - 2.2).abs() < 1e-12);
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
    }

    proptest! {
        #[test]
        fn friction_opposes_motion_within_its_bound(
            depth in 0.0..0.03f64, vx in -1.0..1.0f64, vy in -1.0..1.0f64, tilt in 0.0..1.5f64,
        ) {
            let contact = Contact::new(&model(linear())).expect("a model");
            let held = at(depth, tilt, DVec3::new(vx, vy, 0.3));
            let force = contact.force(&held, 1e9);
            let across = force.truncate();
            prop_assert!(across.dot(held.velocity.truncate()) <= 0.0);
            prop_assert!(across.length() <= 0.2 * force.z * (1.0 + 1e-9));
        }
    }
}
