//! The constrained minimum of a spine's energy (Baxter 2004, eq. 3.1 and 3.5), by Newton steps with
//! exact second derivatives, each a small quadratic program.

mod anchors;
mod assembly;
mod contact_constraint;
mod line_search;
mod newton;

use glam::{DMat2, DMat3, DVec2, DVec3};

use self::anchors::Damper;
pub use self::contact_constraint::{ContactConstraint, HalfSpace};
use crate::blocks::BlockFactor;
use crate::energy::bond::Bond;
use crate::energy::friction::Anisotropy;
use crate::energy::spring::OfCosine;
use crate::qp::DualSolver;
use crate::spine::{Spine, SpineShape};

/// A joint of another spine that repels this one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// The joint of this spine that it repels.
    pub joint: usize,
    /// Position, m.
    pub at: DVec3,
    /// Distance of the two at rest, m.
    pub at_rest_m: f64,
}

/// Greatest number of solves until friction agrees with the normal forces.
const ROUNDS: usize = 16;
/// Normal force, as a share of the stiffest joint's by the length, below which a contact is open.
const LEAST_FORCE: f64 = 1e-5;

/// Direction to the lower right, where the far end of a pen is.
const YIELDS: DVec2 = DVec2::new(
    std::f64::consts::FRAC_1_SQRT_2,
    -std::f64::consts::FRAC_1_SQRT_2,
);

/// Settings of the solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Coefficient of friction while sliding.
    pub friction: f64,
    /// Coefficient of friction while sticking; at least that while sliding.
    pub friction_static: f64,
    /// C_η and k (Baxter 2004, eq. 3.14); the preferred direction is that before the solve.
    pub anisotropy: Anisotropy,
    /// Slip over which friction is rounded off, m.
    pub epsilon_m: f64,
    /// Stiffness against neighbours that come nearer than at rest, N/m.
    pub repulsion_n_m: f64,
    /// Factor on the inner friction of the joints.
    pub damping: f64,
    /// Direction along the surface in which an upright spine gives way, a unit vector.
    pub yields: DVec2,
    /// Greatest number of Newton steps.
    pub max_iterations: usize,
    /// Tolerance of convergence: of ‖∇L‖∞ as a share of the stiffest spring, and of the penetration as a share of the
    /// length.
    pub tolerance: f64,
}

impl Settings {
    /// Settings for a spine of this length: friction is rounded off over 8e-5 of it.
    #[must_use]
    pub fn for_length(length_m: f64) -> Self {
        Self {
            friction: 0.25,
            friction_static: 0.25,
            anisotropy: Anisotropy::default(),
            epsilon_m: 8e-5 * length_m,
            repulsion_n_m: 0.0,
            damping: 1.0,
            yields: YIELDS,
            max_iterations: 60,
            tolerance: 1e-9,
        }
    }

    /// These settings with one coefficient of friction, sticking and sliding.
    #[must_use]
    pub fn with_friction(mut self, friction: f64) -> Self {
        (self.friction, self.friction_static) = (friction, friction);
        self
    }
}

/// Contributions to a spine's energy, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Energy of the springs.
    pub spring: f64,
    /// Work against friction with the half spaces.
    pub friction: f64,
    /// Work against friction in the joints.
    pub damping: f64,
    /// Energy of neighbours pushed aside.
    pub repulsion: f64,
    /// Energy of the bonds with the core of the head.
    pub bond: f64,
}

impl Energy {
    /// Sum of all contributions.
    #[must_use]
    pub fn total(self) -> f64 {
        self.spring + self.friction + self.damping + self.repulsion + self.bond
    }
}

/// Result of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solution {
    /// True if the tolerance was reached; if not, the shape is the last good one.
    pub converged: bool,
    /// Newton steps taken.
    pub iterations: usize,
    /// ‖∇L‖∞, N·m.
    pub residual: f64,
    /// Deepest joint within a half space, m.
    pub penetration_m: f64,
    /// Contributions to the energy.
    pub energy: Energy,
}

impl Solution {
    /// This solution, with the Newton steps of an earlier attempt added.
    fn after(mut self, attempt: &Self) -> Self {
        self.iterations += attempt.iterations;
        self
    }

