//! Rigid motions: poses as messages carry them, rotations without the system's library.

use glam::{DQuat, DVec3};
use maulstick_types::Pose;

use crate::elementary::sin_cos;

/// A rigid motion: `p ↦ rotation·p + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Unit quaternion.
    pub rotation: DQuat,
    /// m.
    pub translation: DVec3,
}

impl Rigid {
    /// No motion.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// The image of a point.
    #[must_use]
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }

    /// The image of a direction.
    #[must_use]
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.rotation * v
    }

    /// The motion that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self {
            rotation,
            translation: -(rotation * self.translation),
        }
    }

    /// First `inner`, then this.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            rotation: canonical(self.rotation * inner.rotation),
            translation: self.point(inner.translation),
        }
    }

    /// The pose for a message.
    #[must_use]
    pub fn to_pose(&self) -> Pose {
        Pose {
            position_m: self.translation.to_array(),
            orientation: canonical(self.rotation).to_array(),
        }
    }
}

impl From<&Pose> for Rigid {
    fn from(pose: &Pose) -> Self {
        Self {
            rotation: DQuat::from_array(pose.orientation),
            translation: DVec3::from_array(pose.position_m),
        }
    }
}

/// The unit quaternion with w ≥ 0 of the same rotation.
#[must_use]
pub fn canonical(q: DQuat) -> DQuat {
    let q = q.normalize();
    if q.w < 0.0 { -q } else { q }
}

/// Rotation about the unit vector `axis` by `angle` rad.
#[must_use]
pub fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let (s, c) = sin_cos(0.5 * angle);
    DQuat::from_xyzw(axis.x * s, axis.y * s, axis.z * s, c)
}

/// The shortest rotation that takes the unit vector `from` to the unit vector `to`; for opposite
/// vectors, half a turn about any axis across them.
#[must_use]
pub fn shortest_arc(from: DVec3, to: DVec3) -> DQuat {
    let w = 1.0 + from.dot(to);
    if w < 1e-12 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    let v = from.cross(to);
    DQuat::from_xyzw(v.x, v.y, v.z, w).normalize()
}

/// Interpolates between rotations along the shorter way (normalised linear).
#[must_use]
pub fn nlerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    (a * (1.0 - t) + b * t).normalize()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn unit() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64)
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter("a direction", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize)
    }

    proptest! {
        #[test]
        fn the_shortest_arc_arrives(from in unit(), to in unit()) {
            prop_assert!((shortest_arc(from, to) * from - to).length() < 1e-12);
            prop_assert!((shortest_arc(from, -from) * from + from).length() < 1e-12);
        }

        #[test]
        fn a_motion_and_its_inverse_cancel(axis in unit(), angle in -3.0..3.0f64, t in unit()) {
            let motion = Rigid { rotation: rotation(axis, angle), translation: t };
            let both = motion.inverse().after(&motion);
            prop_assert!(both.translation.length() < 1e-12);
            prop_assert!((both.rotation.w - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_quarter_turn_is_one() {
        let turned = rotation(DVec3::Z, std::f64::consts::FRAC_PI_2) * DVec3::X;
        assert!((turned - DVec3::Y).length() < 1e-15);
    }
}
