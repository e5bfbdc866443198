//! The piecewise cubic of Baxter 2004, fig. 8.2: five tuples of depth, force and slope make four
//! segments, compression, buckling, bending and the handle that meets the canvas.
//!
//! Depth is a fraction of l_p. The compressive part is the first two tuples: their force and slopes are multiplied by γ
//! of eq. 8.2 for the current angle of the brush,
//!
//! ```text
//! γ = cos²(2θ)   |θ| < π/4,   else 0
//! ```
//!
//! With the force alone scaled, as in the text, the first segment would overshoot at γ = 0 and come down again. A slope
//! is limited to three times that of its segment's chord (Fritsch and Carlson 1980), so the force never falls with
//! depth, at any angle.

use maulstick_types::haptics::HermiteKnot;

use super::{Normal, Penetration};

/// Greatest number of tuples of a curve.
pub const KNOTS: usize = 5;
/// Greatest slope at the end of a segment as a multiple of its chord's, for a monotone cubic.
const STEEPEST: f64 = 3.0;

/// A tuple of the wire format.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Knot {
    depth: f64,
    force_n: f64,
    slope_n: f64,
}

/// Validated tuples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    knots: [Knot; KNOTS],
    count: usize,
}

/// γ of eq. 8.2 for the cosine of θ, the angle between the plane's normal and the negated direction
/// of the bristles.
#[must_use]
pub fn angle_factor(cosine: f64) -> f64 {
    // cos 2θ, which is positive below 45°.
    let double = 2.0 * cosine * cosine - 1.0;
    if cosine > 0.0 && double > 0.0 {
        double * double
    } else {
        0.0
    }
}

/// A segment of a cubic whose slope is within its bounds.
#[derive(Clone, Copy, Debug)]
struct Segment {
    /// Force at its beginning, N.
    start_n: f64,
    /// Length of the segment, fractions of l_p.
    length: f64,
    /// Slope of its chord and at its two ends, N per fraction.
    chord: f64,
    slopes: [f64; 2],
}

impl Segment {
    /// Segment from `start_n` to the next tuple, with end slopes `from` and `to` where these are below
    /// `most`, N per fraction.
    fn new(start_n: f64, [from, to]: [&Knot; 2], most: f64) -> Self {
        let length = to.depth - from.depth;
        let asked = (to.force_n - from.force_n) / length;
        // As the chord approaches the bound the cubic blends into the chord: no point is steeper than `most`, and the
        // force stays continuous as the bound changes with the angle.
        let straight = if asked < most {
            (2.0 * asked / most - 1.0).max(0.0)
        } else {
            1.0
        };
        let chord = asked.min(most);
        let bounded = |slope: f64| {
            let slope = slope.min(STEEPEST * asked).min(most);
            slope + straight * (chord - slope)
        };
        Self {
            start_n,
            length,
            chord,
            slopes: [bounded(from.slope_n), bounded(to.slope_n)],
        }
    }

    fn end_n(&self) -> f64 {
        self.start_n + self.chord * self.length
    }

    /// Force and slope at the share `t` of its length.
    fn at(&self, t: f64) -> [f64; 2] {
        let ([m0, m1], u) = (self.slopes, 1.0 - t);
        let rise = self.chord * t * t * (3.0 - 2.0 * t) + t * u * (m0 * u - m1 * t);
        let slope = 6.0 * self.chord * t * u + m0 * u * (1.0 - 3.0 * t) + m1 * t * (3.0 * t - 2.0);
        [self.start_n + self.length * rise, slope]
    }
}