    /// True if the shape is usable: converged, or with an error that nobody could see.
    fn usable(&self, spine: &Spine) -> bool {
        self.converged
            || (self.residual <= 1e-4 * spine.stiffest()
                && self.penetration_m <= 1e-4 * spine.length_m())
    }
}

/// Solver of spines, with reused buffers.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    before: Vec<DVec3>,
    /// The rotation of each joint that takes the segment before it to its anchor, fixed in a step.
    turns: Vec<DMat3>,
    /// Rest direction of each segment if the one before points along the base; empty if that is straight.
    rest: Vec<DVec3>,
    damped: bool,
    last_constraints: Vec<ContactConstraint>,
    /// The constraints before the solve.
    constraints_before: Vec<ContactConstraint>,
    point: Point,
    multipliers: Vec<f64>,
    model: Model,
    /// The Newton step of each segment, along its tangents.
    step: Vec<DVec2>,
    candidates: Vec<ActiveCandidate>,
    program: QuadraticProgram,
    search: Search,
}

/// Energy and gaps at a shape, and their first derivatives.
#[derive(Clone, Debug, Default)]
struct Point {
    /// Ends of the segments, m.
    ends: Vec<DVec3>,
    bends: Vec<OfCosine>,
    dampers: Vec<Damper>,
    /// Force and stiffness of the loads on each segment's end.
    pulls: Vec<(DVec3, DMat3)>,
    /// Derivative of the energy by each direction, in space.
    slopes: Vec<DVec3>,
    /// Derivative of the Lagrangian by each direction, in space.
    lagrangian: Vec<DVec3>,
    /// Gap of each constraint, m; negative where its joint penetrates.
    gaps: Vec<f64>,
}

/// A basis of the plane in which the direction of a segment can change.
#[derive(Clone, Copy, Debug)]
struct Tangents(DVec3, DVec3);

impl Tangents {
    /// The part of a vector in the plane.
    fn of(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.0.dot(v), self.1.dot(v))
    }

    /// The vector of coordinates in the plane.
    fn vector(&self, u: DVec2) -> DVec3 {
        self.0 * u.x + self.1 * u.y
    }
}

/// The quadratic model of the Lagrangian at a shape, in the tangents of the directions.
#[derive(Clone, Debug, Default)]
struct Model {
    tangents: Vec<Tangents>,
    gradient: Vec<DVec2>,
    /// Blocks of the Hessian by pair of segments, row by row; those on and above the diagonal are used.
    hessian: Vec<DMat2>,
}

/// A constraint that binds, or would be violated by the step without it.
#[derive(Clone, Copy, Debug)]
struct ActiveCandidate {
    constraint: usize,
    /// Stiffness of the spring that replaces it where the model is not convex.
    spring: f64,
}

/// The quadratic program of a step, over the [`ActiveCandidate`]s.
#[derive(Clone, Debug, Default)]
struct QuadraticProgram {
    factor: BlockFactor,
    /// The Hessian with the springs added.
    stiff: Vec<DMat2>,
    /// The unconstrained step.
    newton: Vec<DVec2>,
    /// Displacement of the ends by the step, m.
    moves: Vec<DVec3>,
    /// Derivatives of the gaps, a row a constraint.
    rows: Vec<DVec2>,
    /// H⁻¹ times each row.
    columns: Vec<DVec2>,
    dual: Vec<f64>,
    rhs: Vec<f64>,
    lambda: Vec<f64>,
    active_set: DualSolver,
}

/// Buffers of the line search.
#[derive(Clone, Debug, Default)]
struct Search {
    /// Directions at the beginning of the search.
    from: Vec<DVec3>,
    /// Trial part of the step.
    way: Vec<DVec2>,
}

/// Surroundings in which a spine is solved.
#[derive(Clone, Copy, Debug)]
struct Problem<'a> {
    spine: &'a Spine,
    neighbours: &'a [Neighbour],
    /// Bonds, one a segment, or empty.
    bonds: &'a [Bond],
    settings: &'a Settings,
}

