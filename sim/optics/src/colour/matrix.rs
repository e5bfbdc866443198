//! Matrices of three rows and columns.

/// Rows of a colour matrix.
pub type Matrix = [[f64; 3]; 3];

/// Applies a colour matrix.
#[must_use]
pub fn apply(matrix: &Matrix, colour: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * colour[0] + row[1] * colour[1] + row[2] * colour[2])
}

/// The matrix that applies `b`, then `a`.
#[must_use]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |j: usize| apply(a, [b[0][j], b[1][j], b[2][j]]);
    let columns = [column(0), column(1), column(2)];
    std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
}

/// The solution x of m·x = v; not finite without one.
#[must_use]
pub fn solve3(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    apply(&inverse(m), v)
}

/// The inverse; not finite without one.
#[must_use]
pub fn inverse(m: &Matrix) -> Matrix {
    let minor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}
