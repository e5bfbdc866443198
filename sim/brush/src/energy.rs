//! The energies of a spine: value, gradient and Hessian together.
//!
//! With d the directions of the segments and T_j a basis of the tangent plane at d_j, a small
//! change is δd_j = T_j·u_j. Gradients and Hessians are in the u_j, the curvature of the sphere
//! included, so that a Newton step on them converges quadratically.

use glam::{DVec2, DVec3};
use maulstick_num::atan2;

/// Value of a function of the cosine c between two unit vectors, and its first two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfCosine {
    /// f(c), J.
    pub value: f64,
    /// df/dc.
    pub first: f64,
    /// d²f/dc².
    pub second: f64,
}

/// The spring of a joint (Baxter 2004, eq. 3.2): ½·K·β², β the angle between `a` and `b`.
///
/// df/dc = −K·β/sin β, d²f/dc² = K·(1 − β·cot β)/sin²β, by their series where β < 1e-2. Near a
/// fold, β → π, the derivatives stay bounded.
#[must_use]
pub fn spring(stiffness: f64, a: DVec3, b: DVec3) -> OfCosine {
    let (sine, cosine) = (a.cross(b).length(), a.dot(b));
    let beta = atan2(sine, cosine);
    let (ratio, second) = if beta < 1e-2 {
        let b2 = beta * beta;
        (
            1.0 + b2 / 6.0 + 7.0 * b2 * b2 / 360.0,
            1.0 / 3.0 + 4.0 * b2 / 15.0,
        )
    } else {
        let sine = sine.max(1e-3);
        (beta / sine, (1.0 - beta * cosine / sine) / (sine * sine))
    };
    OfCosine {
        value: 0.5 * stiffness * beta * beta,
        first: -stiffness * ratio,
        second: stiffness * second,
    }
}

/// Friction at a contact (Baxter 2004, eq. 3.3) with the apex of the cone rounded off:
/// E = w·(√(|u|² + ε²) − ε), w = μ·|F_n|, u the slip in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// E, J.
    pub value: f64,
    /// dE/du: opposes the slip and never exceeds w, N.
    pub force: DVec2,
    /// d²E/du², columns of a symmetric matrix, N/m.
    pub hessian: [DVec2; 2],
}

/// Evaluates [`Friction`] for weight `w` (N), slip `u` (m) and rounding `epsilon` (m).
#[must_use]
pub fn friction(w: f64, u: DVec2, epsilon: f64) -> Friction {
    let root = (u.length_squared() + epsilon * epsilon).sqrt();
    let cube = w / (root * root * root);
    let mixed = -cube * u.x * u.y;
    Friction {
        value: w * (root - epsilon),
        force: u * (w / root),
        hessian: [
            DVec2::new(cube * (root * root - u.x * u.x), mixed),
            DVec2::new(mixed, cube * (root * root - u.y * u.y)),
        ],
    }
}

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
    /// d²E/dv² is `across`·I − `along`·vvᵀ, N·m.
    pub across: f64,
    /// See `across`.
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
    use maulstick_num::{cos, sin};

    use super::*;

    #[test]
    fn the_spring_is_half_k_beta_squared_at_every_angle() {
        let unit = |beta: f64| DVec3::new(sin(beta), 0.0, cos(beta));
        for decade in -60..=4 {
            let beta = maulstick_num::exp(f64::from(decade) / 4.0);
            if beta > 3.0 {
                continue;
            }
            let f = |beta: f64| spring(2.0, DVec3::Z, unit(beta));
            let got = f(beta);
            assert!(
                (got.value - beta * beta).abs() <= 1e-13 * beta * beta,
                "{beta}"
            );
            // d/dβ = −sin β·d/dc.
            let h = 1e-4 * beta;
            let numeric = (f(beta + h).value - f(beta - h).value) / (2.0 * h);
            let analytic = -sin(beta) * got.first;
            assert!((numeric - analytic).abs() < 1e-6 * analytic.abs(), "{beta}");
            let numeric = (f(beta + h).first - f(beta - h).first) / (2.0 * h);
            let analytic = -sin(beta) * got.second;
            let scale = analytic.abs().max(1e-7 / h);
            assert!(
                (numeric - analytic).abs() < 1e-4 * scale,
                "{beta}: {numeric} {analytic}"
            );
            let faulty = -sin(beta) * got.first * 1.00001;
            let numeric = (f(beta + h).value - f(beta - h).value) / (2.0 * h);
            assert!(
                (numeric - faulty).abs() > 1e-6 * faulty.abs(),
                "a fault would pass"
            );
        }
    }

    #[test]
    fn friction_opposes_slip_within_the_cone_and_its_derivatives_agree() {
        for decade in -24..=0 {
            let size = maulstick_num::exp(f64::from(decade) / 2.0);
            let u = DVec2::new(0.6, -0.8) * size;
            let f = |u: DVec2| friction(0.5, u, 1e-3);
            let got = f(u);
            assert!(got.force.length() < 0.5 && got.force.dot(u) > 0.0);
            let h = 1e-4 * size.max(1e-4);
            for (axis, step) in [DVec2::X * h, DVec2::Y * h].into_iter().enumerate() {
                let numeric = (f(u + step).value - f(u - step).value) / (2.0 * h);
                assert!((numeric - got.force[axis]).abs() < 1e-6, "{size}");
                let numeric = (f(u + step).force - f(u - step).force) / (2.0 * h);
                let error = (numeric - got.hessian[axis]).length();
                assert!(error < 1e-4 * numeric.length().max(1.0), "{size}: {error}");
            }
        }
    }

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
