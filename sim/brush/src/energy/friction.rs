//! Friction at a contact.

use glam::{DMat3, DVec3};
use maulstick_num::powf;

use super::outer;

/// Bristles catch in the tooth when pushed and not when pulled (Baxter 2004, eq. 3.13 and 3.14).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anisotropy {
    /// C_η from 0 to 1: the share of friction that is missing in the preferred direction.
    pub share: f64,
    /// k > 1: how sharply the preferred direction is focused.
    pub focus: f64,
    /// d_p: unit vector in the plane from the point to the root of the segment that ends at the
    /// contact; 0 where it vanishes.
    pub preferred: DVec3,
}

/// Friction at a contact (Baxter 2004, eq. 3.3 and 3.13) with the apex of the cone rounded off: E = w·(1 − η)·(r − ε),
/// r = √(|u|² + ε²), w = μ·|F_n|, u the slip along the surface; η = C·max(0, d_p·u/r)^k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// E, J.
    pub value: f64,
    /// dE/du: without anisotropy it opposes the slip and never exceeds w, N.
    pub force: DVec3,
    /// d²E/du², N/m.
    pub hessian: DMat3,
}

/// Evaluates [`Friction`] for weight `w` (N), slip `u` (m) along a surface with unit `normal` and rounding `epsilon`
/// (m).
#[must_use]
pub fn friction(
    w: f64,
    u: DVec3,
    normal: DVec3,
    epsilon: f64,
    anisotropy: &Anisotropy,
) -> Friction {
    let r = (u.length_squared() + epsilon * epsilon).sqrt();
    let along = DMat3::IDENTITY - outer(normal, normal);
    let slope = u / r;
    let curve = (along - outer(slope, slope)) * (1.0 / r);
    let cone = r - epsilon;
    let pulled = anisotropy.preferred.dot(u);
    if anisotropy.share == 0.0 || pulled <= 0.0 {
        return Friction {
            value: w * cone,
            force: slope * w,
            hessian: curve * w,
        };
    }
    let (c, k, d) = (anisotropy.share, anisotropy.focus, anisotropy.preferred);
    // a = d·u/r and its derivatives; g = 1 − C·a^k and its.
    let a = (pulled / r).max(1e-12);
    let power = powf(a, k - 2.0);
    let (g, g1, g2) = (
        1.0 - c * power * a * a,
        -c * k * power * a,
        -c * k * (k - 1.0) * power,
    );
    let da = (d - slope * a) / r;
    let mixed = outer(d, slope) + outer(slope, d);
    let dda = (outer(slope, slope) * (3.0 * a) - mixed - along * a) * (1.0 / (r * r));
    let cross = outer(da, slope) + outer(slope, da);
    Friction {
        value: w * g * cone,
        force: (slope * g + da * (cone * g1)) * w,
        hessian: (curve * g + cross * g1 + (outer(da, da) * g2 + dda * g1) * cone) * w,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(anisotropy: &Anisotropy) {
        for decade in -24..=0 {
            let size = maulstick_num::exp(f64::from(decade) / 2.0);
            let u = DVec3::new(0.6, -0.8, 0.0) * size;
            let f = |u: DVec3| friction(0.5, u, DVec3::Z, 1e-3, anisotropy);
            let got = f(u);
            assert!(got.force.length() < 0.5 && got.force.dot(u) > 0.0);
            let h = 1e-4 * size.max(1e-4);
            for axis in [DVec3::X, DVec3::Y] {
                let step = axis * h;
                let numeric = (f(u + step).value - f(u - step).value) / (2.0 * h);
                assert!((numeric - got.force.dot(axis)).abs() < 1e-6, "{size}");
                let faulty = 1.0001 * got.force.dot(axis) + 1e-5;
                assert!((numeric - faulty).abs() > 1e-6, "a fault would pass");
                let numeric = (f(u + step).force - f(u - step).force) / (2.0 * h);
                let error = (numeric - got.hessian * axis).length();
                assert!(error < 1e-4 * numeric.length().max(1.0), "{size}: {error}");
            }
        }
    }

    #[test]
    fn friction_opposes_slip_within_the_cone_and_its_derivatives_agree() {
        check(&Anisotropy::default());
        let preferred = DVec3::new(0.8, -0.6, 0.0);
        for focus in [1.5, 2.0, 3.0] {
            let anisotropy = Anisotropy {
                share: 0.4,
                focus,
                preferred,
            };
            check(&anisotropy);
        }
    }

    #[test]
    fn a_pulled_bristle_slips_more_easily_than_a_pushed_one() {
        let anisotropy = Anisotropy {
            share: 0.7,
            focus: 2.0,
            preferred: DVec3::X,
        };
        let force = |u: DVec3| {
            let f = friction(1.0, u, DVec3::Z, 1e-9, &anisotropy);
            f.force.dot(u.normalize())
        };
        assert!((force(DVec3::X) - 0.3).abs() < 1e-6);
        assert!((force(DVec3::NEG_X) - 1.0).abs() < 1e-6);
        assert!((force(DVec3::Y) - 1.0).abs() < 1e-6);
        let diagonal = force(DVec3::new(1.0, 1.0, 0.0));
        assert!((diagonal - 0.65).abs() < 1e-6, "1 − .7·cos²45°: {diagonal}");
    }
}
