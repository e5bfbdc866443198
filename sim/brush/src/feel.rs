//! The head as the hand feels it: k₁ of Baxter 2004, eq. 8.1, from the solved spines.

use glam::DVec3;
use maulstick_num::geometry::Rigid;

use crate::tuft::{Seat, Tuft};

/// A head less pressed in than this share of its length feels as at rest.
const LEAST_DEPTH: f64 = 0.04;
/// A head that is laid flat counts as this share of its length along the normal.
const LEAST_ALONG: f64 = 0.2;
/// A bent head feels at most this many times as stiff, or as soft, as at rest.
const MOST: f64 = 4.0;

/// What the hand feels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feel {
    /// k₁: the normal force at which the head would be pressed in by its whole length along the
    /// normal, were it as stiff as between its first touch and how it is bent, N.
    pub k1_n: f64,
}

impl Feel {
    /// A head that touches nothing: half of the loads, summed, under which its spines begin to give
    /// way (1/ΣK⁻¹ by the length), for a head is rarely held upright.
    #[must_use]
    pub fn at_rest(tuft: &Tuft, length_m: f64) -> Self {
        let load = |seat: &Seat| {
            let compliance: f64 = seat.spine.stiffness.iter().map(|k| 1.0 / k).sum();
            1.0 / (compliance * length_m)
        };
        Self {
            k1_n: 0.5 * tuft.seats.iter().map(load).sum::<f64>(),
        }
    }

    /// A head that is held at `brush` over the surface z = 0 and presses with `force_n`.
    #[must_use]
    pub fn bent(tuft: &Tuft, length_m: f64, brush: &Rigid, force_n: f64) -> Self {
        let rest = Self::at_rest(tuft, length_m);
        let upright = brush.vector(DVec3::Z).z;
        let along = (upright * length_m).max(LEAST_ALONG * length_m);
        let depth = (along - brush.translation.z) / length_m;
        if depth < LEAST_DEPTH || force_n <= 0.0 {
            return rest;
        }
        // What is solved takes over from what is at rest as the head is pressed in.
        let share = (depth / LEAST_DEPTH - 1.0).min(1.0);
        let bent = force_n * along / (depth * length_m);
        let bent = bent.clamp(rest.k1_n / MOST, MOST * rest.k1_n);
        Self {
            k1_n: rest.k1_n + share * (bent - rest.k1_n),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::BrushFile;

    fn held(depth: f64, length: f64) -> Rigid {
        Rigid {
            translation: DVec3::new(0.0, 0.0, length * (1.0 - depth)),
            ..Rigid::IDENTITY
        }
    }

    #[test]
    fn a_stiffer_head_feels_stiffer_and_a_larger_force_too() {
        let file = BrushFile::library("round").expect("round");
        let (mut tuft, length) = (file.tuft(), file.length_m());
        let soft = Feel::at_rest(&tuft, length);
        assert!((0.1..3.0).contains(&soft.k1_n), "{soft:?}");
        tuft.stiffen(2.0);
        let stiff = Feel::at_rest(&tuft, length);
        assert!((stiff.k1_n / soft.k1_n - 2.0).abs() < 1e-12);
        let pressed = |force| Feel::bent(&tuft, length, &held(0.3, length), force).k1_n;
        assert!((pressed(0.3) - 1.0).abs() < 1e-12, "F·l/d");
        assert!(pressed(0.35) > pressed(0.3));
    }

    #[test]
    fn it_goes_over_from_rest_without_a_jump() {
        let file = BrushFile::library("round").expect("round");
        let (tuft, length) = (file.tuft(), file.length_m());
        let force = |depth: f64| depth * 2.0;
        let feel = |depth: f64| Feel::bent(&tuft, length, &held(depth, length), force(depth)).k1_n;
        let mut last = feel(0.0);
        assert_eq!(last, Feel::at_rest(&tuft, length).k1_n);
        for step in 1..400 {
            let next = feel(f64::from(step) * 1e-3);
            assert!((next - last).abs() < 0.03 * 2.0, "{step}: {last} {next}");
            last = next;
        }
    }
}
