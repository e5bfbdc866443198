//! The energy of a spine as a function of the angles of its joints, for a general optimiser.
//!
//! Unknowns are θ and φ of each joint, R_j = R_{j−1}·R_y(φ_j)·R_x(θ_j) (Baxter 2004, eq. 3.10). An angle about the axis
//! a turns all segments from its joint on: ∂d_k/∂α = a × d_k, so that ∂E/∂α = a · Σ_{k≥j} d_k × ∂E/∂d_k, and the height
//! of the end p_i changes by (a × (p_i − p_{j−1}))·z. Energies are in units of the stiffest spring and heights in units
//! of the length, so that all numbers are of order 1.

use std::cell::RefCell;

use glam::{DMat3, DVec3};
use maulstick_brush::solver::{ContactConstraint, Energy, Settings, Solver};
use maulstick_brush::{Spine, SpineShape};
use maulstick_num::sin_cos;
use slsqp::{Func, StopTols};

/// Height below which a violated constraint counts as met, in lengths: the optimiser has no tolerance for constraints,
/// and would not stop at one violated by rounding.
const LEVEL: f64 = 1e-10;
/// Greatest number of evaluations of the energy.
const EVALUATIONS: usize = 200;
/// Relative change of the energy at which the optimiser stops.
const FTOL: f64 = 1e-10;

/// The problem that a solver of ours has just solved.
pub(crate) struct Angles<'a> {
    spine: &'a Spine,
    settings: &'a Settings,
    constraints: &'a [ContactConstraint],
    at: RefCell<At<'a>>,
}

/// State at the newest angles.
struct At<'a> {
    solver: &'a mut Solver,
    angles: Vec<f64>,
    shape: SpineShape,
    energy: f64,
    ends: Vec<DVec3>,
    /// Axis of each angle.
    axes: Vec<DVec3>,
    gradient: Vec<f64>,
}

/// A minimum.
pub(crate) struct Minimum {
    /// In units of the stiffest spring.
    pub(crate) energy: f64,
    /// Depth of the deepest joint, in lengths.
    pub(crate) penetration: f64,
}

impl<'a> Angles<'a> {
    /// The energy in `shape`'s frame among `stops` on the surface, in the step that `solver` began.
    pub(crate) fn new(
        spine: &'a Spine,
        settings: &'a Settings,
        constraints: &'a [ContactConstraint],
        solver: &'a mut Solver,
        shape: SpineShape,
    ) -> Self {
        let size = 2 * spine.joints();
        let at = At {
            solver,
            angles: vec![f64::NAN; size],
            shape,
            energy: 0.0,
            ends: Vec::new(),
            axes: vec![DVec3::ZERO; size],
            gradient: vec![0.0; size],
        };
        Self {
            spine,
            settings,
            constraints,
            at: RefCell::new(at),
        }
    }

    /// The energy of a shape, J.
    pub(crate) fn energy_of(&self, shape: &SpineShape) -> Energy {
        let solver = &mut self.at.borrow_mut().solver;
        let (energy, _) = solver.energy(self.spine, shape, self.constraints, &[], self.settings);
        energy
    }

    /// Energy and its derivatives.
    pub(crate) fn energy(&self, angles: &[f64], gradient: Option<&mut [f64]>) -> f64 {
        self.go(angles);
        let at = self.at.borrow();
        if let Some(gradient) = gradient {
            gradient.copy_from_slice(&at.gradient);
        }
        at.energy
    }

    /// Depth of a segment's end below the surface, in lengths, and its derivatives.
    pub(crate) fn depth(&self, joint: usize, angles: &[f64], gradient: Option<&mut [f64]>) -> f64 {
        self.go(angles);
        let (at, length) = (self.at.borrow(), self.spine.length_m());
        if let Some(gradient) = gradient {
            gradient.fill(0.0);
            let mut from = at.shape.root;
            for j in 0..=joint {
                let arm = at.ends[joint] - from;
                for p in [2 * j, 2 * j + 1] {
                    gradient[p] = -at.axes[p].cross(arm).z / length;
                }
                from = at.ends[j];
            }
        }
        let depth = -at.ends[joint].z / length;
        if depth.abs() < LEVEL { 0.0 } else { depth }
    }

    /// Evaluates all at angles that are not the newest.
    fn go(&self, angles: &[f64]) {
        let mut at = self.at.borrow_mut();
        let at = &mut *at;
        if at.angles == angles {
            return;
        }
        at.angles.copy_from_slice(angles);
        let brush = DMat3::from_quat(at.shape.frame);
        // The spine's base frame is the brush frame turned half around x.
        let (mut x, mut y, mut z) = (brush.x_axis, -brush.y_axis, -brush.z_axis);
        for (j, angle) in angles.chunks_exact(2).enumerate() {
            let ((st, ct), (sp, cp)) = (sin_cos(angle[0]), sin_cos(angle[1]));
            at.axes[2 * j + 1] = y;
            (x, z) = (x * cp - z * sp, x * sp + z * cp);
            at.axes[2 * j] = x;
            (y, z) = (y * ct + z * st, z * ct - y * st);
            at.shape.directions[j] = z;
        }
        at.shape.joints(self.spine, &mut at.ends);
        let (constraints, settings) = (self.constraints, self.settings);
        let (energy, slopes) = at
            .solver
            .energy(self.spine, &at.shape, constraints, &[], settings);
        let scale = 1.0 / self.spine.stiffest();
        at.energy = energy.total() * scale;
        let mut torque = DVec3::ZERO;
        for (j, slope) in slopes.iter().enumerate().rev() {
            torque += at.shape.directions[j].cross(*slope) * scale;
            for p in [2 * j, 2 * j + 1] {
                at.gradient[p] = at.axes[p].dot(torque);
            }
        }
    }

