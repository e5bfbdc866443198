//! Contact of a spine with walls: forces at every solution, sticking, sliding, and the energy's derivatives.

use glam::{DMat3, DVec3};
use maulstick_brush::energy::friction::Anisotropy;
use maulstick_brush::solver::{
    ContactConstraint, HalfSpace, Neighbour, Settings, Solution, Solver,
};
use maulstick_brush::{Spine, SpineShape};
use maulstick_num::geometry::{rotation, shortest_arc};
use maulstick_num::{cos, sin};
use proptest::prelude::*;

const LENGTH: f64 = 0.025;
const EI: f64 = 1.5e-4;

/// A spine on the surface.
struct Bench {
    spine: Spine,
    settings: Settings,
    solver: Solver,
    shape: SpineShape,
    constraints: Vec<ContactConstraint>,
}

impl Bench {
    /// Held at a height (in lengths), tilted so that its point leads toward +x.
    fn new(joints: usize, height: f64, tilt: f64, settings: Settings) -> Self {
        let root = DVec3::new(0.0, 0.0, height * LENGTH);
        let mut bench = Self {
            spine: Spine::uniform(LENGTH, joints, EI),
            settings,
            solver: Solver::default(),
            shape: SpineShape::straight(root, rotation(DVec3::Y, -tilt), joints),
            constraints: ContactConstraint::on_surface(joints),
        };
        bench.to(0.0);
        bench
    }

    /// Slides the ferrule to a place along x (m).
    fn to(&mut self, x: f64) -> Solution {
        self.shape.root.x = x;
        let constraints = &mut self.constraints;
        let solution = self.solver.solve(
            &self.spine,
            &mut self.shape,
            constraints,
            &[],
            &self.settings,
        );
        assert!(solution.converged, "{solution:?}");
        solution
    }

    fn tip(&self) -> DVec3 {
        self.shape.tip(&self.spine)
    }

    /// The force with which the surface acts on the point, from the springs alone: where only the point
    /// touches, the springs' derivative by each direction and the force's moment cancel.
    fn reaction(&mut self) -> DVec3 {
        let free = ContactConstraint::on_surface(self.spine.joints());
        let touching = self
            .constraints
            .iter()
            .filter(|constraint| constraint.touches());
        assert!(
            touching.count() == 1
                && self
                    .constraints
                    .last()
                    .is_some_and(ContactConstraint::touches)
        );
        let (_, slopes) = self
            .solver
            .energy(&self.spine, &self.shape, &free, &[], &self.settings);
        let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
        let segments = slopes.iter().zip(&self.shape.directions);
        for ((slope, d), length) in segments.zip(&self.spine.lengths_m) {
            let across = |v: DVec3| v - *d * d.dot(v);
            let columns = DVec3::AXES.map(|axis| across(axis) * *length * *length);
            matrix += DMat3::from_cols(columns[0], columns[1], columns[2]);
            right += across(*slope) * *length;
        }
        matrix.inverse() * right
    }

    /// Friction divided by normal force at the point.
    fn share(&mut self) -> f64 {
        let force = self.reaction();
        force.truncate().length() / force.z
    }
}

fn settings(friction: f64) -> Settings {
    Settings::for_length(LENGTH).with_friction(friction)
}

#[test]
fn friction_opposes_the_slip_within_its_cone() {
    let mu = 0.25;
    let mut bench = Bench::new(5, 0.8, 0.5, settings(mu));
    let mut share = 0.0;
    for step in 1..=300 {
        let before = bench.tip();
        bench.shape.root.y = 2e-3 * sin(f64::from(step) * 0.02);
        let solution = bench.to(f64::from(step) * -1e-4);
        let (slip, force) = (bench.tip() - before, bench.reaction());
        let last_constraints = bench.solver.last_constraints()[4];
        // Friction is that of the normal force before the step.
        let bound = mu * last_constraints.force_n;
        let along = force.truncate();
        assert!(
            along.length() <= bound * (1.0 + 1e-6),
            "{step}: {solution:?}"
        );
        assert!((force.z - bench.constraints[4].force_n).abs() < 1e-6 * force.z);
        if step > 1 && slip.length() > 1e-5 {
            let cosine = -along.normalize().dot(slip.truncate().normalize());
            assert!(cosine > 0.9999, "{step}: {cosine}");
            assert!(along.length() > 0.99 * bound, "a faulty cone would pass");
        }
        share = bench.share();
    }
    assert!((share - mu).abs() < 1e-3, "steady sliding: {share}");
}

