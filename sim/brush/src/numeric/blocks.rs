//! Symmetric matrices with a 2×2 block for each pair of segments: the tangent plane of a direction has
//! two dimensions.

use glam::{DMat2, DVec2};

/// The factors of a symmetric positive definite matrix of blocks, H = Uᵀ·D·U with ones on the diagonal
/// of U: Cholesky's without roots.
#[derive(Clone, Debug, Default)]
pub struct BlockFactor {
    n: usize,
    /// D·U: the blocks of each row from the diagonal rightward are used.
    reduced: Vec<DMat2>,
    /// D⁻¹.
    inverse: Vec<DMat2>,
}

impl BlockFactor {
    /// Factors `h` (n×n blocks, of which those on and above the diagonal are read); false where it is not positive
    /// definite.
    pub fn factor(&mut self, h: &[DMat2], n: usize) -> bool {
        self.n = n;
        self.inverse.clear();
        self.reduced.clear();
        self.reduced.extend_from_slice(&h[..n * n]);
        for k in 0..n {
            let (above, below) = self.reduced.split_at_mut((k + 1) * n);
            let row = &above[k * n..];
            let Some(inverse) = invert(row[k]) else {
                return false;
            };
            self.inverse.push(inverse);
            for i in k + 1..n {
                let share = (inverse * row[i]).transpose();
                let reduced = &mut below[(i - k - 1) * n..][..n];
                for j in i..n {
                    reduced[j] -= share * row[j];
                }
            }
        }
        true
    }

    /// Replaces `x` by H⁻¹·x.
    pub fn solve(&self, x: &mut [DVec2]) {
        let (n, x) = (self.n, &mut x[..self.n]);
        for k in 0..n {
            let row = &self.reduced[k * n..][..n];
            let value = self.inverse[k] * x[k];
            for j in k + 1..n {
                x[j] -= row[j].transpose() * value;
            }
        }
        for k in (0..n).rev() {
            let row = &self.reduced[k * n..][..n];
            let mut value = x[k];
            for j in k + 1..n {
                value -= row[j] * x[j];
            }
            x[k] = self.inverse[k] * value;
        }
    }
}

/// The inverse of a symmetric block; `None` if it is not positive definite.
fn invert(block: DMat2) -> Option<DMat2> {
    let (a, b, c) = (block.x_axis.x, block.y_axis.x, block.y_axis.y);
    let determinant = a * c - b * b;
    let positive = a > 0.0 && determinant > 0.0;
    positive.then(|| DMat2::from_cols_array(&[c, -b, -b, a]) * (1.0 / determinant))
}

/// The sum of products.
#[must_use]
pub fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    let sum: DVec2 = a.iter().zip(b).map(|(a, b)| *a * *b).sum();
    sum.x + sum.y
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// B·Bᵀ + `more`·I of 3×3 blocks, whole.
    fn square(b: &[f64], more: f64) -> Vec<DMat2> {
        let entry = |p: usize, q: usize| {
            let sum: f64 = (0..6).map(|k| b[p * 6 + k] * b[q * 6 + k]).sum();
            sum + if p == q { more } else { 0.0 }
        };
        let block = |i: usize, j: usize| {
            let column =
                |b: usize| DVec2::new(entry(2 * i, 2 * j + b), entry(2 * i + 1, 2 * j + b));
            DMat2::from_cols(column(0), column(1))
        };
        (0..9).map(|place| block(place / 3, place % 3)).collect()
    }

    proptest! {
        #[test]
        fn the_factor_solves(b in prop::collection::vec(-1.0..1.0f64, 36), x in prop::collection::vec(-1.0..1.0f64, 6)) {
            let h = square(&b, 0.1);
            let x: Vec<DVec2> = x.chunks_exact(2).map(DVec2::from_slice).collect();
            let mut back: Vec<DVec2> =
                (0..3).map(|i| (0..3).map(|j| h[i * 3 + j] * x[j]).sum()).collect();
            let mut factor = BlockFactor::default();
            prop_assert!(factor.factor(&h, 3));
            factor.solve(&mut back);
            for (x, back) in x.iter().zip(&back) {
                prop_assert!((*x - *back).length() < 1e-9, "{x} {back}");
            }
        }

        #[test]
        fn what_is_indefinite_is_refused(b in prop::collection::vec(-1.0..1.0f64, 36), at in 0usize..6) {
            let mut h = square(&b, 0.1);
            let most = h[0].x_axis.x.max(h[0].y_axis.y) + h[4].x_axis.x.max(h[4].y_axis.y) + 10.0;
            h[(at / 2) * 4].col_mut(at % 2)[at % 2] -= most;
            prop_assert!(!BlockFactor::default().factor(&h, 3));
            h[0].x_axis.x = f64::NAN;
            prop_assert!(!BlockFactor::default().factor(&h, 3));
        }
    }
}
