//! The quadratic program of one Newton step: min ½dᵀHd + gᵀd subject to A·d + c ≥ 0.
//!
//! Solved through its dual, min ½λᵀGλ − rᵀλ over λ ≥ 0 with G = A·H⁻¹·Aᵀ, by the active-set method
//! of Lawson and Hanson (*Solving Least Squares Problems*, 1974, ch. 23). Sizes are tiny; matrices
//! are dense, row after row.

/// A Cholesky factor L of a symmetric positive definite matrix H = L·Lᵀ.
#[derive(Clone, Debug, Default)]
pub struct Cholesky {
    n: usize,
    l: Vec<f64>,
}

impl Cholesky {
    /// Factors `h` (n×n); false where it is not positive definite.
    pub fn factor(&mut self, h: &[f64], n: usize) -> bool {
        self.n = n;
        self.l.clear();
        self.l.extend_from_slice(&h[..n * n]);
        for i in 0..n {
            for j in 0..=i {
                let (rows_i, rows_j) = (i * n, j * n);
                let mut sum = self.l[rows_i + j];
                for k in 0..j {
                    sum -= self.l[rows_i + k] * self.l[rows_j + k];
                }
                if i == j {
                    if sum.is_nan() || sum <= 0.0 {
                        return false;
                    }
                    self.l[rows_i + i] = sum.sqrt();
                } else {
                    self.l[rows_i + j] = sum / self.l[rows_j + j];
                }
            }
        }
        true
    }

    /// Replaces `x` by H⁻¹·x.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let mut sum = x[i];
            for k in 0..i {
                sum -= self.l[i * n + k] * x[k];
            }
            x[i] = sum / self.l[i * n + i];
        }
        for i in (0..n).rev() {
            let mut sum = x[i];
            for k in i + 1..n {
                sum -= self.l[k * n + i] * x[k];
            }
            x[i] = sum / self.l[i * n + i];
        }
    }
}

/// Buffers of the dual problem.
#[derive(Clone, Debug, Default)]
pub struct DualSolver {
    small: Vec<f64>,
    rhs: Vec<f64>,
    passive: Vec<usize>,
    factor: Cholesky,
}

impl DualSolver {
    /// Solves min ½λᵀGλ − rᵀλ, λ ≥ 0, for `g` (m×m, positive semidefinite). On input `lambda` is a guess of the
    /// active constraints, on output the solution. `floor` is added to the diagonal, which selects the smallest
    /// multipliers where constraints are dependent.
    pub fn solve(&mut self, g: &[f64], r: &[f64], floor: f64, lambda: &mut [f64]) {
        let m = r.len();
        self.passive.clear();
        self.passive.extend((0..m).filter(|i| lambda[*i] > 0.0));
        let scale = (0..m).map(|i| g[i * m + i]).fold(0.0, f64::max) + floor;
        let slack = 1e-13 * r.iter().map(|v| v.abs()).fold(0.0, f64::max);
        // Each pass adds or removes a constraint; more passes than this are not needed.
        for _ in 0..4 * m + 8 {
            self.inner(g, r, floor.max(1e-14 * scale), lambda);
            let steepest = (0..m)
                .filter(|i| !self.passive.contains(i))
                .map(|i| {
                    (
                        i,
                        r[i] - (0..m).map(|j| g[i * m + j] * lambda[j]).sum::<f64>(),
                    )
                })
                .max_by(|a, b| a.1.total_cmp(&b.1));
            match steepest {
                Some((i, slope)) if slope > slack => self.passive.push(i),
                _ => return,
            }
        }
    }

    /// Solves G·x = r over the constraints `chosen` alone; `x` holds r on input and the solution on output, 0
    /// elsewhere. False where none is chosen or they are dependent.
    pub fn solve_equalities(
        &mut self,
        g: &[f64],
        chosen: impl Iterator<Item = usize>,
        floor: f64,
        x: &mut [f64],
    ) -> bool {
        self.passive.clear();
        self.passive.extend(chosen);
        self.gather(g, x, floor);
        let p = self.passive.len();
        if p == 0 || !self.factor.factor(&self.small, p) {
            return false;
        }
        self.factor.solve(&mut self.rhs);
        x.fill(0.0);
        for (&i, value) in self.passive.iter().zip(&self.rhs) {
            x[i] = *value;
        }
        true
    }

    /// Gathers the rows and columns of the passive set.
    fn gather(&mut self, g: &[f64], r: &[f64], floor: f64) {
        let m = r.len();
        self.small.clear();
        self.rhs.clear();
        for &i in &self.passive {
            self.rhs.push(r[i]);
            for &j in &self.passive {
                self.small
                    .push(g[i * m + j] + if i == j { floor } else { 0.0 });
            }
        }
    }

    /// Moves to the minimum over the passive set, dropping those whose multiplier falls to zero.
    fn inner(&mut self, g: &[f64], r: &[f64], floor: f64, lambda: &mut [f64]) {
        let m = r.len();
        loop {
            let p = self.passive.len();
            (0..m)
                .filter(|i| !self.passive.contains(i))
                .for_each(|i| lambda[i] = 0.0);
            if p == 0 {
                return;
            }
            self.gather(g, r, floor);
            if !self.factor.factor(&self.small, p) {
                self.passive.pop();
                continue;
            }
            self.factor.solve(&mut self.rhs);
            let mut step = 1.0f64;
            let mut blocking = None;
            for (place, (&i, target)) in self.passive.iter().zip(&self.rhs).enumerate() {
                if *target <= 0.0 {
                    let fraction = lambda[i] / (lambda[i] - target).max(f64::MIN_POSITIVE);
                    if fraction <= step {
                        (step, blocking) = (fraction, Some(place));
                    }
                }
            }
            for (&i, target) in self.passive.iter().zip(&self.rhs) {
                lambda[i] += step * (target - lambda[i]);
            }
            let Some(place) = blocking else { return };
            lambda[self.passive[place]] = 0.0;
            self.passive.remove(place);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_factor_solves_and_refuses_what_is_indefinite() {
        let mut factor = Cholesky::default();
        assert!(factor.factor(&[4.0, 2.0, 2.0, 3.0], 2));
        let mut x = [8.0, 7.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.25).abs() < 1e-15 && (x[1] - 1.5).abs() < 1e-15);
        assert!(!factor.factor(&[1.0, 2.0, 2.0, 1.0], 2));
        assert!(!factor.factor(&[f64::NAN], 1));
    }

    proptest! {
        #[test]
        fn the_dual_solution_is_optimal(
            b in prop::collection::vec(-1.0..1.0f64, 30),
            r in prop::collection::vec(-1.0..1.0f64, 5),
            guess in prop::collection::vec(0.0..1.0f64, 5),
        ) {
            let m = 5;
            let mut g = vec![0.0; 25];
            for i in 0..m {
                for j in 0..m {
                    g[i * m + j] = (0..6).map(|k| b[i * 6 + k] * b[j * 6 + k]).sum();
                }
                g[i * m + i] += 0.01;
            }
            let mut lambda = guess;
            lambda[2] = 0.0;
            DualSolver::default().solve(&g, &r, 0.0, &mut lambda);
            for i in 0..m {
                let slope: f64 = r[i] - (0..m).map(|j| g[i * m + j] * lambda[j]).sum::<f64>();
                prop_assert!(lambda[i] >= 0.0 && slope < 1e-9, "{slope}");
                prop_assert!((lambda[i] * slope).abs() < 1e-9);
            }
        }
    }
}