impl Solver {
    /// Bends `shape` to the least energy outside the half spaces of all `stops`, starting from its present bend, and
    /// writes the normal forces into them.
    ///
    /// Friction uses the normal force of the previous solve, and the solve is repeated until the two agree: a contact
    /// that lifts has no friction, and one that breaks loose has sliding friction. A new contact has no friction in
    /// this pose, because it has not slipped yet. A leap of the handle may twist the head so much that no minimum is
    /// found from there: it is then sought from the relaxed head, without friction; where that fails too, the head
    /// keeps its shape.
    pub fn solve(
        &mut self,
        spine: &Spine,
        shape: &mut SpineShape,
        constraints: &mut [ContactConstraint],
        neighbours: &[Neighbour],
        settings: &Settings,
    ) -> Solution {
        self.solve_bound(spine, shape, constraints, (neighbours, &[]), settings)
    }

    /// [`solve`](Self::solve) with bonds of the segments to the core of the head: one a segment, or none.
    pub fn solve_bound(
        &mut self,
        spine: &Spine,
        shape: &mut SpineShape,
        constraints: &mut [ContactConstraint],
        (neighbours, bonds): (&[Neighbour], &[Bond]),
        settings: &Settings,
    ) -> Solution {
        let problem = Problem {
            spine,
            neighbours,
            bonds,
            settings,
        };
        self.before.clear();
        self.before.extend_from_slice(&shape.directions);
        self.constraints_before.clear();
        self.constraints_before.extend_from_slice(constraints);
        self.begin(spine, shape);
        let solution = if is_within_reach(spine, shape, constraints) {
            self.attempt(problem, shape, constraints)
        } else {
            Solution {
                residual: f64::INFINITY,
                ..Solution::default()
            }
        };
        let finite = shape.directions.iter().all(|d| d.is_finite());
        if !solution.usable(spine) || !finite {
            shape.directions.copy_from_slice(&self.before);
            constraints.copy_from_slice(&self.constraints_before);
            return self.kept_shape(problem, shape, constraints, &solution);
        }
        for (i, constraint) in constraints.iter_mut().enumerate() {
            constraint.commit(
                self.multipliers[i],
                self.point.ends[constraint.joint],
                settings,
            );
        }
        self.move_anchors(shape);
        solution
    }

    /// Report of a shape that is reused because no better one was found.
    fn kept_shape(
        &mut self,
        problem: Problem<'_>,
        shape: &SpineShape,
        constraints: &[ContactConstraint],
        attempt: &Solution,
    ) -> Solution {
        self.begin(problem.spine, shape);
        self.multipliers.clear();
        self.multipliers
            .extend(constraints.iter().map(|constraint| constraint.force_n));
        let mut kept = Solution {
            energy: self.look(problem, shape, constraints),
            ..Solution::default()
        };
        self.measure(problem, shape, constraints, &mut kept);
        kept.converged = false;
        kept.after(attempt)
    }

    /// Seeks the minimum from the current bend, and if necessary from the relaxed spine.
    fn attempt(
        &mut self,
        problem: Problem<'_>,
        shape: &mut SpineShape,
        constraints: &mut [ContactConstraint],
    ) -> Solution {
        let (spine, settings) = (problem.spine, problem.settings);
        constraints
            .iter_mut()
            .for_each(|constraint| constraint.update_preferred(spine, shape));
        self.multipliers.clear();
        self.multipliers
            .extend(constraints.iter().map(|constraint| constraint.force_n));
        break_symmetry(spine, shape, settings.yields);
        let mut solution = self.minimise(problem, shape, constraints);
        for _ in 0..ROUNDS {
            if !solution.usable(spine) || !self.update_forces(problem, constraints) {
                break;
            }
            solution = self.minimise(problem, shape, constraints).after(&solution);
        }
        if !solution.usable(spine) {
            shape.relax(spine);
            constraints.iter_mut().for_each(ContactConstraint::clear);
            self.multipliers.fill(0.0);
            self.damped = false;
            break_symmetry(spine, shape, settings.yields);
            solution = self.minimise(problem, shape, constraints).after(&solution);
        }
        solution
    }

    /// The constraints at the end of the newest [`solve`](Self::solve), with the normal forces and anchors of its
    /// friction.
    #[must_use]
    pub fn last_constraints(&self) -> &[ContactConstraint] {
        &self.last_constraints
    }