/// The point of a spine is dragged this way and that, in short steps and in long ones: friction is that
/// of the normal force of its own pose, and a point that continues touching always has it.
#[test]
fn friction_has_the_normal_force_of_its_own_pose() {
    let mu = 0.25;
    for length in [0.002, 0.02, 0.1, 0.3] {
        let mut bench = Bench::new(5, 0.8, 0.5, settings(mu));
        let (mut slid, mut off, mut faulty) = (0, 0, 0);
        let mut touched = false;
        for step in 1..=400 {
            let turn = 2.4 * f64::from(step / 7);
            let (before, way) = (bench.tip(), length * LENGTH);
            let height = 0.8 + 0.1 * sin(0.9 * f64::from(step));
            bench.shape.root += DVec3::new(cos(turn), sin(turn), 0.0) * way;
            bench.shape.root.z = height * LENGTH;
            bench.to(bench.shape.root.x);
            let constraints = &bench.constraints;
            let only = constraints[4].touches()
                && !constraints[..4].iter().any(ContactConstraint::touches);
            if !only {
                touched = false;
                continue;
            }
            let share = bench.share();
            let slip = (bench.tip() - before).length();
            if touched && slip > 20.0 * bench.settings.epsilon_m {
                slid += 1;
                let differs = |mu: f64| i32::from((share / mu - 1.0).abs() > 0.01);
                off += differs(mu);
                faulty += differs(1.02 * mu);
            }
            touched = true;
        }
        println!("steps of {length} L: {off} of {slid} off");
        assert!(slid > 200 && off == 0, "{length}: {off} of {slid}");
        assert_eq!(faulty, slid, "a fault would pass");
    }
}

#[test]
fn a_contact_holds_to_the_static_bound_and_slides_with_the_kinetic_one() {
    let (kinetic, sticking) = (0.2, 0.4);
    let settings = Settings {
        friction_static: sticking,
        ..settings(kinetic)
    };
    let mut bench = Bench::new(3, 0.8, 0.5, settings);
    let mut x = 0.0;
    for way in [-1.0, 1.0, -1.0] {
        // Steps of less than the rounding: it holds.
        let mut held = 0.0;
        let mut steps = 0;
        while bench.constraints[2].sticks || steps == 0 {
            held = bench.share().max(held);
            x += way * 1e-6;
            bench.to(x);
            steps += 1;
            assert!(steps < 1000, "it never broke loose: {held}");
        }
        // The bound is that of the normal force before, which rises as it breaks loose.
        let last_constraints = bench.solver.last_constraints()[2].force_n;
        let loose = bench.reaction().truncate().length() / last_constraints;
        // Steps of many times the rounding: it slides on.
        let mut slid = 0.0;
        for _ in 0..40 {
            x += way * 5e-5;
            bench.to(x);
            slid = bench.share();
        }
        println!("{steps} steps: held to {held:.4}, loose at {loose:.4}, slid at {slid:.4}");
        assert!((held - sticking).abs() < 0.02 * sticking, "{held}");
        assert!((loose - kinetic).abs() < 0.01 * kinetic, "{loose}");
        assert!((slid - kinetic).abs() < 0.01 * kinetic, "{slid}");
        // It stands still, and sticks where it is.
        bench.to(x);
        bench.to(x);
        assert!(bench.constraints[2].sticks);
    }
}

#[test]
fn a_pushed_bristle_drags_more_than_a_pulled_one() {
    let settings = Settings {
        anisotropy: Anisotropy {
            share: 0.4,
            focus: 2.0,
            ..Anisotropy::default()
        },
        ..settings(0.25)
    };
    let drag = |way: f64, settings: Settings| {
        let mut bench = Bench::new(3, 0.85, 0.5, settings);
        for step in 1..=30 {
            bench.to(f64::from(step) * way * 5e-5);
        }
        bench.share()
    };
    let (pulled, pushed) = (drag(-1.0, settings), drag(1.0, settings));
    println!("pulled {pulled:.4}, pushed {pushed:.4}");
    assert!((pulled - 0.6 * 0.25).abs() < 2e-3 && (pushed - 0.25).abs() < 2e-3);
    let even = Settings {
        anisotropy: Anisotropy::default(),
        ..settings
    };
    let fault = drag(-1.0, even) - drag(1.0, even);
    assert!(
        fault.abs() < 2e-3,
        "without anisotropy both drag alike: {fault}"
    );
}

