//! The least squares of a rule at some wavelengths, exact for white and without negative weights.

use super::normal::Normal;

/// A lower triangular Cholesky factor, row after row; grown by bordering.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    pub(super) rows: Vec<Vec<f64>>,
}

impl Factor {
    /// Adds a row and column: `row` holds the entries before the diagonal, then the diagonal.
    pub(super) fn grow(&mut self, row: &[f64]) {
        let n = self.rows.len();
        let mut new = self.forward(&row[..n]);
        let rest = row[n] - new.iter().map(|v| v * v).sum::<f64>();
        new.push(rest.max(1e-14 * row[n].abs()).max(f64::MIN_POSITIVE).sqrt());
        self.rows.push(new);
    }

    /// L⁻¹·v for a vector at most as long as L.
    pub(super) fn forward(&self, v: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = Vec::with_capacity(v.len());
        for (i, value) in v.iter().enumerate() {
            let row = &self.rows[i];
            let sum: f64 = row[..i].iter().zip(&out).map(|(l, x)| l * x).sum();
            out.push((value - sum) / row[i]);
        }
        out
    }

    /// L⁻ᵀ·v.
    fn backward(&self, mut v: Vec<f64>) -> Vec<f64> {
        for i in (0..v.len()).rev() {
            v[i] /= self.rows[i][i];
            let (head, x) = (&self.rows[i], v[i]);
            v[..i].iter_mut().zip(head).for_each(|(v, l)| *v -= l * x);
        }
        v
    }

    /// (L·Lᵀ)⁻¹·v.
    fn solve(&self, v: &[f64]) -> Vec<f64> {
        self.backward(self.forward(v))
    }
}

/// The weights at `chosen`: least squares, Σ weights = white in each channel, all ≥ 0, by an active
/// set (Lawson and Hanson 1974, ch. 23, with the equalities kept throughout).
pub(super) fn non_negative(normal: &Normal, chosen: &[usize]) -> Vec<[f64; 3]> {
    let all: Vec<usize> = chosen
        .iter()
        .flat_map(|p| [3 * p, 3 * p + 1, 3 * p + 2])
        .collect();
    let mut fixed = vec![false; all.len()];
    let mut x = vec![0.0; all.len()];
    for _ in 0..8 * all.len() {
        let free: Vec<usize> = (0..all.len()).filter(|i| !fixed[*i]).collect();
        let (solution, prices) = with_exact_white(normal, &all, &free);
        x.fill(0.0);
        free.iter()
            .zip(&solution)
            .for_each(|(i, value)| x[*i] = *value);
        if solution.iter().any(|value| *value < 0.0) {
            (0..all.len()).for_each(|i| fixed[i] |= x[i] < 0.0);
            continue;
        }
        // A fixed weight is let go where the sum of squares would fall.
        let slope = |i: usize| {
            let row: f64 = (0..all.len())
                .map(|j| normal.a(all[i], all[j]) * x[j])
                .sum();
            row - normal.b(all[i]) + prices[all[i] % 3]
        };
        let tolerance = 1e-9 * normal.scale();
        let worst = (0..all.len())
            .filter(|i| fixed[*i])
            .map(|i| (slope(i), i))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match worst {
            Some((slope, i)) if slope < -tolerance => fixed[i] = false,
            _ => break,
        }
    }
    x.iter_mut().for_each(|weight| *weight = weight.max(0.0));
    let mut weights: Vec<[f64; 3]> = x.chunks_exact(3).map(|w| [w[0], w[1], w[2]]).collect();
    for channel in 0..3 {
        let sum: f64 = weights.iter().map(|weight| weight[channel]).sum();
        weights
            .iter_mut()
            .for_each(|weight| weight[channel] *= normal.white[channel] / sum);
    }
    weights
}

/// The free weights that minimise, with exact white, and the prices of white in each channel.
fn with_exact_white(normal: &Normal, all: &[usize], free: &[usize]) -> (Vec<f64>, [f64; 3]) {
    let mut factor = Factor::default();
    for (n, i) in free.iter().enumerate() {
        let row: Vec<f64> = free[..=n]
            .iter()
            .map(|j| normal.a(all[*i], all[*j]))
            .collect();
        factor.grow(&row);
    }
    let pull: Vec<f64> = free.iter().map(|i| normal.b(all[*i])).collect();
    let plain = factor.solve(&pull);
    let channel = |c: usize| -> Vec<f64> {
        free.iter()
            .map(|i| if all[*i] % 3 == c { 1.0 } else { 0.0 })
            .collect()
    };
    let sums = |x: &[f64]| {
        let mut sums = [0.0; 3];
        free.iter()
            .zip(x)
            .for_each(|(i, value)| sums[all[*i] % 3] += value);
        sums
    };
    let columns = [0, 1, 2].map(|c| factor.solve(&channel(c)));
    let by_column = [0, 1, 2].map(|c| sums(&columns[c]));
    let matrix = [0, 1, 2].map(|row| [0, 1, 2].map(|column: usize| by_column[column][row]));
    let got = sums(&plain);
    let prices = crate::colour::solve3(&matrix, [0, 1, 2].map(|c| got[c] - normal.white[c]));
    let x = (0..free.len())
        .map(|i| plain[i] - (0..3).map(|c| columns[c][i] * prices[c]).sum::<f64>())
        .collect();
    (x, prices)
}
