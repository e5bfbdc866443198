//! The axes in which Haply's Inverse service speaks, and ours.
//!
//! Haply's own frame is right-handed: x right, y forward, z up. A session may have it otherwise, by a
//! permutation such as "XZY" or "XZ-Y": the n-th letter says which of Haply's axes the session's n-th is, a
//! minus before it that it points the other way (docs.haply.co, inverseSDK/service/commons/basis). The
//! device frame has x right, y up, z toward the user, and so is device (x, y, z) = Haply's (x, z, −y). A
//! grip points along its own +y, which by the same map is −z: where the bristles lie.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::canonical;

/// Axes of a session in Haply's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// Haply's axis of each of the session's.
    axes: [usize; 3],
    signs: [f64; 3],
}

impl Basis {
    /// Haply's own frame.
    pub const HAPLY: Self = Self {
        axes: [0, 1, 2],
        signs: [1.0; 3],
    };

    /// Reads a permutation; `None` if it is invalid.
    #[must_use]
    pub fn read(permutation: &str) -> Option<Self> {
        let mut letters = permutation.bytes();
        let mut basis = Self::HAPLY;
        for place in 0..3 {
            let mut letter = letters.next()?;
            if letter == b'-' || letter == b'+' {
                basis.signs[place] = if letter == b'-' { -1.0 } else { 1.0 };
                letter = letters.next()?;
            }
            let axis = b"XYZ"
                .iter()
                .position(|axis| *axis == letter.to_ascii_uppercase())?;
            if basis.axes[..place].contains(&axis) {
                return None;
            }
            basis.axes[place] = axis;
        }
        letters.next().is_none().then_some(basis)
    }

    fn to_haply(self, session: DVec3) -> DVec3 {
        let mut haply = [0.0; 3];
        for (place, part) in session.to_array().into_iter().enumerate() {
            haply[self.axes[place]] = self.signs[place] * part;
        }
        haply.into()
    }

    /// A vector of the session in the device frame.
    #[must_use]
    pub fn to_device(self, session: DVec3) -> DVec3 {
        let haply = self.to_haply(session);
        DVec3::new(haply.x, haply.z, -haply.y)
    }

    /// A vector of the device frame in the session's axes.
    #[must_use]
    pub fn to_session(self, device: DVec3) -> DVec3 {
        let haply = [device.x, -device.z, device.y];
        DVec3::from_array([0, 1, 2].map(|place| self.signs[place] * haply[self.axes[place]]))
    }

    /// 1, or −1 where the session's axes are left-handed.
    fn handedness(self) -> f64 {
        let [a, b, c] = self.axes;
        let even = matches!((a, b, c), (0, 1, 2) | (1, 2, 0) | (2, 0, 1));
        let parity = if even { 1.0 } else { -1.0 };
        parity * self.signs[0] * self.signs[1] * self.signs[2]
    }

    /// A grip's orientation in the session as that of the brush in the device frame. The axis of a
    /// turn changes its sense where hands change.
    #[must_use]
    pub fn orientation(self, session: DQuat) -> DQuat {
        let axis = self.to_device(session.xyz()) * self.handedness();
        canonical(DQuat::from_xyzw(axis.x, axis.y, axis.z, session.w))
    }
}
