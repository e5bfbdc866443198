//! The numbers of a cantilever, a buckling spine, a tractrix; properties over random poses.

use glam::{DQuat, DVec3};
use maulstick_brush::solver::{ContactConstraint, Settings, Solution, Solver};
use maulstick_brush::{Spine, SpineShape};
use maulstick_num::geometry::rotation;
use proptest::prelude::*;

fn settle(
    spine: &Spine,
    shape: &mut SpineShape,
    constraints: &mut [ContactConstraint],
) -> Solution {
    let settings = Settings::for_length(spine.length_m());
    Solver::default().solve(spine, shape, constraints, &[], &settings)
}

#[test]
fn a_straight_spine_above_the_surface_stays_straight() {
    let spine = Spine::uniform(0.025, 3, 1.5e-4);
    let mut shape = SpineShape::straight(DVec3::new(0.0, 0.0, 0.03), DQuat::IDENTITY, 3);
    let mut touches = ContactConstraint::on_surface(3);
    let solution = settle(&spine, &mut shape, &mut touches);
    assert!(
        solution.converged && solution.energy.spring < 1e-12,
        "{solution:?}"
    );
    assert!(touches.iter().all(|touch| touch.force_n == 0.0));
}

/// P_cr·L²/EI of a clamped straight spine pressed along its axis: just past the critical load a
/// spine has begun to bow, and its normal force is close to that load.
#[test]
fn buckling_loads() {
    for (joints, critical) in [
        (1, 1.0),
        (2, 1.527_864),
        (3, 1.782_560),
        (5, 2.025_351),
        (10, 2.233_835),
    ] {
        let (length, ei) = (1.0, 1.0);
        let stiffness = vec![ei * joints as f64 / length; joints];
        let spine = Spine {
            lengths_m: vec![length / joints as f64; joints],
            stiffness,
            damping: vec![0.0; joints],
            rest: Vec::new(),
        };
        let down = rotation(DVec3::X, 1e-4);
        let mut shape = SpineShape::straight(DVec3::new(0.0, 0.0, 0.997), down, joints);
        let mut touches = ContactConstraint::on_surface(joints);
        let settings = Settings::for_length(length).with_friction(0.0);
        let solution = Solver::default().solve(&spine, &mut shape, &mut touches, &[], &settings);
        let load = touches[joints - 1].force_n;
        println!("{joints}: {load:.6}, expected {critical}, {solution:?}");
        assert!(solution.converged);
        assert!((load - critical).abs() < 2e-3 * critical);
        assert!(
            (load * 1.02 - critical).abs() > 2e-3 * critical,
            "a fault would pass"
        );
    }
}

/// The tip of a spine of one joint, dragged across, follows the tractrix: a spring about an upright
/// handle presses it down but turns it nowhere, so friction alone leads it.
#[test]
fn a_dragged_spine_follows_the_tractrix() {
    let error = |steps: usize| {
        let height: f64 = 0.5;
        let length = (1.0 + height * height).sqrt();
        let spine = Spine {
            lengths_m: vec![length],
            stiffness: vec![1.0],
            damping: vec![0.0],
            rest: Vec::new(),
        };
        let root = DVec3::new(0.0, 0.0, height);
        let mut shape = SpineShape::straight(root, DQuat::IDENTITY, 1);
        shape.directions[0] = DVec3::new(0.0, 1.0, -height) / length;
        let mut touches = ContactConstraint::on_surface(1);
        let settings = Settings {
            epsilon_m: 1e-7,
            ..Settings::for_length(length)
        };
        let mut solver = Solver::default();
        for step in 0..=steps {
            shape.root.x = 2.0 * step as f64 / steps as f64;
            let solution = solver.solve(&spine, &mut shape, &mut touches, &[], &settings);
            assert!(solution.converged, "{solution:?}");
        }
        (shape.tip(&spine).truncate() - glam::DVec2::new(1.035_972, 0.265_802)).length()
    };
    let (coarse, fine) = (error(200), error(400));
    println!("error at 200 steps {coarse:e}, at 400 steps {fine:e}");
    assert!(fine < 5e-3 && (coarse / fine - 2.0).abs() < 0.2);
}

/// Height of the root in lengths, tilt, azimuth. A handle within half a degree of upright is left
/// out: its head may bow in any direction alike, and the minimum is a ring.
fn pose() -> impl Strategy<Value = (f64, f64, f64)> {
    (0.1..1.1f64, 0.01..1.0f64, -3.1..3.1f64)
}

/// A brush tilted by `tilt` toward the azimuth `azimuth`.
fn tilted(tilt: f64, azimuth: f64) -> DQuat {
    rotation(DVec3::Z, azimuth) * rotation(DVec3::Y, tilt)
}

proptest! {
    #[test]
    fn at_every_solution_the_conditions_of_a_minimum_hold(
        (height, tilt, azimuth) in pose(),
        joints in 1usize..12,
        slide in 0.0..0.3f64,
    ) {
        let length = 0.025;
        let spine = Spine::uniform(length, joints, 1.5e-4);
        let brush = tilted(tilt, azimuth);
        let mut shape = SpineShape::straight(DVec3::new(0.0, 0.0, height * length), brush, joints);
        let mut touches = ContactConstraint::on_surface(joints);
        let first = settle(&spine, &mut shape, &mut touches);
        shape.root.x += slide * length;
        let solution = settle(&spine, &mut shape, &mut touches);
        for solution in [first, solution] {
            prop_assert!(solution.converged, "{solution:?}");
            prop_assert!(solution.residual <= 1e-6 * spine.stiffest());
            prop_assert!(solution.penetration_m <= 1e-6 * length);
        }
        prop_assert!(shape.directions.iter().all(|d| (d.length() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn the_solution_is_the_same_in_every_direction((height, tilt, azimuth) in pose()) {
        let spine = Spine::uniform(0.025, 3, 1.5e-4);
        let tip = |azimuth: f64| {
            let brush = tilted(tilt, azimuth);
            let root = DVec3::new(0.0, 0.0, height * 0.025);
            let mut shape = SpineShape::straight(root, brush, 3);
            let mut touches = ContactConstraint::on_surface(3);
            settle(&spine, &mut shape, &mut touches);
            rotation(DVec3::Z, -azimuth) * shape.tip(&spine)
        };
        prop_assert!((tip(azimuth) - tip(0.0)).length() < 1e-6 * 0.025);
        // And in the plane of the tilt.
        prop_assert!(tip(azimuth).y.abs() < 1e-6 * 0.025);
    }

    #[test]
    fn a_mirrored_stroke_gives_a_mirrored_result((height, tilt, azimuth) in pose(), dx in -0.2..0.2f64) {
        let spine = Spine::uniform(0.025, 5, 1.5e-4);
        let run = |sign: f64| {
            let root = DVec3::new(0.0, 0.0, height * 0.025);
            let mut shape = SpineShape::straight(root, tilted(tilt, sign * azimuth), 5);
            let mut touches = ContactConstraint::on_surface(5);
            for step in 0..4 {
                shape.root += DVec3::new(dx, sign * 0.1, 0.0) * (0.005 * f64::from(step));
                settle(&spine, &mut shape, &mut touches);
            }
            shape.tip(&spine)
        };
        let (one, two) = (run(1.0), run(-1.0));
        prop_assert!((one - two * DVec3::new(1.0, -1.0, 1.0)).length() < 1e-6 * 0.025);
    }
}