#[test]
fn a_wall_beside_the_surface_holds_the_spine_out() {
    let solve = |wall: Option<HalfSpace>| {
        let mut bench = Bench::new(4, 1.2, 0.5, settings(0.25));
        if let Some(wall) = wall {
            bench
                .constraints
                .extend((0..4).map(|joint| ContactConstraint::new(joint, wall)));
        }
        for step in 0..=40 {
            bench.shape.root.z = (1.2 - 0.015 * f64::from(step)) * LENGTH;
            bench.to(0.0);
        }
        let pushed: f64 = bench.constraints[4..]
            .iter()
            .map(|constraint| constraint.force_n)
            .sum();
        (bench.tip(), pushed)
    };
    let (free, _) = solve(None);
    let wall = HalfSpace {
        normal: DVec3::NEG_X,
        offset_m: -(free.x - 2e-3),
    };
    let (held, pushed) = solve(Some(wall));
    assert!(wall.gap(free) < -1e-3, "it would go through");
    assert!(
        wall.gap(held) > -1e-6 * LENGTH && held.z > -1e-6 * LENGTH,
        "{held}"
    );
    assert!(pushed > 0.0);
}

#[test]
fn spines_of_one_joint_and_of_64_follow_a_stroke() {
    for joints in [1, 64] {
        let mut bench = Bench::new(joints, 0.8, 0.6, settings(0.25));
        for step in 1..=60 {
            let t = f64::from(step) * 0.05;
            bench.shape.root.z = LENGTH * (0.65 - 0.15 * sin(3.0 * t));
            bench.shape.root.y = 2e-3 * sin(t);
            let solution = bench.to(-2e-3 * t);
            assert!(
                solution.residual <= 1e-6 * bench.spine.stiffest(),
                "{joints}: {solution:?}"
            );
            assert!(
                solution.penetration_m <= 1e-6 * LENGTH,
                "{joints}: {solution:?}"
            );
            assert!(
                bench.constraints.iter().any(ContactConstraint::touches),
                "{joints}"
            );
        }
    }
}

proptest! {
    #[test]
    fn the_energy_is_never_above_that_of_the_start(
        (height, tilt) in (0.4..0.9f64, 0.2..0.8f64),
        (dx, dy, dz) in (-0.02..0.02f64, -0.02..0.02f64, -0.01..0.03f64),
        turn in -0.1..0.1f64,
    ) {
        let mut bench = Bench::new(4, height, tilt, settings(0.25));
        bench.to(-1e-4);
        let root = bench.shape.root + DVec3::new(dx, dy, dz) * LENGTH;
        let frame = rotation(DVec3::X, turn) * bench.shape.frame;
        bench.shape.carry(root, frame);
        let before = bench.shape.clone();
        let solution = bench.to(root.x);
        let last_constraints = bench.solver.last_constraints().to_vec();
        let none = bench.settings;
        let (start, _) = bench.solver.energy(&bench.spine, &before, &last_constraints, &[], &none);
        let feasible = (0..4).all(|joint| before.joint(&bench.spine, joint).z >= 0.0);
        if feasible {
            prop_assert!(solution.energy.total() <= start.total() * (1.0 + 1e-12));
        }
    }
}