    /// Runs slsqp from `start`.
    pub(crate) fn minimise(&self, start: &[f64]) -> Minimum {
        // The crate calls constraints as if they were of the objective's type: give both one type.
        let energy = |x: &[f64], g: Option<&mut [f64]>, _: &mut ()| self.energy(x, g);
        let energy: &dyn Func<()> = &energy;
        let depth = |joint: usize| {
            move |x: &[f64], g: Option<&mut [f64]>, _: &mut ()| self.depth(joint, x, g)
        };
        let depths: Vec<_> = (0..self.spine.joints()).map(depth).collect();
        let depths: Vec<&dyn Func<()>> = depths.iter().map(|f| f as &dyn Func<()>).collect();
        let bounds = vec![(f64::NEG_INFINITY, f64::INFINITY); start.len()];
        let stop = StopTols {
            ftol_rel: FTOL,
            ..StopTols::default()
        };
        let found = slsqp::minimize(energy, start, &bounds, &depths, (), EVALUATIONS, Some(stop));
        let angles = match found {
            Ok((_, angles, _)) | Err((_, angles, _)) => angles,
        };
        let deepest = |joint: usize| self.depth(joint, &angles, None);
        Minimum {
            energy: self.energy(&angles, None),
            penetration: (0..self.spine.joints()).map(deepest).fold(0.0, f64::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::spine::{settings, spine};
    use super::*;
    use maulstick_num::geometry::rotation;

    type Function<'a> = Box<dyn Fn(&[f64], Option<&mut [f64]>) -> f64 + 'a>;

    #[test]
    fn the_derivatives_by_the_angles_are_those_of_the_energy() {
        let (spine, settings) = (spine(5), settings());
        let length = spine.length_m();
        let frame = rotation(DVec3::new(0.6, 0.8, 0.0), 0.4);
        let mut constraints = ContactConstraint::on_surface(5);
        let mut shape = SpineShape::straight(DVec3::new(0.0, 0.0, 0.7 * length), frame, 5);
        let mut solver = Solver::default();
        let mut wide = settings;
        wide.epsilon_m = 0.02 * length;
        for x in [0.0, 0.02] {
            shape.root.x = x * length;
            solver.solve(&spine, &mut shape, &mut constraints, &[], &wide);
        }
        let last_constraints = solver.last_constraints().to_vec();
        let start: Vec<f64> = shape.exact_angles().flatten().map(|a| a + 0.03).collect();
        let problem = Angles::new(&spine, &wide, &last_constraints, &mut solver, shape.clone());
        let shape = SpineShape::from_exact_angles(
            shape.root,
            shape.frame,
            start.chunks_exact(2).map(|a| [a[0], a[1]]),
        );
        let energy = problem.energy_of(&shape);
        assert!(energy.friction > 0.0 && energy.damping > 0.0);
        let same = problem.energy(&start, None) * spine.stiffest();
        assert!((same - energy.total()).abs() < 1e-12 * same);
        let all: [Function<'_>; 3] = [
            Box::new(|x, g| problem.energy(x, g)),
            Box::new(|x, g| problem.depth(2, x, g)),
            Box::new(|x, g| problem.depth(4, x, g)),
        ];
        for f in all {
            let mut gradient = vec![0.0; start.len()];
            f(&start, Some(&mut gradient));
            for p in 0..start.len() {
                let moved = |h: f64| {
                    let mut angles = start.clone();
                    angles[p] += h;
                    f(&angles, None)
                };
                let numeric = (moved(1e-5) - moved(-1e-5)) / 2e-5;
                assert!(
                    (numeric - gradient[p]).abs() < 1e-6,
                    "{p}: {numeric} {}",
                    gradient[p]
                );
                assert!(
                    (numeric - 1.001 * gradient[p] - 1e-5).abs() > 1e-6,
                    "a fault would pass"
                );
            }
        }
    }

    #[test]
    fn the_peer_keeps_its_joints_above_the_surface() {
        let (spine, settings) = (spine(3), settings());
        let root = DVec3::new(0.0, 0.0, 0.6 * spine.length_m());
        let shape = SpineShape::straight(root, rotation(DVec3::Y, 0.5), 3);
        let mut solver = Solver::default();
        solver.begin(&spine, &shape);
        let constraints = ContactConstraint::on_surface(3);
        let problem = Angles::new(&spine, &settings, &constraints, &mut solver, shape);
        let minimum = problem.minimise(&[0.0; 6]);
        assert!(minimum.penetration <= LEVEL, "{}", minimum.penetration);
        assert!(
            minimum.energy > 1e-3,
            "pressed, so bent: {}",
            minimum.energy
        );
    }
}
