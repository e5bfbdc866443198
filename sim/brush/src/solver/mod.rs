//! The constrained minimum of a spine's energy (Baxter 2004, eq. 3.1 and 3.5), by Newton steps with
//! exact second derivatives, each a small quadratic program.

mod assembly;
mod line_search;
mod newton;

use glam::{DVec2, DVec3};

use crate::qp::{Cholesky, DualSolver};
use crate::spine::{Spine, SpineShape};

/// What a joint's far end has to do with the surface z = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Normal force, N: the multiplier of its constraint, 0 in the air.
    pub force_n: f64,
    /// Where it touched before the brush moved; none if it was in the air.
    pub anchor: Option<DVec2>,
}

/// What the solver is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Coefficient of friction; the normal force is that of the solve before.
    pub friction: f64,
    /// Slip over which friction is rounded off, m.
    pub epsilon_m: f64,
    /// Newton steps at most.
    pub max_iterations: usize,
    /// Converged where ‖∇L‖∞ is below this share of the stiffest spring and the penetration below
    /// this share of the length.
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            friction: 0.25,
            epsilon_m: 2e-6,
            max_iterations: 60,
            tolerance: 1e-9,
        }
    }
}

/// What came of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solution {
    /// Whether the tolerance was reached; if not, the shape is the last good one.
    pub converged: bool,
    /// Newton steps taken.
    pub iterations: usize,
    /// ‖∇L‖∞, N·m.
    pub residual: f64,
    /// Deepest joint below the surface, m.
    pub penetration_m: f64,
    /// Spring energy, J.
    pub spring_j: f64,
    /// Work against friction with the surface, J.
    pub friction_j: f64,
    /// Work against friction in the joints, J.
    pub damping_j: f64,
}

impl Solution {
    /// This solution with the Newton steps of the attempt before it.
    fn after(mut self, attempt: &Self) -> Self {
        self.iterations += attempt.iterations;
        self
    }

    /// Whether the shape may be used: converged, or so nearly that nobody could see the difference.
    fn usable(&self, spine: &Spine) -> bool {
        self.converged
            || (self.residual <= 1e-4 * spine.stiffest()
                && self.penetration_m <= 1e-4 * spine.length_m())
    }
}

/// Solves spine after spine in the same room.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    before: Vec<DVec3>,
    /// The chord of each joint when the step began.
    chords: Vec<DVec3>,
    damped: bool,
    tangents: Vec<[DVec3; 2]>,
    gradient: Vec<f64>,
    hessian: Vec<f64>,
    model: Vec<f64>,
    gap: Vec<f64>,
    /// Derivative of a joint's height by the directions above it; row i is its first 2(i+1).
    rows: Vec<f64>,
    multipliers: Vec<f64>,
    springs: Vec<f64>,
    lambda: Vec<f64>,
    stiff: Vec<f64>,
    newton: Vec<f64>,
    columns: Vec<f64>,
    dual: Vec<f64>,
    rhs: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<DVec3>,
    trial_gap: Vec<f64>,
    factor: Cholesky,
    active_set: DualSolver,
}

/// Energy of a shape.
#[derive(Clone, Copy, Debug, Default)]
struct Energy {
    spring: f64,
    friction: f64,
    damping: f64,
}

impl Energy {
    fn total(self) -> f64 {
        self.spring + self.friction + self.damping
    }
}

