//! The constrained minimum of a spine's energy (Baxter 2004, eq. 3.1 and 3.5), by Newton steps with
//! exact second derivatives, each a small quadratic program.

use glam::{DVec2, DVec3};

use crate::energy::{friction, spring};
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
    /// Work against friction, J.
    pub friction_j: f64,
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
}

impl Energy {
    fn total(self) -> f64 {
        self.spring + self.friction
    }
}

/// A step turns no segment by more than this, rad.
const LONGEST_TURN: f64 = 0.7;

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
        solution
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

    /// Gaps, gradient and Hessian of the energy at `shape`.
    fn evaluate(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> Energy {
        let n = spine.joints();
        let size = 2 * n;
        self.tangents.clear();
        self.tangents.extend(shape.directions.iter().map(|d| {
            let (s, t) = d.any_orthonormal_pair();
            [s, t]
        }));
        self.gradient.clear();
        self.gradient.resize(size, 0.0);
        self.hessian.clear();
        self.hessian.resize(size * size, 0.0);
        self.rows.clear();
        self.gap.clear();
        let mut energy = Energy::default();
        let mut height = shape.root.z;
        for (i, d) in shape.directions.iter().enumerate() {
            let above = if i == 0 {
                shape.base
            } else {
                shape.directions[i - 1]
            };
            let f = spring(spine.stiffness[i], above, *d);
            energy.spring += f.value;
            let own = self.tangents[i].map(|t| t.dot(above));
            self.add_spring(2 * i, own, f, above.dot(*d));
            if i > 0 {
                let other = self.tangents[i - 1].map(|t| t.dot(*d));
                self.add_spring(2 * (i - 1), other, f, above.dot(*d));
                for (a, ta) in self.tangents[i - 1].into_iter().enumerate() {
                    for (b, tb) in self.tangents[i].into_iter().enumerate() {
                        let value = f.second * other[a] * own[b] + f.first * ta.dot(tb);
                        let (p, q) = (2 * (i - 1) + a, 2 * i + b);
                        self.hessian[p * size + q] += value;
                        self.hessian[q * size + p] += value;
                    }
                }
            }
            height += spine.lengths_m[i] * d.z;
            self.gap.push(height);
            self.rows
                .extend(self.tangents[i].map(|t| spine.lengths_m[i] * t.z));
        }
        energy.friction = self.add_friction(spine, shape, touches, settings);
        energy
    }

    /// Adds f(c) with δc = own·u to the gradient and Hessian of one segment.
    fn add_spring(&mut self, at: usize, own: [f64; 2], f: crate::energy::OfCosine, cosine: f64) {
        let size = self.gradient.len();
        for a in 0..2 {
            self.gradient[at + a] += f.first * own[a];
            self.hessian[(at + a) * size + at + a] -= f.first * cosine;
            for b in 0..2 {
                self.hessian[(at + a) * size + at + b] += f.second * own[a] * own[b];
            }
        }
    }

    /// Adds friction, which acts on the ends of segments and so on all segments above them.
    fn add_friction(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> f64 {
        let size = self.gradient.len();
        let mut value = 0.0;
        let (mut force, mut stiffness) = (DVec2::ZERO, [DVec2::ZERO; 2]);
        for j in (0..spine.joints()).rev() {
            if let Some(anchor) = touches[j].anchor {
                let slip = shape.joint(spine, j).truncate() - anchor;
                let f = friction(
                    settings.friction * touches[j].force_n,
                    slip,
                    settings.epsilon_m,
                );
                value += f.value;
                force += f.force;
                stiffness = [stiffness[0] + f.hessian[0], stiffness[1] + f.hessian[1]];
            }
            let length = spine.lengths_m[j];
            let pull = force.extend(0.0);
            for (a, ta) in self.tangents[j].into_iter().enumerate() {
                let p = 2 * j + a;
                self.gradient[p] += length * ta.dot(pull);
                self.hessian[p * size + p] -= length * shape.directions[j].dot(pull);
                let along = stiffness[0] * ta.x + stiffness[1] * ta.y;
                // Contacts at or below j move with every segment k ≤ j.
                for k in 0..=j {
                    for (b, tb) in self.tangents[k].into_iter().enumerate() {
                        let q = 2 * k + b;
                        let coupling = length * spine.lengths_m[k] * along.dot(tb.truncate());
                        self.hessian[p * size + q] += coupling;
                        if k < j {
                            self.hessian[q * size + p] += coupling;
                        }
                    }
                }
            }
        }
        value
    }

    /// Adds the curvature of the constraints: −Σλ_i·∇²gap_i.
    fn curvature(&mut self, spine: &Spine, shape: &SpineShape) {
        let size = self.gradient.len();
        self.model.clear();
        self.model.extend_from_slice(&self.hessian);
        let mut below = 0.0;
        for j in (0..spine.joints()).rev() {
            below += self.multipliers[j];
            let value = below * spine.lengths_m[j] * shape.directions[j].z;
            self.model[2 * j * size + 2 * j] += value;
            self.model[(2 * j + 1) * size + 2 * j + 1] += value;
        }
    }

    /// The Newton step and the multipliers that belong to it.
    ///
    /// Where the Hessian is not convex, the constraints that bind are added to the model as springs
    /// of `stiffness`: this changes no solution on them, and makes the model convex where it is
    /// convex along them. A spring that turns out to pull is taken out again.
    fn direction(&mut self, n: usize, stiffness: f64) {
        let size = 2 * n;
        self.springs.clear();
        self.springs.resize(n, 0.0);
        if !self.factor.factor(&self.model, size) {
            for i in 0..n {
                if self.gap[i] < 0.0 || self.multipliers[i] > 0.0 {
                    self.springs[i] = stiffness;
                }
            }
        }
        loop {
            self.factor_with_springs(n);
            self.solve_dual(n);
            let pulls = |solver: &Self, i: usize| solver.springs[i] > 0.0 && solver.push(i) < 0.0;
            let Some(wrong) = (0..n).find(|i| pulls(self, *i)) else {
                break;
            };
            self.springs[wrong] = 0.0;
        }
        for i in 0..n {
            self.multipliers[i] = self.push(i).max(0.0);
        }
    }

    /// The force with which constraint `i` pushes after the step: its multiplier and its spring.
    fn push(&self, i: usize) -> f64 {
        let moved: f64 = (0..2 * (i + 1)).map(|p| self.rows[p] * self.step[p]).sum();
        self.lambda[i] - self.springs[i] * (self.gap[i] + moved)
    }

    /// Factors the model with its springs, made convex by a shift of the diagonal if need be.
    fn factor_with_springs(&mut self, n: usize) {
        let size = 2 * n;
        self.stiff.clear();
        self.stiff.extend_from_slice(&self.model);
        self.newton.clear();
        self.newton.extend(self.gradient.iter().map(|g| -g));
        for i in (0..n).filter(|i| self.springs[*i] > 0.0) {
            for p in 0..2 * (i + 1) {
                let scaled = self.springs[i] * self.rows[p];
                self.newton[p] -= scaled * self.gap[i];
                for q in 0..2 * (i + 1) {
                    self.stiff[p * size + q] += scaled * self.rows[q];
                }
            }
        }
        let mut shift = 0.0;
        let scale = (0..size)
            .map(|p| self.stiff[p * size + p].abs())
            .fold(1e-30, f64::max);
        while !self.factor.factor(&self.stiff, size) && shift < 1e9 * scale {
            let larger = if shift == 0.0 {
                1e-6 * scale
            } else {
                4.0 * shift
            };
            (0..size).for_each(|p| self.stiff[p * size + p] += larger - shift);
            shift = larger;
        }
        self.factor.solve(&mut self.newton);
    }

    /// Multipliers and step of the convex model.
    fn solve_dual(&mut self, n: usize) {
        let size = 2 * n;
        // Columns of H⁻¹Aᵀ, G = A·H⁻¹·Aᵀ and r = −(gap + A·newton).
        self.columns.clear();
        for i in 0..n {
            let start = self.columns.len();
            self.columns.extend_from_slice(&self.rows[..2 * (i + 1)]);
            self.columns.resize(start + size, 0.0);
            self.factor.solve(&mut self.columns[start..]);
        }
        self.dual.clear();
        self.rhs.clear();
        for i in 0..n {
            for j in 0..n {
                let column = &self.columns[j * size..(j + 1) * size];
                self.dual
                    .push((0..2 * (i + 1)).map(|p| self.rows[p] * column[p]).sum());
            }
            let moved: f64 = (0..2 * (i + 1))
                .map(|p| self.rows[p] * self.newton[p])
                .sum();
            self.rhs.push(-(self.gap[i] + moved));
        }
        self.lambda.clear();
        self.lambda.extend_from_slice(&self.multipliers);
        let floor = self.floor(n);
        self.active_set
            .solve(&self.dual, &self.rhs, floor, &mut self.lambda);
        self.step.clear();
        self.step.extend_from_slice(&self.newton);
        for (i, value) in self.lambda.iter().enumerate() {
            for p in 0..size {
                self.step[p] += value * self.columns[i * size + p];
            }
        }
    }

    /// What keeps the dual solvable where constraints depend on each other.
    fn floor(&self, n: usize) -> f64 {
        1e-12 * (0..n).map(|i| self.dual[i * n + i]).fold(0.0, f64::max)
    }

    /// ‖∇E − Aᵀλ‖∞ with the multipliers of the newest step.
    fn residual(&self, n: usize) -> f64 {
        (0..2 * n)
            .map(|p| {
                let push: f64 = (p / 2..n).map(|i| self.multipliers[i] * self.rows[p]).sum();
                (self.gradient[p] - push).abs()
            })
            .fold(0.0, f64::max)
    }

    /// Goes along the step as far as energy and penetration together fall; false where they do not.
    fn line_search(
        &mut self,
        spine: &Spine,
        shape: &mut SpineShape,
        touches: &[Touch],
        settings: &Settings,
        energy: Energy,
    ) -> bool {
        let price = 2.0 * self.multipliers.iter().copied().fold(0.0, f64::max)
            + spine.stiffest() / spine.length_m();
        let merit = |energy: Energy, gaps: &[f64]| {
            energy.total() + price * gaps.iter().map(|gap| (-gap).max(0.0)).sum::<f64>()
        };
        let start = merit(energy, &self.gap);
        let slope: f64 = self
            .step
            .iter()
            .zip(&self.gradient)
            .map(|(d, g)| d * g)
            .sum::<f64>()
            - price * self.gap.iter().map(|gap| (-gap).max(0.0)).sum::<f64>();
        let turn = self
            .step
            .chunks_exact(2)
            .map(|u| u[0] * u[0] + u[1] * u[1])
            .fold(0.0, f64::max)
            .sqrt();
        let mut fraction = if turn > LONGEST_TURN {
            LONGEST_TURN / turn
        } else {
            1.0
        };
        let noise = 1e-13 * start.abs().max(1e-12);
        for _ in 0..30 {
            self.try_step(shape, fraction, 0.0);
            let tried = self.value(spine, shape, touches, settings);
            if merit(tried, &self.trial_gap) <= start + 1e-4 * fraction * slope.min(0.0) + noise {
                shape.directions.copy_from_slice(&self.trial);
                return true;
            }
            if self.correct(shape, fraction) {
                let tried = self.value(spine, shape, touches, settings);
                if merit(tried, &self.trial_gap) <= start + noise {
                    shape.directions.copy_from_slice(&self.trial);
                    return true;
                }
            }
            fraction *= 0.5;
        }
        false
    }

    /// The shape after a fraction of the step, and of a correction along the constraints' columns.
    fn try_step(&mut self, shape: &SpineShape, fraction: f64, correction: f64) {
        let size = self.step.len();
        let correction_at = |p: usize| {
            (0..size / 2)
                .map(|i| self.lambda[i] * self.columns[i * size + p])
                .sum::<f64>()
        };
        self.trial.clear();
        for (j, d) in shape.directions.iter().enumerate() {
            let mut moved = *d;
            for (a, t) in self.tangents[j].iter().enumerate() {
                let p = 2 * j + a;
                let mut along = fraction * self.step[p];
                if correction != 0.0 {
                    along += correction * correction_at(p);
                }
                moved += *t * along;
            }
            self.trial.push(moved.normalize());
        }
    }

    /// Second-order correction: the surface is curved in the directions, so a straight step leaves
    /// the binding constraints; put the trial back onto them. False where none binds.
    fn correct(&mut self, shape: &SpineShape, fraction: f64) -> bool {
        let n = shape.directions.len();
        self.lambda.clear();
        self.lambda.extend(self.trial_gap.iter().map(|gap| -gap));
        let multipliers = &self.multipliers;
        let binding = (0..n).filter(|i| multipliers[*i] > 0.0);
        if !self
            .active_set
            .solve_equalities(&self.dual, binding, self.floor(n), &mut self.lambda)
        {
            return false;
        }
        self.try_step(shape, fraction, 1.0);
        true
    }

    /// Energy and gaps of the trial.
    fn value(
        &mut self,
        spine: &Spine,
        shape: &SpineShape,
        touches: &[Touch],
        settings: &Settings,
    ) -> Energy {
        let mut energy = Energy::default();
        self.trial_gap.clear();
        let (mut above, mut p) = (shape.base, shape.root);
        for (i, d) in self.trial.iter().enumerate() {
            energy.spring += spring(spine.stiffness[i], above, *d).value;
            p += *d * spine.lengths_m[i];
            self.trial_gap.push(p.z);
            if let Some(anchor) = touches[i].anchor {
                let weight = settings.friction * touches[i].force_n;
                energy.friction +=
                    friction(weight, p.truncate() - anchor, settings.epsilon_m).value;
            }
            above = *d;
        }
        energy
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
