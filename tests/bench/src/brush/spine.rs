//! One spine on its stroke: our solver compared with slsqp, pose by pose.
//!
//! Both minimise the same smoothed energy with analytic gradients, slsqp over θ and φ with the heights of the joints as
//! constraints, and begin each pose from our solution of the one before. The excess of our energy over slsqp's is taken
//! under the contacts of our last minimisation.

use std::time::Instant;

use maulstick_brush::energy::friction::Anisotropy;
use maulstick_brush::solver::{ContactConstraint, Settings, Solver};
use maulstick_brush::{Spine, SpineShape};
use maulstick_rig::UserError;

use super::angles::Angles;
use super::stroke::stroke;
use crate::report::{Report, quantile, sorted};

/// A 10 mm round's spine: length (m) and bending stiffness (N·m²).
pub(crate) const LENGTH_M: f64 = 0.025;
const EI: f64 = 2.7e-5;
/// Times that each solves each pose, in turn.
const TURNS: usize = 3;
/// Greatest depth of a valid minimum of the peer, in lengths.
const FEASIBLE: f64 = 1e-9;
/// Spines of the throughput row.
const CROWD: usize = 128;

/// The spine of the benchmarks.
pub(crate) fn spine(joints: usize) -> Spine {
    Spine::uniform(LENGTH_M, joints, EI).damped(0.01)
}

/// Its friction.
pub(crate) fn settings() -> Settings {
    Settings {
        friction_static: 0.32,
        anisotropy: Anisotropy {
            share: 0.3,
            focus: 2.0,
            ..Anisotropy::default()
        },
        ..Settings::for_length(LENGTH_M)
    }
}

/// Both solvers on the poses of a stroke.
#[derive(Default)]
struct Samples {
    /// Times of ours and of slsqp, µs.
    ours: Vec<f64>,
    theirs: Vec<f64>,
    /// Our energy above that of slsqp, as a share, where that is feasible.
    excess: Vec<f64>,
    /// Our residuals, as shares of the stiffest joint.
    residual: Vec<f64>,
    /// Our iterations.
    iterations: Vec<f64>,
    /// Number of poses in contact.
    touching: usize,
}

impl Samples {
    /// Rows of a spine of so many joints on so many poses.
    fn report(self, report: &mut Report, joints: usize, poses: usize) {
        let excess = sorted(self.excess);
        let median = |values: Vec<f64>| quantile(&sorted(values), 0.5);
        let worst = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let solved = excess.len() as f64 / self.ours.len() as f64;
        let in_contact = self.touching as f64 / poses as f64;
        for (name, value, unit) in [
            ("in_contact", in_contact, "of poses"),
            ("energy_excess", quantile(&excess, 0.99), ""),
            ("energy_excess_worst", worst(&excess), ""),
            ("residual", worst(&self.residual), ""),
            ("iterations", median(self.iterations), ""),
            ("slsqp_feasible", solved, "of poses"),
        ] {
            report.row(&format!("spine{joints}.{name}"), value, unit);
        }
        let times = (median(self.ours), median(self.theirs));
        let name = format!("spine{joints}.time");
        report.beside(&name, times.0, "µs", ("slsqp", times.1));
    }
}

/// Both on the poses of a stroke, each from our state at the pose before.
pub(crate) fn beside_slsqp(report: &mut Report, joints: usize) -> Result<(), UserError> {
    let (spine, settings) = (spine(joints), settings());
    let poses = stroke(joints as u64, LENGTH_M);
    let mut solver = Solver::default();
    let mut constraints = ContactConstraint::on_surface(joints);
    let mut shape = SpineShape::straight(poses[0].translation, poses[0].rotation, joints);
    let mut found = Samples::default();
    for pose in &poses {
        shape.carry(pose.translation, pose.rotation);
        let (before, constraints_before) = (shape.clone(), constraints.clone());
        let start: Vec<f64> = before.exact_angles().flatten().collect();
        for _ in 0..TURNS {
            shape.clone_from(&before);
            constraints.clone_from(&constraints_before);
            let clock = Instant::now();
            let solution = solver.solve(&spine, &mut shape, &mut constraints, &[], &settings);
            found.ours.push(clock.elapsed().as_secs_f64() * 1e6);
            if !solution.converged {
                return Err(UserError::failure("a pose of the stroke has no solution"));
            }
            found.residual.push(solution.residual / spine.stiffest());
            found.iterations.push(solution.iterations as f64);
            let last_constraints = solver.last_constraints().to_vec();
            let problem = Angles::new(
                &spine,
                &settings,
                &last_constraints,
                &mut solver,
                before.clone(),
            );
            let clock = Instant::now();
            let minimum = problem.minimise(&start);
            found.theirs.push(clock.elapsed().as_secs_f64() * 1e6);
            let least = problem.energy_of(&shape).total() / spine.stiffest();
            if minimum.penetration <= FEASIBLE {
                found.excess.push(least / minimum.energy - 1.0);
            }
        }
        found.touching += usize::from(constraints.iter().any(ContactConstraint::touches));
    }
    found.report(report, joints, poses.len());
    Ok(())
}

/// Number of three-joint spines that one core sustains at 1 kHz: each on its own stroke, one after the other in one
/// thread, without batching.
pub(crate) fn throughput(report: &mut Report) {
    let (spine, settings) = (spine(3), settings());
    let strokes: Vec<_> = (0..CROWD)
        .map(|seed| stroke(seed as u64, LENGTH_M))
        .collect();
    let begin = |poses: &Vec<_>| {
        let first: &maulstick_num::geometry::Rigid = &poses[0];
        let shape = SpineShape::straight(first.translation, first.rotation, 3);
        (shape, ContactConstraint::on_surface(3))
    };
    let mut spines: Vec<_> = strokes.iter().map(begin).collect();
    let mut solver = Solver::default();
    let mut rates = Vec::new();
    for tick in 0..strokes[0].len() {
        let clock = Instant::now();
        for ((shape, constraints), poses) in spines.iter_mut().zip(&strokes) {
            shape.carry(poses[tick].translation, poses[tick].rotation);
            solver.solve(&spine, shape, constraints, &[], &settings);
        }
        rates.push(1e-3 / clock.elapsed().as_secs_f64() * CROWD as f64);
    }
    report.row("spines_at_1khz", quantile(&sorted(rates), 0.5), "spines");
}
