//! The Newton step: a quadratic model made convex, and its multipliers.

use super::Solver;

impl Solver {
    /// The Newton step and the multipliers that belong to it.
    ///
    /// Where the Hessian is not convex, the constraints that bind are added to the model as springs
    /// of `stiffness`: this changes no solution on them, and makes the model convex where it is
    /// convex along them. A spring that turns out to pull is taken out again.
    pub(super) fn direction(&mut self, n: usize, stiffness: f64) {
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
    pub(super) fn push(&self, i: usize) -> f64 {
        let moved: f64 = (0..2 * (i + 1)).map(|p| self.rows[p] * self.step[p]).sum();
        self.lambda[i] - self.springs[i] * (self.gap[i] + moved)
    }

    /// Factors the model with its springs, made convex by a shift of the diagonal if need be.
    pub(super) fn factor_with_springs(&mut self, n: usize) {
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
    pub(super) fn solve_dual(&mut self, n: usize) {
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
    pub(super) fn floor(&self, n: usize) -> f64 {
        1e-12 * (0..n).map(|i| self.dual[i * n + i]).fold(0.0, f64::max)
    }

    /// ‖∇E − Aᵀλ‖∞ with the multipliers of the newest step.
    pub(super) fn residual(&self, n: usize) -> f64 {
        (0..2 * n)
            .map(|p| {
                let push: f64 = (p / 2..n).map(|i| self.multipliers[i] * self.rows[p]).sum();
                (self.gradient[p] - push).abs()
            })
            .fold(0.0, f64::max)
    }
}
