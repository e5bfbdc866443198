//! The Newton step: a quadratic model made convex, and its multipliers.

use super::{Solver, Stop};

impl Solver {
    /// The Newton step and the multipliers that belong to it.
    ///
    /// Where the Hessian is not convex, the constraints that bind are added to the model as springs
    /// of `stiffness`: this changes no solution on them, and makes the model convex where it is
    /// convex along them. A spring that turns out to pull is taken out again.
    pub(super) fn direction(&mut self, stops: &[Stop], stiffness: f64) {
        let (n, size) = (stops.len(), self.gradient.len());
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
    pub(super) fn push(&self, i: usize) -> f64 {
        let moved = dot(self.row(i), &self.step);
        self.lambda[i] - self.springs[i] * (self.gap[i] + moved)
    }

    /// The derivative of gap `i` by the directions.
    fn row(&self, i: usize) -> &[f64] {
        let size = self.gradient.len();
        &self.rows[i * size..(i + 1) * size]
    }

    /// Factors the model with its springs, made convex by a shift of the diagonal if need be.
    fn factor_with_springs(&mut self, n: usize) {
        let size = self.gradient.len();
        self.stiff.clear();
        self.stiff.extend_from_slice(&self.model);
        self.newton.clear();
        self.newton.extend(self.gradient.iter().map(|g| -g));
        for i in (0..n).filter(|i| self.springs[*i] > 0.0) {
            let row = &self.rows[i * size..(i + 1) * size];
            for p in 0..size {
                let scaled = self.springs[i] * row[p];
                self.newton[p] -= scaled * self.gap[i];
                for q in 0..size {
                    self.stiff[p * size + q] += scaled * row[q];
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
        let size = self.gradient.len();
        // Columns of H⁻¹Aᵀ, G = A·H⁻¹·Aᵀ and r = −(gap + A·newton).
        self.columns.clear();
        self.columns.extend_from_slice(&self.rows);
        for column in self.columns.chunks_exact_mut(size) {
            self.factor.solve(column);
        }
        self.dual.clear();
        self.rhs.clear();
        for i in 0..n {
            let row = &self.rows[i * size..(i + 1) * size];
            let columns = self.columns.chunks_exact(size);
            self.dual.extend(columns.map(|column| dot(row, column)));
            self.rhs.push(-(self.gap[i] + dot(row, &self.newton)));
        }
        self.lambda.clear();
        self.lambda.extend_from_slice(&self.multipliers);
        let floor = self.floor(n);
        self.active_set
            .solve(&self.dual, &self.rhs, floor, &mut self.lambda);
        self.step.clear();
        self.step.extend_from_slice(&self.newton);
        for (value, column) in self.lambda.iter().zip(self.columns.chunks_exact(size)) {
            if *value != 0.0 {
                let step = self.step.iter_mut().zip(column);
                step.for_each(|(step, column)| *step += value * column);
            }
        }
    }

    /// What keeps the dual solvable where constraints depend on each other.
    pub(super) fn floor(&self, n: usize) -> f64 {
        1e-12 * (0..n).map(|i| self.dual[i * n + i]).fold(0.0, f64::max)
    }

    /// ‖∇E − Aᵀλ‖∞ with the multipliers of the newest step.
    pub(super) fn residual(&self, n: usize) -> f64 {
        let size = self.gradient.len();
        (0..size)
            .map(|p| {
                let push: f64 = (0..n)
                    .map(|i| self.multipliers[i] * self.rows[i * size + p])
                    .sum();
                (self.gradient[p] - push).abs()
            })
            .fold(0.0, f64::max)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
