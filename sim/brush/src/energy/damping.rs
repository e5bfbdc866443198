//! Inner friction of a joint: plasticity.

use glam::DVec3;

/// The inner friction of a joint (Baxter 2004, eq. 3.4) in vector form, with the apex rounded off:
/// E = D·(√(|v|² + ε²) − ε), v the change of the chord between the directions of two segments since
/// the step began. A chord's length is 2·sin(β/2), so v has the length of Δβ where the joint only
/// bends, and counts a swing around the axis too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// E, J.
    pub value: f64,
    /// dE/dv, never longer than D, N·m.
    pub torque: DVec3,
    /// Coefficients of the Hessian: d²E/dv² is `across`·I − `along`·vvᵀ, N·m.
    pub across: f64,
    /// Coefficient of vvᵀ, N·m; see `across`.
    pub along: f64,
}

/// Rounding of [`Damping`], rad.
const DAMPING_EPSILON: f64 = 1e-3;

/// Evaluates [`Damping`] for friction `d` (N·m) and change of chord `v`.
#[must_use]
pub fn damping(d: f64, v: DVec3) -> Damping {
    let root = (v.length_squared() + DAMPING_EPSILON * DAMPING_EPSILON).sqrt();
    Damping {
        value: d * (root - DAMPING_EPSILON),
        torque: v * (d / root),
        across: d / root,
        along: d / (root * root * root),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damping_opposes_the_change_and_its_derivatives_agree() {
        for decade in -24..=0 {
            let size = maulstick_num::exp(f64::from(decade) / 2.0);
            let v = DVec3::new(0.48, -0.64, 0.6) * size;
            let f = |v: DVec3| damping(0.5, v);
            let got = f(v);
            assert!(got.torque.length() < 0.5 && got.torque.dot(v) > 0.0);
            let h = 1e-4 * size.max(1e-4);
            for (axis, step) in [DVec3::X, DVec3::Y, DVec3::Z]
                .map(|e| e * h)
                .into_iter()
                .enumerate()
            {
                let numeric = (f(v + step).value - f(v - step).value) / (2.0 * h);
                assert!((numeric - got.torque[axis]).abs() < 1e-6, "{size}");
                assert!((numeric - 1.001 * got.torque[axis]).abs() > 1e-6 || size < 1e-4);
                let numeric = (f(v + step).torque - f(v - step).torque) / (2.0 * h);
                let column = DVec3::AXES[axis] * got.across - v * (got.along * v[axis]);
                assert!(
                    (numeric - column).length() < 1e-4 * numeric.length().max(1.0),
                    "{size}"
                );
            }
        }
    }
}
