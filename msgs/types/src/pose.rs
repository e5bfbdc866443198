//! Position and orientation.

use crate::wire::define::wire_struct;

wire_struct! {
    /// A rigid transform from a child frame to its parent: `p_parent = q·p_child + position`.
    pub struct Pose {
        /// Origin of the child frame in the parent, m.
        pub position_m: [f64; 3],
        /// Unit quaternion x, y, z, w with w ≥ 0.
        pub orientation: [f64; 4],
    }
}

impl Pose {
    /// Pose of a child that coincides with its parent.
    pub const IDENTITY: Self = Self {
        position_m: [0.0; 3],
        orientation: [0.0, 0.0, 0.0, 1.0],
    };

    /// True if all numbers are finite and the quaternion is a unit one within 1e-6.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let norm: f64 = self.orientation.iter().map(|q| q * q).sum();
        self.position_m.iter().all(|x| x.is_finite()) && (norm - 1.0).abs() < 1e-6
    }
}
