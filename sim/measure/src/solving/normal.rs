//! Normal equations of least squares: ½xᵀPx + qᵀx with P = AᵀA, q = −Aᵀb.

/// The sums over rows.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalEquations {
    /// Number of unknowns.
    pub size: usize,
    /// P, dense and symmetric, row after row.
    pub matrix: Vec<f64>,
    /// q.
    pub vector: Vec<f64>,
}

impl NormalEquations {
    /// Equations without rows.
    #[must_use]
    pub fn new(size: usize) -> Self {
        Self {
            size,
            matrix: vec![0.0; size * size],
            vector: vec![0.0; size],
        }
    }

    /// Adds the row Σ coefficient·x = b; entries are (place, coefficient).
    pub fn add(&mut self, row: &[(usize, f64)], b: f64) {
        for (i, a) in row {
            for (j, c) in row {
                self.matrix[i * self.size + j] += a * c;
            }
            self.vector[*i] -= a * b;
        }
    }

    /// P⁻¹ over the unknowns that `free` marks, 0 in the rows and columns of the others; `None`
    /// where P is singular to f64. Cholesky.
    #[must_use]
    pub fn inverse(&self, free: &[bool]) -> Option<Vec<f64>> {
        let places: Vec<usize> = (0..self.size).filter(|i| free[*i]).collect();
        let n = places.len();
        let at = |i: usize, j: usize| self.matrix[places[i] * self.size + places[j]];
        let mut lower = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum();
                let rest = at(i, j) - known;
                lower[i * n + j] = if i == j {
                    if rest <= 1e-14 * at(i, i) {
                        return None;
                    }
                    rest.sqrt()
                } else {
                    rest / lower[j * n + j]
                };
            }
        }
        let mut inverse = vec![0.0; self.size * self.size];
        for column in 0..n {
            let mut x = vec![0.0; n];
            for i in column..n {
                let known: f64 = (column..i).map(|k| lower[i * n + k] * x[k]).sum();
                let unit = if i == column { 1.0 } else { 0.0 };
                x[i] = (unit - known) / lower[i * n + i];
            }
            for i in (0..n).rev() {
                let known: f64 = (i + 1..n).map(|k| lower[k * n + i] * x[k]).sum();
                x[i] = (x[i] - known) / lower[i * n + i];
            }
            for (i, value) in x.iter().enumerate() {
                inverse[places[i] * self.size + places[column]] = *value;
            }
        }
        Some(inverse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_one_and_a_singular_matrix_has_none() {
        let mut equations = NormalEquations::new(3);
        equations.add(&[(0, 2.0), (2, 1.0)], 1.0);
        equations.add(&[(0, -1.0), (2, 3.0)], 0.0);
        assert_eq!(equations.vector, [-2.0, 0.0, -1.0]);
        let inverse = equations.inverse(&[true, false, true]).expect("regular");
        for i in [0, 2] {
            for j in [0, 2] {
                let product: f64 = (0..3)
                    .map(|k| equations.matrix[i * 3 + k] * inverse[k * 3 + j])
                    .sum();
                assert!((product - if i == j { 1.0 } else { 0.0 }).abs() < 1e-12);
            }
        }
        assert_eq!(equations.inverse(&[true; 3]), None);
    }
}