    /// Energy of a shape in the step that [`begin`](Self::begin) started, with the friction of
    /// `stops`, and its derivative by each direction, in space.
    pub fn energy(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        constraints: &[ContactConstraint],
        neighbours: &[Neighbour],
        settings: &Settings,
    ) -> (Energy, &[DVec3]) {
        let problem = Problem {
            spine,
            neighbours,
            bonds: &[],
            settings,
        };
        let energy = self.look(problem, shape, constraints);
        (energy, &self.point.slopes)
    }

    /// Stores how the anchors lie to the segments before them, and the rest shape of the spine.
    pub fn begin(&mut self, spine: &Spine, shape: &SpineShape) {
        self.damped = spine.damping.iter().any(|d| *d > 0.0);
        self.turn_to_anchors(shape);
        self.rest.clear();
        self.rest
            .extend(spine.rest.iter().map(|rest| shape.frame * *rest));
    }

    /// Newton steps until the conditions of a minimum hold.
    fn minimise(
        &mut self,
        problem: Problem<'_>,
        shape: &mut SpineShape,
        constraints: &[ContactConstraint],
    ) -> Solution {
        self.last_constraints.clear();
        self.last_constraints.extend_from_slice(constraints);
        let most = problem.settings.max_iterations;
        let mut solution = Solution {
            energy: self.look(problem, shape, constraints),
            ..Solution::default()
        };
        self.measure(problem, shape, constraints, &mut solution);
        while !solution.converged && solution.iterations < most {
            self.assemble(problem.spine, shape);
            self.direction(problem.spine, constraints);
            let found = self.line_search(problem, shape, constraints, solution.energy);
            if let Some(energy) = found {
                solution.energy = energy;
                solution.iterations += 1;
            }
            self.measure(problem, shape, constraints, &mut solution);
            if found.is_none() {
                break;
            }
        }
        solution
    }

    /// Checks the conditions of a minimum with the current multipliers.
    fn measure(
        &mut self,
        problem: Problem<'_>,
        shape: &SpineShape,
        constraints: &[ContactConstraint],
        solution: &mut Solution,
    ) {
        let (spine, tolerance) = (problem.spine, problem.settings.tolerance);
        solution.residual = self.residual(spine, shape, constraints);
        let gaps = self.point.gaps.iter();
        solution.penetration_m = gaps.fold(0.0, |worst: f64, gap| worst.max(-gap));
        let pushed = self.point.gaps.iter().zip(&self.multipliers);
        let apart = pushed.map(|(gap, push)| if *push > 0.0 { *gap } else { 0.0 });
        let off = apart.fold(solution.penetration_m, f64::max);
        solution.converged = solution.residual <= tolerance * spine.stiffest()
            && off <= tolerance * spine.length_m();
    }

    /// Updates the normal forces of friction; true if they changed.
    fn update_forces(&self, problem: Problem<'_>, constraints: &mut [ContactConstraint]) -> bool {
        let (spine, settings) = (problem.spine, problem.settings);
        let least_n = LEAST_FORCE * spine.stiffest() / spine.length_m();
        let mut any = false;
        for (i, constraint) in constraints.iter_mut().enumerate() {
            let at = self.point.ends[constraint.joint];
            any |= constraint.update(self.multipliers[i], at, least_n, settings);
        }
        any
    }
}

/// True if every joint can leave its half space.
fn is_within_reach(spine: &Spine, shape: &SpineShape, constraints: &[ContactConstraint]) -> bool {
    constraints.iter().all(|constraint| {
        let root = constraint.half_space.gap(shape.root);
        let reach = || spine.lengths_m[..=constraint.joint].iter().sum::<f64>();
        root >= 0.0 || root + reach() > 0.0
    })
}

/// Turns a straight spine pressed along its own axis a little: it has no preferred direction of bending, and no
/// gradient.
fn break_symmetry(spine: &Spine, shape: &mut SpineShape, yields: DVec2) {
    let upright = spine.rest.is_empty()
        && shape
            .directions
            .iter()
            .all(|d| d.truncate().length_squared() < 1e-10);
    if upright && shape.root.z > 0.0 {
        for (i, d) in shape.directions.iter_mut().enumerate() {
            *d = (*d + yields.extend(0.0) * (1.4e-3 * (i + 1) as f64)).normalize();
        }
    }
}
