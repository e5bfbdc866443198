//! The spring of a joint, straight or bent at rest.

use glam::{DMat3, DVec3};
use maulstick_num::atan2;

use super::outer;

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

/// The cosine between a segment e and where it would be at rest, w(d), d the direction of the segment
/// before it; with its derivatives by both.
///
/// A spine that is straight at rest has w(d) = d. One that is bent has w(d) = A(d)·r: r is where the
/// segment would point if the one before pointed along the base b, and A(d) is the shortest turn
/// from b to d,
///
/// A(d)·r = r − ((b+d)·r)/(1+b·d)·(b+d) + 2(b·r)·d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// w(d): the derivative of the cosine by e.
    pub rest: DVec3,
    /// Derivative of the cosine by d.
    pub by_before: DVec3,
    /// Additional terms of a spine that is bent at rest.
    pub bent: Option<Bent>,
}

/// Second derivatives of a [`Bend`] whose rest is not straight; of a straight one the mixed one is
/// the identity and the other 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent {
    /// ∂²c/∂e∂d.
    pub mixed: DMat3,
    /// ∂²c/∂d².
    pub by_before: DMat3,
}

/// The bend of the segment `e` after the segment `d` of a straight spine.
#[must_use]
pub fn straight(d: DVec3, e: DVec3) -> Bend {
    Bend {
        rest: d,
        by_before: e,
        bent: None,
    }
}

/// Rest direction of a segment after the segment `d`: A(d)·r for the base `b`.
#[must_use]
pub fn rest_after(b: DVec3, r: DVec3, d: DVec3) -> DVec3 {
    let s = b + d;
    r - s * (s.dot(r) / least(1.0 + b.dot(d))) + d * (2.0 * b.dot(r))
}

/// Smallest allowed |q|: a segment that points back along the base has no shortest turn, so its neighbourhood is left
/// out.
fn least(q: f64) -> f64 {
    q.max(1e-3)
}

/// The bend of the segment `e` after the segment `d` of a spine with base `b` and rest `r`.
#[must_use]
pub fn bent(b: DVec3, r: DVec3, d: DVec3, e: DVec3) -> Bend {
    let s = b + d;
    let q = least(1.0 + b.dot(d));
    let (p, m, straight) = (s.dot(r), e.dot(s), 2.0 * b.dot(r));
    let both = |u: DVec3, v: DVec3| outer(u, v) + outer(v, u);
    Bend {
        rest: r - s * (p / q) + d * straight,
        by_before: -r * (m / q) + b * (p * m / (q * q)) + e * (straight - p / q),
        bent: Some(Bent {
            mixed: DMat3::from_diagonal(DVec3::splat(straight - p / q))
                - outer(s, r / q - b * (p / (q * q))),
            by_before: (both(r, b) * m + both(b, e) * p) * (1.0 / (q * q))
                - both(r, e) * (1.0 / q)
                - outer(b, b) * (2.0 * p * m / (q * q * q)),
        }),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::shortest_arc;
    use maulstick_num::{cos, sin};
    use proptest::prelude::*;

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

    fn unit() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64)
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter("a direction", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize)
    }

    proptest! {
        #[test]
        fn a_bent_rest_turns_with_the_segment_before(b in unit(), r in unit(), d in unit(), e in unit()) {
            prop_assume!(b.dot(d) > -0.8);
            let turned = shortest_arc(b, d) * r;
            prop_assert!((rest_after(b, r, d) - turned).length() < 1e-12);
            let got = bent(b, r, d, e);
            prop_assert!((got.rest - turned).length() < 1e-12);
            prop_assert!((bent(b, b, d, e).by_before - straight(d, e).by_before).length() < 1e-12);
            let second = got.bent.expect("bent");
            // Derivatives by d on the sphere, by e in space.
            let cosine = |d: DVec3, e: DVec3| e.dot(bent(b, r, d, e).rest);
            let (t, h) = (d.any_orthonormal_vector(), 1e-5);
            let moved = |h: f64| d * cos(h) + t * sin(h);
            let numeric = (cosine(moved(h), e) - cosine(moved(-h), e)) / (2.0 * h);
            prop_assert!((numeric - got.by_before.dot(t)).abs() < 1e-8);
            prop_assert!((numeric - 1.001 * got.by_before.dot(t)).abs() > 1e-8 || numeric.abs() < 1e-4);
            let twice = (cosine(moved(h), e) - 2.0 * cosine(d, e) + cosine(moved(-h), e)) / (h * h);
            let curved = t.dot(second.by_before * t) - got.by_before.dot(d);
            prop_assert!((twice - curved).abs() < 1e-4, "{twice} {curved}");
            let mixed = (bent(b, r, moved(h), e).rest - bent(b, r, moved(-h), e).rest) / (2.0 * h);
            prop_assert!((mixed - second.mixed * t).length() < 1e-8);
        }
    }
}
