//! Inner friction of a joint: damping, and the bend that stays.

use glam::DVec3;
use maulstick_num::atan2;

use super::spring::OfCosine;

/// Angle from its anchor at which the friction of a joint yields, rad: hair gives a little before it slides on hair.
pub const YIELD_RAD: f64 = 1e-3;

/// Least sine by which a derivative is divided, near a fold.
const LEAST_SINE: f64 = 0.5 * YIELD_RAD;

/// The inner friction of a joint (Baxter 2004, eq. 3.4 and 3.15) of torque `d`, N·m, between the directions of its
/// segment, `e`, and of its anchor, `w`, as a function of the cosine between them.
///
/// With x the angle θ by s = [`YIELD_RAD`], E = D·s·x²(6 − x²)/8 up to s and D·(θ − 3s/8) beyond it: two derivatives
/// are continuous, and from s on the torque is D. An anchor that [`follows`](follow) at s exerts that torque too, so the
/// same pose, solved again, is the same bend.
#[must_use]
pub fn damping(d: f64, e: DVec3, w: DVec3) -> OfCosine {
    // The chord is exact where the cosine is not.
    let chord2 = (e - w).length_squared();
    if let Some(x2) = within(chord2) {
        let stiffness = d / YIELD_RAD;
        return OfCosine {
            value: d * YIELD_RAD * x2 * (6.0 - x2) / 8.0,
            first: -0.5 * stiffness * (3.0 - x2) * (1.0 + chord2 / 6.0),
            second: stiffness * ((3.0 - x2) / 6.0 - 1.0 / (YIELD_RAD * YIELD_RAD)),
        };
    }
    let (cosine, sine) = (e.dot(w), (chord2 * (1.0 - 0.25 * chord2)).max(0.0).sqrt());
    let angle = arc(chord2, sine, cosine);
    let sine = sine.max(LEAST_SINE);
    OfCosine {
        value: d * (angle - 0.375 * YIELD_RAD),
        first: -d / sine,
        second: -d * cosine / (sine * sine * sine),
    }
}

/// The anchor of a segment of direction `e` after a step that found it at `w`: where the friction has yielded, it
/// follows at [`YIELD_RAD`] on the arc between the two. The element never gives back more than was put in.
#[must_use]
pub fn follow(e: DVec3, w: DVec3) -> DVec3 {
    if within((e - w).length_squared()).is_some() {
        return w;
    }
    let toward = (w - e * e.dot(w)).normalize_or(e.any_orthonormal_vector());
    (e + toward * YIELD_RAD).normalize()
}

/// The square of θ by [`YIELD_RAD`] for a chord² within it.
fn within(chord2: f64) -> Option<f64> {
    let x2 = chord2 * (1.0 + chord2 / 12.0) / (YIELD_RAD * YIELD_RAD);
    (x2 <= 1.0).then_some(x2)
}

/// The angle of a chord, by its series where that is exact.
fn arc(chord2: f64, sine: f64, cosine: f64) -> f64 {
    if chord2 < 1e-2 {
        let series = 1.0 / 24.0 + chord2 * (3.0 / 640.0 + chord2 * (5.0 / 7168.0));
        chord2.sqrt() * (1.0 + chord2 * series)
    } else {
        atan2(sine, cosine)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::sin_cos;

    use super::*;

    fn at(angle: f64) -> DVec3 {
        let (sine, cosine) = sin_cos(angle);
        DVec3::new(0.6 * sine, 0.8 * sine, -cosine)
    }

    fn of(angle: f64) -> OfCosine {
        damping(0.5, at(angle), DVec3::NEG_Z)
    }

    #[test]
    fn its_torque_grows_to_its_bound_and_the_derivatives_agree() {
        for decade in -24..=2 {
            let angle = maulstick_num::exp(f64::from(decade) / 2.0);
            let (sine, h) = (sin_cos(angle).0, 1e-4 * angle);
            let (got, up, down) = (of(angle), of(angle + h), of(angle - h));
            let torque = -sine * got.first;
            assert!(torque > 0.0 && torque <= 0.5 * (1.0 + 1e-9), "{angle}");
            let numeric = (up.value - down.value) / (2.0 * h);
            assert!((numeric - torque).abs() < 1e-6 * torque, "{angle}");
            assert!((numeric - 1.001 * torque).abs() > 1e-6 * torque);
            let numeric = (up.first - down.first) / (2.0 * h);
            let second = -sine * got.second;
            let scale = second.abs().max(1e-9 * got.first.abs() / h);
            assert!((numeric - second).abs() < 1e-3 * scale, "{angle}");
            assert!((numeric - 1.01 * second).abs() > 1e-3 * second.abs());
        }
    }

    #[test]
    fn an_anchor_follows_on_the_arc_and_holds_with_the_full_torque() {
        for angle in [2e-3, 0.1, 2.0] {
            let anchor = follow(at(angle), DVec3::NEG_Z);
            let expected = at(angle - 1e-3);
            assert!((anchor - expected).length() < 1e-9, "{angle}");
            let held = damping(0.5, at(angle), anchor);
            assert!((-held.first * 1e-3 - 0.5).abs() < 1e-6);
        }
        assert_eq!(follow(at(0.9e-3), DVec3::NEG_Z), DVec3::NEG_Z);
    }
}
