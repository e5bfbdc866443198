//! The Newton step: a quadratic model made convex, and its multipliers.
//!
//! Few of many constraints bind. The quadratic program has only those that pushed before or would be violated by the
//! step; where its solution violates others they are added, and it is solved again.

use glam::{DMat2, DVec2, DVec3};

use super::{ActiveCandidate, ContactConstraint, QuadraticProgram, Solver};
use crate::blocks::dot;
use crate::spine::Spine;

/// Stiffness of the springs that replace constraints where the model is not convex, by that of the stiffest joint
/// over the square of the length.
const CONSTRAINT_STIFFNESS: f64 = 100.0;
/// Depth of a joint in a half space, by the length, that a step may leave without its constraint.
const SLACK: f64 = 1e-12;

impl Solver {
    /// The Newton step and the multipliers that belong to it.
    ///
    /// Where the Hessian is not convex, the constraints that bind are added to the model as springs:
    /// this changes no solution on them, and makes the model convex where it is convex along them. A
    /// spring that turns out to pull is taken out again.
    pub(super) fn direction(&mut self, spine: &Spine, constraints: &[ContactConstraint]) {
        self.candidates.clear();
        self.program.rows.clear();
        let convex = self
            .program
            .factor
            .factor(&self.model.hessian, spine.joints());
        let length = spine.length_m();
        let spring = if convex {
            0.0
        } else {
            CONSTRAINT_STIFFNESS * spine.stiffest() / (length * length)
        };
        for constraint in 0..constraints.len() {
            let binds = self.multipliers[constraint] > 0.0;
            if binds || (!convex && self.point.gaps[constraint] < 0.0) {
                self.approach(spine, constraints, ActiveCandidate { constraint, spring });
            }
        }
        loop {
            if convex {
                self.program.newton.clear();
                let downhill = self.model.gradient.iter().map(|g| -*g);
                self.program.newton.extend(downhill);
            } else {
                self.stiffen();
            }
            self.program.factor.solve(&mut self.program.newton);
            self.solve_program(spine, constraints);
            let pulls = |i: &usize| self.candidates[*i].spring > 0.0 && self.push(*i) < 0.0;
            let Some(wrong) = (0..self.candidates.len()).find(pulls) else {
                break;
            };
            self.candidates[wrong].spring = 0.0;
        }
        self.multipliers.fill(0.0);
        for (i, candidate) in self.candidates.iter().enumerate() {
            self.multipliers[candidate.constraint] = self.push(i).max(0.0);
        }
    }

    /// Adds a constraint to the program.
    fn approach(
        &mut self,
        spine: &Spine,
        constraints: &[ContactConstraint],
        candidate: ActiveCandidate,
    ) {
        self.candidates.push(candidate);
        let constraint = &constraints[candidate.constraint];
        let segments = self.model.tangents.iter().zip(&spine.lengths_m).enumerate();
        let row = segments.map(|(j, (tangents, length))| {
            if j <= constraint.joint {
                tangents.of(constraint.half_space.normal) * *length
            } else {
                DVec2::ZERO
            }
        });
        self.program.rows.extend(row);
    }

    /// Force of a constraint after the step: its multiplier and its spring.
    fn push(&self, i: usize) -> f64 {
        let candidate = self.candidates[i];
        if candidate.spring == 0.0 {
            return self.program.lambda[i];
        }
        let moved = dot(self.program.row(i, self.step.len()), &self.step);
        self.program.lambda[i] - candidate.spring * (self.point.gaps[candidate.constraint] + moved)
    }

    /// Factors the model with its springs, made convex by a shift of the diagonal if need be.
    fn stiffen(&mut self) {
        let n = self.model.gradient.len();
        let program = &mut self.program;
        program.stiff.clone_from(&self.model.hessian);
        program.newton.clear();
        let downhill = self.model.gradient.iter().map(|g| -*g);
        program.newton.extend(downhill);
        for (candidate, row) in self.candidates.iter().zip(program.rows.chunks_exact(n)) {
            let gap = self.point.gaps[candidate.constraint];
            for j in 0..n {
                let scaled = row[j] * candidate.spring;
                program.newton[j] -= scaled * gap;
                for k in j..n {
                    let block = DMat2::from_cols(scaled * row[k].x, scaled * row[k].y);
                    program.stiff[j * n + k] += block;
                }
            }
        }
        let diagonal = (0..n).map(|j| program.stiff[j * n + j]);
        let scale = diagonal
            .map(|block| block.x_axis.x.abs().max(block.y_axis.y.abs()))
            .fold(1e-30, f64::max);
        let mut shift = 0.0;
        while !program.factor.factor(&program.stiff, n) && shift < 1e9 * scale {
            let larger = if shift == 0.0 {
                1e-6 * scale
            } else {
                4.0 * shift
            };
            let more = DMat2::from_diagonal(DVec2::splat(larger - shift));
            (0..n).for_each(|j| program.stiff[j * n + j] += more);
            shift = larger;
        }
    }

