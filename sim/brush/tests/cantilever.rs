//! A clamped spine with a dead load at its tip: a wall without friction that holds the tip aside pushes it along its
//! normal, whatever the spine's shape, with the multiplier of its constraint.

use glam::{DQuat, DVec3};
use maulstick_brush::solver::{ContactConstraint, HalfSpace, Settings, Solver};
use maulstick_brush::{Spine, SpineShape};

/// Position of the tip of a spine of length 1 and EI 1 pushed aside by `offset` along `normal`, and the load that
/// this takes.
fn held(spine: &Spine, normal: DVec3, offset: f64) -> (DVec3, f64) {
    let joints = spine.joints();
    let mut shape = SpineShape::straight(DVec3::ZERO, DQuat::IDENTITY, joints);
    // The root is not above z = 0: the solver turns nothing to break a symmetry that is none.
    let settings = Settings::for_length(1.0).with_friction(0.0);
    let mut constraints = vec![ContactConstraint::new(
        joints - 1,
        HalfSpace {
            normal,
            offset_m: 0.0,
        },
    )];
    for part in 1..=4 {
        constraints[0].half_space.offset_m = offset * f64::from(part) / 4.0;
        let solution = Solver::default().solve(spine, &mut shape, &mut constraints, &[], &settings);
        assert!(solution.converged, "{solution:?}");
    }
    (shape.tip(spine), constraints[0].force_n)
}

/// The tip under the load `a`, by false position between offsets that bracket it.
fn loaded(spine: &Spine, normal: DVec3, a: f64) -> DVec3 {
    let (mut low, mut high) = (1e-3, 0.9);
    let excess = |offset: f64| held(spine, normal, offset).1 - a;
    assert!(excess(low) < 0.0 && excess(high) > 0.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if excess(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    held(spine, normal, low).0
}

#[test]
fn chains_of_doubled_base_deflect_as_computed() {
    for (joints, expected) in [(3, 0.317_409), (5, 0.307_378), (10, 0.303_136)] {
        let spine = Spine::uniform(1.0, joints, 1.0);
        let deflection = loaded(&spine, DVec3::X, 1.0).x;
        println!("{joints}: {deflection:.6}, expected {expected}");
        assert!((deflection - expected).abs() < 1e-5);
        let mut plain = spine;
        plain.stiffness[0] *= 0.5;
        let fault = loaded(&plain, DVec3::X, 1.0).x;
        assert!((fault - expected).abs() > 1e-2, "a single base would pass");
    }
    let mut plain = Spine::uniform(1.0, 3, 1.0);
    plain.stiffness[0] *= 0.5;
    let soft = loaded(&plain, DVec3::X, 1.0).x;
    assert!((soft - 0.437).abs() < 1e-3, "far too soft: {soft}");
}

/// δ/L of the continuum, a = P·L²/EI.
#[test]
fn chains_converge_to_the_beam_with_second_order() {
    let beam = [
        (0.1, 0.033_295),
        (0.5, 0.162_144),
        (1.0, 0.301_721),
        (2.0, 0.493_457),
        (3.0, 0.603_253),
    ];
    for (a, expected) in beam {
        let error = |joints: usize| {
            let spine = Spine::uniform(1.0, joints, 1.0);
            loaded(&spine, DVec3::X, a).x - expected
        };
        let (coarse, fine) = (error(8), error(16));
        let order = maulstick_num::ln(coarse / fine) / std::f64::consts::LN_2;
        println!("a = {a}: errors {coarse:e}, {fine:e}, order {order:.2}");
        assert!((1.9..2.1).contains(&order) && fine > 0.0);
    }
    let fine = loaded(&Spine::uniform(1.0, 64, 1.0), DVec3::X, 1.0).x;
    assert!((fine - 0.301_721).abs() < 5e-5, "64 joints: {fine}");
}

#[test]
fn a_spine_bends_alike_in_every_direction() {
    let spine = Spine::uniform(1.0, 3, 1.0);
    for step in 0..12 {
        let turn = f64::from(step) * std::f64::consts::PI / 12.0;
        let (sine, cosine) = maulstick_num::sin_cos(turn);
        let normal = DVec3::new(cosine, sine, 0.0);
        let tip = loaded(&spine, normal, 10.0);
        let aside = tip.dot(DVec3::new(-sine, cosine, 0.0));
        assert!((tip.dot(normal) - 0.857_822).abs() < 1e-6, "{turn}: {tip}");
        assert!(aside.abs() < 1e-6, "{turn}: {aside}");
        // As ½·K·(θ² + φ²) would have it at 45°.
        assert!(
            (tip.dot(normal) - 0.847_38).abs() > 1e-6,
            "a fault would pass"
        );
    }
}