impl Solver {
    /// Bends `shape` to the least energy above the plane z = 0, starting from how it is bent, and
    /// writes the normal forces into `touches` (one for each segment's end).
    ///
    /// The normal force in the friction is that of the solve before. A contact that lifts has no
    /// friction after all: the solve is done again without it. Where a leap of the handle leaves the
    /// head so twisted that no minimum is found from there, it is sought from the straight head,
    /// without friction; where that fails too, the head keeps its shape.
    pub fn solve(
        &mut self,
        spine: &Spine,
        shape: &mut SpineShape,
        touches: &mut [Touch],
        settings: &Settings,
    ) -> Solution {
        self.before.clear();
        self.before.extend_from_slice(&shape.directions);
        self.note_chords(shape);
        self.damped = spine.damping.iter().any(|d| *d > 0.0);
        self.multipliers.clear();
        self.multipliers
            .extend(touches.iter().map(|touch| touch.force_n));
        break_symmetry(shape);
        let mut solution = self.minimise(spine, shape, touches, settings);
        while solution.usable(spine) && self.release_lifted(touches) {
            solution = self
                .minimise(spine, shape, touches, settings)
                .after(&solution);
        }
        if !solution.converged {
            shape.directions.fill(shape.base);
            touches.fill(Touch::default());
            self.multipliers.fill(0.0);
            self.damped = false;
            break_symmetry(shape);
            solution = self
                .minimise(spine, shape, touches, settings)
                .after(&solution);
        }
        if !solution.usable(spine) || !shape.directions.iter().all(|d| d.is_finite()) {
            shape.directions.copy_from_slice(&self.before);
            return solution;
        }
        for (i, touch) in touches.iter_mut().enumerate() {
            touch.force_n = if self.touching(i) {
                self.multipliers[i]
            } else {
                0.0
            };
            touch.anchor = self.touching(i).then(|| shape.joint(spine, i).truncate());
        }
        solution
    }

    /// Newton steps until the conditions of a minimum hold.
    fn minimise(
        &mut self,
        spine: &Spine,
        shape: &mut SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> Solution {
        let n = spine.joints();
        let (scale, length) = (spine.stiffest(), spine.length_m());
        let mut solution = Solution::default();
        let mut energy = self.evaluate(spine, shape, touches, settings);
        for iteration in 0..=settings.max_iterations {
            self.curvature(spine, shape);
            self.direction(n, 100.0 * scale / (length * length));
            solution.residual = self.residual(n);
            solution.penetration_m = self.gap.iter().fold(0.0, |worst: f64, gap| worst.max(-gap));
            solution.iterations = iteration;
            solution.converged = solution.residual <= settings.tolerance * scale
                && solution.penetration_m <= settings.tolerance * length;
            if solution.converged || iteration == settings.max_iterations {
                break;
            }
            if !self.line_search(spine, shape, touches, settings, energy) {
                break;
            }
            energy = self.evaluate(spine, shape, touches, settings);
        }
        (solution.spring_j, solution.friction_j) = (energy.spring, energy.friction);
        solution.damping_j = energy.damping;
        solution
    }

    fn note_chords(&mut self, shape: &SpineShape) {
        let mut above = shape.base;
        self.chords.clear();
        for d in &shape.directions {
            self.chords.push(*d - above);
            above = *d;
        }
    }

    /// Whether joint `i` is held by its constraint.
    fn touching(&self, i: usize) -> bool {
        self.multipliers[i] > 0.0
    }

    /// Frees contacts that have lifted; whether there were any.
    fn release_lifted(&self, touches: &mut [Touch]) -> bool {
        let mut any = false;
        for (i, touch) in touches.iter_mut().enumerate() {
            if touch.anchor.is_some() && !self.touching(i) {
                *touch = Touch::default();
                any = true;
            }
        }
        any
    }
}

/// A straight spine pressed along its own axis has no way to bend that is better than another, and
/// no gradient: turn it a little toward the lower right of the surface.
fn break_symmetry(shape: &mut SpineShape) {
    let upright = shape
        .directions
        .iter()
        .all(|d| d.truncate().length_squared() < 1e-10);
    if upright && shape.root.z > 0.0 {
        for (i, d) in shape.directions.iter_mut().enumerate() {
            *d = (*d + DVec3::new(1.0, -1.0, 0.0) * (1e-3 * (i + 1) as f64)).normalize();
        }
    }
}
