//! From the axes of a WoodenHaptics or Polhem stylus to the device frame and back.
//!
//! Their frame is CHAI3D's: x toward the user, y right, z up. Ours has x right, y up, z toward the
//! user, and so is device (x, y, z) = their (y, z, x), which is the map to H3D of the devices' authors.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::{canonical, rotation};

use super::frame::Pose;

/// Their vector in the device frame.
#[must_use]
pub fn to_device(theirs: DVec3) -> DVec3 {
    DVec3::new(theirs.y, theirs.z, theirs.x)
}

/// A vector of the device frame in theirs.
#[must_use]
pub fn to_theirs(device: DVec3) -> DVec3 {
    DVec3::new(device.z, device.x, device.y)
}

/// Position of the stylus' tip, device frame, m.
#[must_use]
pub fn position(pose: &Pose) -> DVec3 {
    to_device(DVec3::from_array(pose.position_mm)) * 1e-3
}

/// Orientation of the stylus: brush frame to device frame.
///
/// Theirs is R = R_z(t_A)·R_y(−λ)·R_x(t_D)·R_y(t_E)·R_x(t_F), where x runs along the stylus to its far end; t_F, the
/// roll, comes over a radio of its own and is 0 here. Named by the device frame's axes the far end is along z, and the
/// bristles along −z, as in the brush frame.
#[must_use]
pub fn orientation(pose: &Pose) -> DQuat {
    let [t_a, lambda, t_d, t_e] = pose.angles_rad;
    let turned = rotation(DVec3::Y, t_a)
        * rotation(DVec3::X, -lambda)
        * rotation(DVec3::Z, t_d)
        * rotation(DVec3::X, t_e);
    canonical(turned)
}
