//! Quadratic programs with fixed and bounded unknowns, by Clarabel's interior-point method
//! (Goulart and Chen 2024, *Clarabel: An interior-point solver for conic programs with quadratic
//! objectives*).

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver as _, SolverStatus};

use crate::normal::NormalEquations;

/// Bound of an unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Fixed at a value.
    Fixed(f64),
    /// Bounded below.
    Above(f64),
    /// Bounded on both sides.
    Between(f64, f64),
}

/// The x with the least ½xᵀPx + qᵀx within the bounds, one an unknown; `None` if the solver fails, which a positive
/// semidefinite P and finite numbers rule out.
#[must_use]
pub fn minimise(equations: &NormalEquations, bounds: &[Bound]) -> Option<Vec<f64>> {
    let n = equations.size;
    // The solver's tolerances are absolute too: bring the objective to the order of 1.
    let largest = (0..n)
        .map(|i| equations.matrix[i * n + i])
        .fold(f64::MIN_POSITIVE, f64::max);
    let scale = 1.0 / largest;
    let upper = upper_triangle(&equations.matrix, n, scale);
    let linear: Vec<f64> = equations.vector.iter().map(|q| q * scale).collect();

    // s = b − A·x, s = 0 in the first rows and s ≥ 0 in the others.
    let mut rows: Vec<(usize, f64, f64)> = Vec::new();
    for (i, bound) in bounds.iter().enumerate() {
        if let Bound::Fixed(value) = bound {
            rows.push((i, 1.0, *value));
        }
    }
    let fixed = rows.len();
    for (i, bound) in bounds.iter().enumerate() {
        match bound {
            Bound::Fixed(_) => {}
            Bound::Above(least) => rows.push((i, -1.0, -least)),
            Bound::Between(least, most) => {
                rows.extend([(i, -1.0, -least), (i, 1.0, *most)]);
            }
        }
    }
    let right: Vec<f64> = rows.iter().map(|(_, _, b)| *b).collect();
    let cones = [ZeroConeT(fixed), NonnegativeConeT(rows.len() - fixed)];
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        ..DefaultSettings::default()
    };
    let constraints = constraint_matrix(&rows, n);
    let mut solver =
        DefaultSolver::new(&upper, &linear, &constraints, &right, &cones, settings).ok()?;
    solver.solve();
    let solved = matches!(
        solver.solution.status,
        SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
    );
    let x = &solver.solution.x;
    (solved && x.iter().all(|value| value.is_finite())).then(|| x.clone())
}

/// The upper triangle, times `scale`, in compressed sparse columns.
fn upper_triangle(matrix: &[f64], n: usize, scale: f64) -> CscMatrix<f64> {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        for i in 0..=j {
            let value = matrix[i * n + j];
            if value != 0.0 {
                rows.push(i);
                values.push(value * scale);
            }
        }
        starts.push(rows.len());
    }
    CscMatrix::new(n, n, starts, rows, values)
}

/// Rows with one entry each, (column, coefficient, _), in compressed sparse columns.
fn constraint_matrix(entries: &[(usize, f64, f64)], n: usize) -> CscMatrix<f64> {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        for (row, (_, value, _)) in entries.iter().enumerate().filter(|(_, entry)| entry.0 == j) {
            rows.push(row);
            values.push(*value);
        }
        starts.push(rows.len());
    }
    CscMatrix::new(entries.len(), n, starts, rows, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_with_every_kind_of_bound() {
        // (x+y−3)² + (y+1)² + (z/10−.2)² + (w−9)² + (v+x−5)²: unbounded, y would be −1 and w 9.
        let mut equations = NormalEquations::new(5);
        equations.add(&[(0, 1.0), (1, 1.0)], 3.0);
        equations.add(&[(1, 1.0)], -1.0);
        equations.add(&[(2, 0.1)], 0.2);
        equations.add(&[(3, 1.0)], 9.0);
        equations.add(&[(4, 1.0), (0, 1.0)], 5.0);
        let bounds = [
            Bound::Above(0.0),
            Bound::Above(0.0),
            Bound::Above(0.0),
            Bound::Between(-1.0, 4.0),
            Bound::Fixed(2.0),
        ];
        let x = minimise(&equations, &bounds).expect("solved");
        for (got, want) in x.iter().zip([3.0, 0.0, 2.0, 4.0, 2.0]) {
            assert!((got - want).abs() < 1e-5, "{x:?}");
        }
    }
}
