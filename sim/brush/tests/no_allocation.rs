//! A solve allocates nothing, for one spine and for a whole head.

#[path = "../../num/tests/counting/mod.rs"]
mod counting;

use counting::allocations;
use glam::{DQuat, DVec3};
use maulstick_brush::desk::Obstacle;
use maulstick_brush::head_solver::settings_of;
use maulstick_brush::head_solver::{HeadSolver, SolvedHead};
use maulstick_brush::solver::{ContactConstraint, Settings, Solver};
use maulstick_brush::{BrushFile, Spine, SpineLayout, SpineShape};
use maulstick_num::geometry::{Rigid, rotation};

/// A tilted ferrule that slides, presses and lifts.
fn place(step: usize, length: f64) -> Rigid {
    let t = step as f64 * 0.01;
    Rigid {
        rotation: rotation(DVec3::Y, 0.5 + 0.3 * maulstick_num::sin(9.0 * t)),
        translation: DVec3::new(
            -0.2 * t,
            0.01 * maulstick_num::sin(5.0 * t),
            length * (0.7 + 0.4 * maulstick_num::sin(7.0 * t)),
        ),
    }
}

/// Number of steps of a stroke, the first half of which warms up.
const STEPS: usize = 200;

#[test]
fn a_spine_is_solved_without_allocating() {
    for joints in [1, 3, 10] {
        let spine = Spine::uniform(0.025, joints, 1.5e-4).damped(0.01);
        let settings = Settings::for_length(0.025);
        let mut solver = Solver::default();
        let mut constraints = ContactConstraint::on_surface(joints);
        let mut shape = SpineShape::straight(DVec3::Z, DQuat::IDENTITY, joints);
        let mut touched = 0;
        let mut stroke = |steps: std::ops::Range<usize>| {
            for step in steps {
                let held = place(step, 0.025);
                shape.carry(held.translation, held.rotation);
                let solution = solver.solve(&spine, &mut shape, &mut constraints, &[], &settings);
                assert!(solution.converged, "{solution:?}");
                touched += usize::from(constraints.iter().any(ContactConstraint::touches));
            }
        };
        stroke(0..STEPS / 2);
        assert_eq!(allocations(|| stroke(STEPS / 2..STEPS)), 0, "{joints}");
        let fault = allocations(|| {
            stroke(0..2);
            std::hint::black_box(Vec::<u8>::with_capacity(1));
        });
        assert_eq!(fault, 1, "an allocation would pass");
        assert!((STEPS / 4..STEPS).contains(&touched), "{touched}");
    }
}

#[test]
fn a_head_is_solved_without_allocating() {
    for kind in ["round", "filbert"] {
        let file = BrushFile::library(kind).expect(kind);
        let (tuft, walls) = (SpineLayout::of(&file), [Obstacle::ground()]);
        let (settings, length) = (settings_of(&file, &tuft), file.length_m());
        let mut room = HeadSolver::default();
        let mut head = SolvedHead::at_rest(&tuft, &place(0, length));
        let mut touched = 0;
        let mut stroke = |steps: std::ops::Range<usize>| {
            for step in steps {
                head.solve(&mut room, &tuft, &place(step, length), &walls, &settings);
                touched += usize::from(head.touches());
            }
        };
        stroke(0..STEPS / 2);
        assert_eq!(allocations(|| stroke(STEPS / 2..STEPS)), 0, "{kind}");
        assert!((STEPS / 4..STEPS).contains(&touched), "{touched}");
    }
}
