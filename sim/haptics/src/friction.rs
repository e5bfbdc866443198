//! Forces across the normal (Baxter 2004, § 8.7.2 and eq. 8.8): friction, and the drag of paint.
//!
//! The text's f_t = k_t·(v − n(n·v)) would push the hand on; it opposes the motion, acts in contact
//! alone, and is bounded by μ·f_n. The drag μ_p·L·v of eq. 8.8 has no such bound: a film drags
//! however lightly it is touched. Both come up over the first half millimetre.

use glam::DVec3;

/// Friction and drag grow to their full size over this depth, m.
pub const RAMP_M: f64 = 5e-4;
/// Speed at which friction reaches its bound, m/s: k_t = μ·f_n by this.
const FULL_SPEED: f64 = 0.02;

/// How far a depth has brought friction up, 0 to 1.
#[must_use]
pub fn ramp(depth_m: f64) -> f64 {
    (depth_m / RAMP_M).clamp(0.0, 1.0)
}

/// Friction at the velocity `across` the normal, m/s; its size is at most `bound_n`.
#[must_use]
pub fn friction(across: DVec3, bound_n: f64) -> DVec3 {
    let speed = across.length();
    if speed > 0.0 {
        across * (-bound_n * (speed / FULL_SPEED).min(1.0) / speed)
    } else {
        DVec3::ZERO
    }
}

/// Drag of paint at the velocity `across` the normal, m/s; `viscous` is μ·L, N·s/m.
#[must_use]
pub fn drag(across: DVec3, viscous: f64) -> DVec3 {
    -across * viscous
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn friction_opposes_motion_within_its_bound(
            x in -2.0..2.0f64, y in -2.0..2.0f64, bound in 0.0..3.0f64,
        ) {
            let across = DVec3::new(x, y, 0.0);
            let force = friction(across, bound);
            prop_assert!(force.dot(across) <= 0.0 && force.length() <= bound * (1.0 + 1e-12));
            prop_assert!(across.length() < FULL_SPEED || force.length() >= bound * (1.0 - 1e-12));
        }
    }
}