impl Curve {
    /// Validates tuples.
    ///
    /// # Errors
    /// The fault: fewer than two or more than five, not from depth 0 and force 0, not in order of depth, a
    /// force that falls, a negative slope, a number that is not finite.
    pub fn new(tuples: &[HermiteKnot]) -> Result<Self, &'static str> {
        if !(2..=KNOTS).contains(&tuples.len()) {
            return Err("a Hermite curve has two to five knots");
        }
        let numbers = |k: &HermiteKnot| [k.depth, k.force_n, k.slope_n];
        if !tuples.iter().flat_map(numbers).all(f64::is_finite) {
            return Err("a Hermite curve's knot is not finite");
        }
        if tuples[0].depth != 0.0 || tuples[0].force_n != 0.0 {
            return Err("a Hermite curve does not begin with no force at no depth");
        }
        if !tuples.windows(2).all(|pair| pair[0].depth < pair[1].depth) {
            return Err("a Hermite curve's knots are not in order of depth");
        }
        let rises = tuples.windows(2).all(|p| p[0].force_n <= p[1].force_n);
        if !rises || tuples.iter().any(|knot| knot.slope_n < 0.0) {
            return Err("a Hermite curve's force falls with depth");
        }
        let mut knots = [Knot::default(); KNOTS];
        for (knot, tuple) in knots.iter_mut().zip(tuples) {
            *knot = Knot {
                depth: tuple.depth,
                force_n: tuple.force_n,
                slope_n: tuple.slope_n,
            };
        }
        Ok(Self {
            knots,
            count: tuples.len(),
        })
    }

    /// Force in contact; its slope is at most `max_stiffness`, N/m.
    #[must_use]
    pub fn normal(&self, penetration: &Penetration, max_stiffness: f64) -> Normal {
        let projected = penetration.projected_m;
        let [force_n, slope] = self.at(
            penetration.depth_m / projected,
            angle_factor(penetration.cosine),
            max_stiffness * projected,
        );
        Normal {
            force_n,
            stiffness_n_m: slope / projected,
        }
    }

    /// Force, N, and slope, N per fraction, at `x` fractions of l_p; `most` bounds the slope.
    fn at(&self, x: f64, gamma: f64, most: f64) -> [f64; 2] {
        let compressed = |place: usize| {
            let share = if place < 2 { gamma } else { 1.0 };
            let knot = &self.knots[place];
            Knot {
                depth: knot.depth,
                force_n: share * knot.force_n,
                slope_n: share * knot.slope_n,
            }
        };
        let mut force = 0.0;
        let mut from = compressed(0);
        for place in 1..self.count {
            let to = compressed(place);
            let segment = Segment::new(force, [&from, &to], most);
            if x < to.depth {
                return segment.at((x - from.depth) / segment.length);
            }
            force = segment.end_n();
            from = to;
        }
        let slope = from.slope_n.min(most);
        [force + slope * (x - from.depth), slope]
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::f64::consts::FRAC_PI_4;

    use maulstick_num::cos;
    use proptest::prelude::*;

    use super::*;

    /// A stiff first touch, buckling, bending, the handle.
    pub(crate) fn tuples() -> Vec<HermiteKnot> {
        [
            [0.0, 0.0, 8.0],
            [0.06, 0.25, 0.6],
            [0.4, 0.42, 0.5],
            [1.0, 0.8, 1.2],
            [1.2, 1.6, 6.0],
        ]
        .map(|[depth, force_n, slope_n]| HermiteKnot {
            depth,
            force_n,
            slope_n,
        })
        .to_vec()
    }

    fn penetration(depth_m: f64, theta: f64) -> Penetration {
        let cosine = cos(theta);
        Penetration {
            depth_m,
            projected_m: 0.025 * cosine.max(0.2),
            cosine,
        }
    }

    #[test]
    fn the_angle_factor_is_that_of_equation_8_2() {
        for (degrees, expected) in [
            (0.0, 1.0),
            (15.0, 0.75),
            (22.5, 0.5),
            (30.0, 0.25),
            (45.0, 0.0),
            (60.0, 0.0),
            (90.0, 0.0),
            (135.0, 0.0),
            (180.0, 0.0),
        ] {
            let factor = angle_factor(cos(f64::to_radians(degrees)));
            println!("{degrees}°: {factor}, expected {expected}");
            assert!((factor - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn it_goes_through_its_tuples_with_their_slopes() {
        let curve = Curve::new(&tuples()).expect("a curve");
        for knot in tuples() {
            let [force, slope] = curve.at(knot.depth, 1.0, f64::INFINITY);
            assert!((force - knot.force_n).abs() < 1e-12, "{knot:?}: {force}");
            assert!((slope - knot.slope_n).abs() < 1e-12, "{knot:?}: {slope}");
        }
        let [force, slope] = curve.at(1.7, 1.0, f64::INFINITY);
        assert!((force - 4.6).abs() < 1e-12 && slope == 6.0, "{force}");
    }

    #[test]
    fn the_second_tuple_has_its_force_by_the_angle_factor_and_the_later_ones_have_theirs() {
        let curve = Curve::new(&tuples()).expect("a curve");
        for degrees in [0.0, 10.0, 20.0, 30.0, 45.0, 60.0] {
            let theta = f64::to_radians(degrees);
            let at = |x: f64| {
                let projected = penetration(0.0, theta).projected_m;
                curve
                    .normal(&penetration(x * projected, theta), f64::INFINITY)
                    .force_n
            };
            let expected = if degrees < 45.0 {
                0.25 * cos(2.0 * theta) * cos(2.0 * theta)
            } else {
                0.0
            };
            println!("{degrees}°: {} N, expected {expected} N", at(0.06));
            assert!((at(0.06) - expected).abs() < 1e-12);
            for knot in &tuples()[2..] {
                assert!((at(knot.depth) - knot.force_n).abs() < 1e-12);
            }
        }
    }

    /// With the force of the second tuple alone scaled, as in the text, the force falls with depth, which the check of
    /// the next test detects.
    #[test]
    fn with_the_slope_left_as_it_is_the_force_would_fall() {
        let from = Knot {
            slope_n: 8.0,
            ..Knot::default()
        };
        let to = Knot {
            depth: 0.06,
            ..Knot::default()
        };
        let t = |i: u32| f64::from(i) / 100.0;
        let plain = |t: f64| {
            let u = 1.0 - t;
            let rise = t * u * (from.slope_n * u - to.slope_n * t);
            (to.depth - from.depth) * rise
        };
        assert!((1..=100).any(|i| plain(t(i)) < plain(t(i - 1)) - 1e-3));
        let bounded = Segment::new(0.0, [&from, &to], f64::INFINITY);
        assert!((1..=100).all(|i| bounded.at(t(i))[0] >= bounded.at(t(i - 1))[0]));
    }

    #[test]
    fn a_device_that_bears_nothing_gets_nothing() {
        let curve = Curve::new(&tuples()).expect("a curve");
        for degrees in [0.0, 20.0, 45.0, 70.0] {
            let normal = curve.normal(&penetration(0.03, f64::to_radians(degrees)), 0.0);
            assert_eq!(normal, Normal::default(), "{degrees}°");
        }
    }

    #[test]
    fn bad_tuples_are_refused() {
        let refused = |change: fn(&mut Vec<HermiteKnot>)| {
            let mut tuples = tuples();
            change(&mut tuples);
            Curve::new(&tuples).is_err()
        };
        assert!(!refused(|_| {}));
        assert!(refused(|t| t.truncate(1)));
        assert!(refused(|t| t.push(t[4].clone())));
        assert!(refused(|t| t[0].depth = 0.01));
        assert!(refused(|t| t[0].force_n = 0.1));
        assert!(refused(|t| t[2].depth = 0.01));
        assert!(refused(|t| t[3].force_n = 0.3));
        assert!(refused(|t| t[1].slope_n = -0.1));
        assert!(refused(|t| t[4].slope_n = f64::NAN));
    }

    proptest! {
        #[test]
        fn the_force_rises_with_depth_at_every_angle_and_never_faster_than_it_may(
            steps in prop::collection::vec((0.01..0.6f64, 0.0..2.0f64, 0.0..20.0f64), 4),
            first in 0.0..20.0f64, theta in 0.0..1.6f64, limit in 20.0..2000.0f64,
        ) {
            let mut tuples = vec![HermiteKnot { depth: 0.0, force_n: 0.0, slope_n: first }];
            for (further, more, slope_n) in steps {
                let last = tuples[tuples.len() - 1].clone();
                tuples.push(HermiteKnot {
                    depth: last.depth + further,
                    force_n: last.force_n + more,
                    slope_n,
                });
            }
            let curve = Curve::new(&tuples).expect("a curve");
            let mut last = 0.0;
            for step in 1..=2000 {
                let depth = f64::from(step) * 2e-5;
                let normal = curve.normal(&penetration(depth, theta), limit);
                prop_assert!(normal.force_n >= last - 1e-12, "{depth}: {last} {}", normal.force_n);
                prop_assert!(normal.force_n <= last + limit * 2e-5 + 1e-12, "{depth}");
                prop_assert!((-1e-9..=limit * (1.0 + 1e-9)).contains(&normal.stiffness_n_m));
                last = normal.force_n;
            }
        }

        #[test]
        fn the_force_goes_with_the_angle_without_a_jump(
            depth in 0.0..0.04f64, theta in 0.0..1.5f64, limit in 20.0..2000.0f64,
        ) {
            let curve = Curve::new(&tuples()).expect("a curve");
            let at = |theta: f64| curve.normal(&penetration(depth, theta), limit).force_n;
            prop_assert!((at(theta + 1e-6) - at(theta)).abs() < 1e-3);
            prop_assert!((at(FRAC_PI_4 - 1e-9) - at(FRAC_PI_4 + 1e-9)).abs() < 1e-6);
        }

        #[test]
        fn the_stiffness_is_the_slope_of_the_force(
            depth in 0.0001..0.04f64, theta in 0.0..1.5f64, limit in 20.0..2000.0f64,
        ) {
            let curve = Curve::new(&tuples()).expect("a curve");
            let at = |depth: f64| curve.normal(&penetration(depth, theta), limit);
            let d = 1e-8;
            let slope = (at(depth + d).force_n - at(depth - d).force_n) / (2.0 * d);
            let told = at(depth).stiffness_n_m;
            // At a tuple itself the difference spans two segments.
            let projected = penetration(depth, theta).projected_m;
            let near = tuples().iter().any(|k| (k.depth * projected - depth).abs() < 2.0 * d);
            prop_assert!(near || (slope - told).abs() < 1e-3 * limit, "{slope} {told}");
        }
    }
}