/// A spine that is bent at rest and damped, dragged over the surface along a wall and past another
/// spine: all energies are on.
#[test]
fn the_energys_derivatives_agree_with_differences() {
    let rest = [0.1, 0.3, 0.6, 0.8].map(|a| DVec3::new(sin(a), 0.0, -cos(a)));
    let spine = Spine::uniform(0.9, 4, 1.0).resting(&rest).damped(0.2);
    let frame = rotation(DVec3::new(0.6, 0.8, 0.0), 0.5);
    let begun = SpineShape::at_rest(DVec3::new(0.1, -0.2, 0.6), frame, &spine);
    let mut shape = begun.clone();
    for (i, d) in shape.directions.iter_mut().enumerate() {
        let turn = rotation(DVec3::new(0.36, 0.48, 0.8), 0.2 + 0.1 * i as f64);
        *d = turn * *d;
    }
    let beside = HalfSpace {
        normal: DVec3::NEG_Y,
        offset_m: -0.5,
    };
    let mut constraints = ContactConstraint::on_surface(4);
    constraints.push(ContactConstraint::new(3, beside));
    for constraint in &mut constraints {
        constraint.update_preferred(&spine, &shape);
        constraint.force_n = 0.3 + 0.1 * constraint.joint as f64;
        let at = shape.joint(&spine, constraint.joint);
        constraint.anchor = Some(at + DVec3::new(-0.03, 0.02, 0.01));
    }
    constraints[1].sticks = true;
    let neighbours = [1, 3].map(|joint| Neighbour {
        joint,
        at: shape.joint(&spine, joint) + DVec3::new(0.02, 0.03, -0.01),
        at_rest_m: 0.06,
    });
    let settings = Settings {
        friction: 0.3,
        friction_static: 0.5,
        anisotropy: Anisotropy {
            share: 0.4,
            focus: 2.5,
            ..Anisotropy::default()
        },
        epsilon_m: 1e-2,
        repulsion_n_m: 30.0,
        ..Settings::for_length(0.9)
    };
    let mut solver = Solver::default();
    solver.begin(&spine, &begun);
    let (energy, slopes) = solver.energy(&spine, &shape, &constraints, &neighbours, &settings);
    let slopes = slopes.to_vec();
    let parts = [
        energy.spring,
        energy.friction,
        energy.damping,
        energy.repulsion,
    ];
    assert!(parts.iter().all(|part| *part > 1e-4), "{energy:?}");
    for (i, slope) in slopes.iter().enumerate() {
        let (s, t) = shape.directions[i].any_orthonormal_pair();
        for tangent in [s, t, (s + t).normalize()] {
            let mut moved = |h: f64| {
                let mut shape = shape.clone();
                let d = shape.directions[i];
                shape.directions[i] = shortest_arc(d, (d + tangent * h).normalize()) * d;
                let (energy, _) =
                    solver.energy(&spine, &shape, &constraints, &neighbours, &settings);
                energy.total()
            };
            let numeric = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let analytic = slope.dot(tangent);
            assert!(
                (numeric - analytic).abs() < 1e-6,
                "{i}: {numeric} {analytic}"
            );
            let fault = numeric - 1.001 * analytic - 1e-5;
            assert!(fault.abs() > 1e-6, "a fault would pass");
        }
    }
}

/// A root so deep that no joint can come out: the spine keeps its bend, its contacts and its anchors,
/// says that it did not converge, and continues from there at the next pose that can be.
#[test]
fn what_cannot_be_keeps_the_last_good_state() {
    let length = 0.025;
    let spine = Spine::uniform(length, 3, 1.5e-4);
    let settings = Settings::for_length(length);
    let mut solver = Solver::default();
    let tilt = maulstick_num::geometry::rotation(DVec3::Y, 0.3);
    let mut shape = SpineShape::straight(DVec3::new(0.0, 0.0, 0.6 * length), tilt, 3);
    let mut constraints = ContactConstraint::on_surface(3);
    for _ in 0..2 {
        assert!(
            solver
                .solve(&spine, &mut shape, &mut constraints, &[], &settings)
                .converged
        );
    }
    let (good, held) = (shape.directions.clone(), constraints.clone());
    assert!(held.iter().any(ContactConstraint::touches));
    for depth in [1.1, 5.0, 1e6] {
        shape.root.z = -depth * length;
        let solution = solver.solve(&spine, &mut shape, &mut constraints, &[], &settings);
        assert!(!solution.converged);
        let numbers = [
            solution.residual,
            solution.penetration_m,
            solution.energy.total(),
        ];
        assert!(
            numbers.iter().all(|number| number.is_finite()),
            "{solution:?}"
        );
        assert!((solution.penetration_m / (depth * length) - 1.0).abs() < 1.0);
        assert_eq!((&shape.directions, &constraints), (&good, &held));
    }
    shape.root.z = 0.6 * length;
    assert!(
        solver
            .solve(&spine, &mut shape, &mut constraints, &[], &settings)
            .converged
    );
    assert!((shape.directions[2] - good[2]).length() < 1e-6);
}