    /// Multipliers and step of the convex model.
    fn solve_program(&mut self, spine: &Spine, constraints: &[ContactConstraint]) {
        self.program.lambda.clear();
        let pushes = self
            .candidates
            .iter()
            .map(|candidate| self.multipliers[candidate.constraint]);
        self.program.lambda.extend(pushes);
        loop {
            let gaps = &self.point.gaps;
            let gaps = self
                .candidates
                .iter()
                .map(|candidate| gaps[candidate.constraint]);
            self.program.solve(gaps);
            self.step.clone_from(&self.program.newton);
            self.program.add_columns(&mut self.step);
            if !self.meet(spine, constraints) {
                break;
            }
        }
    }

    /// Adds the constraints that the step would violate to the program; true if there were any.
    fn meet(&mut self, spine: &Spine, constraints: &[ContactConstraint]) -> bool {
        self.program.moves.clear();
        let mut moved = DVec3::ZERO;
        let segments = self.step.iter().zip(&self.model.tangents);
        for ((step, tangents), length) in segments.zip(&spine.lengths_m) {
            moved += tangents.vector(*step) * *length;
            self.program.moves.push(moved);
        }
        let (slack, known) = (SLACK * spine.length_m(), self.candidates.len());
        for (i, constraint) in constraints.iter().enumerate() {
            let way = constraint
                .half_space
                .normal
                .dot(self.program.moves[constraint.joint]);
            let is_new = || {
                self.candidates[..known]
                    .iter()
                    .all(|candidate| candidate.constraint != i)
            };
            if self.point.gaps[i] + way < -slack && is_new() {
                self.approach(
                    spine,
                    constraints,
                    ActiveCandidate {
                        constraint: i,
                        spring: 0.0,
                    },
                );
                self.program.lambda.push(0.0);
            }
        }
        self.candidates.len() > known
    }
}

impl QuadraticProgram {
    /// The derivative of the gap of constraint `i` by the directions of `n` segments.
    fn row(&self, i: usize, n: usize) -> &[DVec2] {
        &self.rows[i * n..(i + 1) * n]
    }

    /// The multipliers: the columns H⁻¹Aᵀ, G = A·H⁻¹·Aᵀ and r = −(gap + A·newton), and the dual.
    fn solve(&mut self, gaps: impl Iterator<Item = f64>) {
        let n = self.newton.len();
        self.columns.clone_from(&self.rows);
        for column in self.columns.chunks_exact_mut(n) {
            self.factor.solve(column);
        }
        self.dual.clear();
        self.rhs.clear();
        for (row, gap) in self.rows.chunks_exact(n).zip(gaps) {
            let columns = self.columns.chunks_exact(n);
            self.dual.extend(columns.map(|column| dot(row, column)));
            self.rhs.push(-(gap + dot(row, &self.newton)));
        }
        let floor = self.floor();
        self.active_set
            .solve(&self.dual, &self.rhs, floor, &mut self.lambda);
    }

    /// Diagonal term that keeps the dual solvable where constraints depend on each other.
    pub(super) fn floor(&self) -> f64 {
        let n = self.lambda.len();
        1e-12 * (0..n).map(|i| self.dual[i * n + i]).fold(0.0, f64::max)
    }

    /// Adds the columns, weighted by the multipliers, to a step.
    pub(super) fn add_columns(&self, way: &mut [DVec2]) {
        let columns = self.columns.chunks_exact(way.len());
        for (value, column) in self.lambda.iter().zip(columns) {
            if *value != 0.0 {
                let way = way.iter_mut().zip(column);
                way.for_each(|(way, column)| *way += *column * *value);
            }
        }
    }
}
