//! From the vendor's axes, x out of the base toward the hand, y to the right, z up, to the device frame, x to the right, y up,
//! z toward the hand.

use glam::{DMat3, DQuat, DVec3};

/// A vector of theirs as one of ours.
#[must_use]
pub fn to_ours(theirs: DVec3) -> DVec3 {
    DVec3::new(theirs.y, theirs.z, theirs.x)
}

/// A vector of ours as one of theirs.
#[must_use]
pub fn to_theirs(ours: DVec3) -> DVec3 {
    DVec3::new(ours.z, ours.x, ours.y)
}

/// Orientation of the handle by the columns of its frame; at rest the handle points out of the base and the bristles into it.
#[must_use]
pub fn orientation(frame: &DMat3) -> DQuat {
    let turned = DMat3::from_cols(
        to_ours(frame.y_axis),
        to_ours(frame.z_axis),
        to_ours(frame.x_axis),
    );
    DQuat::from_mat3(&turned).normalize()
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;

    use super::*;

    #[test]
    fn axes_are_turned_and_not_mirrored() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        assert_eq!([x, y, z].map(to_ours), [z, x, y]);
        for way in [x, y, z, DVec3::new(1.0, -2.0, 3.0)] {
            assert_eq!(to_theirs(to_ours(way)), way);
        }
        assert!(to_ours(x).cross(to_ours(y)).abs_diff_eq(to_ours(z), 1e-12));
    }

    #[test]
    fn a_turn_of_theirs_is_the_same_turn_of_ours() {
        assert!(orientation(&DMat3::IDENTITY).abs_diff_eq(DQuat::IDENTITY, 1e-12));
        // About their upright axis, which is our y.
        let turned = orientation(&DMat3::from_quat(rotation(DVec3::Z, 0.3)));
        assert!(
            turned.abs_diff_eq(rotation(DVec3::Y, 0.3), 1e-12),
            "{turned}"
        );
        let rolled = orientation(&DMat3::from_quat(rotation(DVec3::X, 0.3)));
        assert!(
            rolled.abs_diff_eq(rotation(DVec3::Z, 0.3), 1e-12),
            "{rolled}"
        );
    }
}
