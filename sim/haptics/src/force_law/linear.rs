//! Two straight pieces (Baxter 2004, eq. 8.1): the light spring of the bristles, and the handle that
//! meets the canvas.
//!
//! ```text
//! f = 0                            d ≤ 0
//! f = (k₁/l_p)·d                   0 < d ≤ l_p
//! f = k₁ + (k₂/l_p)·(d − l_p)      l_p < d
//! ```
//!
//! k₁ and k₂ are in newtons, so the force when the handle first meets the plane is independent of the brush's length
//! and tilt.

use super::{Normal, Penetration};

/// k₁ and k₂ of eq. 8.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Force when the handle meets the plane, N.
    pub k1_n: f64,
    /// Additional force a head's length deeper, N.
    pub k2_n: f64,
}

impl Linear {
    /// Force in contact; neither piece is stiffer than `max_stiffness`, N/m.
    #[must_use]
    pub fn normal(&self, penetration: &Penetration, max_stiffness: f64) -> Normal {
        let (depth, projected) = (penetration.depth_m, penetration.projected_m);
        let soft = (self.k1_n / projected).min(max_stiffness);
        let hard = (self.k2_n / projected).min(max_stiffness);
        Normal {
            force_n: soft * depth.min(projected) + hard * (depth - projected).max(0.0),
            stiffness_n_m: if depth <= projected { soft } else { hard },
        }
    }
}
