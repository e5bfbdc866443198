//! The quadratic program of a Gauss-Newton step over shares.
//!
//! Minimise ½|e + Σ jₛ·(zₛ − yₛ)|² + ½λ|z − o|² + Σ cₛ·zₛ over z ≥ 0, Σz = 1, by a primal active-set method (Nocedal
//! and Wright 2006, § 16.5). Where a set of shares is free, λ(zₛ − oₛ) = −(jₛ·e' + cₛ + ν) with the residual e' at the
//! minimum and the multiplier ν of the sum, so there are four unknowns for any number of paints.

/// Weight λ of the distance from the own shares.
pub(crate) const OWN_SHARES_WEIGHT: f64 = 0.02;
/// Greatest number of changes of the free set per paint.
const CHANGES: usize = 4;
/// Slope of the objective along a share below which it stays 0.
const SLOPE_TOLERANCE: f64 = 1e-6;

/// Objective of a step.
pub(crate) struct Program<'a> {
    /// Weighted difference from the target colour, e.
    pub(crate) residual: [f64; 3],
    /// Its slopes by the shares, j.
    pub(crate) slopes: &'a [[f64; 3]],
    /// Own shares, o.
    pub(crate) own: &'a [f64],
    /// Cost of a share, c.
    pub(crate) costs: &'a [f64],
}

/// Buffers of a program.
#[derive(Debug, Default)]
pub(crate) struct Active {
    is_free: Vec<bool>,
    ends: Vec<f64>,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Program<'_> {
    /// Moves shares from their current values, y, to the minimum.
    pub(crate) fn minimise(&self, shares: &mut [f64], active: &mut Active) {
        let mut bare = self.residual;
        for (slope, share) in self.slopes.iter().zip(&*shares) {
            bare = [0, 1, 2].map(|i| bare[i] - slope[i] * share);
        }
        active.is_free.clear();
        active
            .is_free
            .extend(shares.iter().map(|share| *share > 0.0));
        active.ends.resize(shares.len(), 0.0);
        for _ in 0..CHANGES * shares.len() {
            let [a, b, c, sum] = self.solve(&active.is_free, bare);
            let slope = |paint: usize| {
                dot(self.slopes[paint], [a, b, c]) + self.costs[paint] + sum
                    - OWN_SHARES_WEIGHT * self.own[paint]
            };
            let mut first = (1.0, None);
            for paint in 0..shares.len() {
                active.ends[paint] = 0.0;
                if !active.is_free[paint] {
                    continue;
                }
                let end = -slope(paint) / OWN_SHARES_WEIGHT;
                active.ends[paint] = end;
                if end < 0.0 {
                    let part = shares[paint] / (shares[paint] - end);
                    if first.1.is_none() || part < first.0 {
                        first = (part, Some(paint));
                    }
                }
            }
            for (share, end) in shares.iter_mut().zip(&active.ends) {
                *share += first.0 * (end - *share);
            }
            if let Some(paint) = first.1 {
                shares[paint] = 0.0;
                active.is_free[paint] = false;
                continue;
            }
            let held = (0..shares.len()).filter(|paint| !active.is_free[*paint]);
            let lowest = held.map(|paint| (paint, slope(paint)));
            let lowest = lowest.min_by(|one, other| one.1.total_cmp(&other.1));
            match lowest {
                Some((paint, slope)) if slope < -SLOPE_TOLERANCE => active.is_free[paint] = true,
                _ => break,
            }
        }
        // Rounding error of the sum.
        let sum: f64 = shares.iter().map(|share| share.max(0.0)).sum();
        for share in shares {
            *share = share.max(0.0) / sum;
        }
    }

    /// Residual at the minimum over the free shares and the multiplier of their sum; `bare` is the residual without any
    /// paint.
    fn solve(&self, is_free: &[bool], bare: [f64; 3]) -> [f64; 4] {
        let mut matrix = [[0.0; 4]; 4];
        let mut right = [
            OWN_SHARES_WEIGHT * bare[0],
            OWN_SHARES_WEIGHT * bare[1],
            OWN_SHARES_WEIGHT * bare[2],
            -OWN_SHARES_WEIGHT,
        ];
        for (i, row) in matrix.iter_mut().enumerate().take(3) {
            row[i] = OWN_SHARES_WEIGHT;
        }
        for (paint, [a, b, c]) in self.slopes.iter().enumerate() {
            if is_free[paint] {
                let row = [*a, *b, *c, 1.0];
                let pull = OWN_SHARES_WEIGHT * self.own[paint] - self.costs[paint];
                for i in 0..4 {
                    for j in 0..4 {
                        matrix[i][j] += row[i] * row[j];
                    }
                    right[i] += row[i] * pull;
                }
            }
        }
        solved(matrix, right)
    }
}

/// The solution of a symmetric positive definite system (Cholesky, without roots).
fn solved(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> [f64; 4] {
    for i in 0..4 {
        for j in i + 1..4 {
            let factor = matrix[j][i] / matrix[i][i];
            for k in i..4 {
                matrix[j][k] -= factor * matrix[i][k];
            }
            right[j] -= factor * right[i];
        }
    }
    for i in (0..4).rev() {
        for k in i + 1..4 {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    right
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn value(program: &Program<'_>, from: &[f64], at: &[f64]) -> f64 {
        let mut residual = program.residual;
        let mut rest = 0.0;
        for (paint, slope) in program.slopes.iter().enumerate() {
            for (sum, slope) in residual.iter_mut().zip(slope) {
                *sum += slope * (at[paint] - from[paint]);
            }
            let off = at[paint] - program.own[paint];
            rest += 0.5 * OWN_SHARES_WEIGHT * off * off + program.costs[paint] * at[paint];
        }
        0.5 * dot(residual, residual) + rest
    }

    proptest! {
        /// A point minimises a convex function over the simplex where no exchange between two paints gains anything.
        #[test]
        fn no_exchange_from_the_minimum_gains(
            slopes in prop::collection::vec(prop::array::uniform3(-60.0..60.0f64), 5),
            strong in 1.0..30.0f64,
            residual in prop::array::uniform3(-20.0..20.0f64),
            own in 0usize..5,
            start in 0usize..5,
        ) {
            let mut slopes = slopes;
            slopes[3] = slopes[3].map(|slope| strong * slope);
            let mut owns = [0.0; 5];
            owns[own] = 1.0;
            let costs = owns.map(|share| 0.05 * (1.0 - share));
            let program = Program { residual, slopes: &slopes, own: &owns, costs: &costs };
            let mut from = [0.0; 5];
            from[start] = 1.0;
            let mut found = from;
            program.minimise(&mut found, &mut Active::default());
            prop_assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!(found.iter().all(|share| *share >= 0.0));
            let lowest = value(&program, &from, &found);
            let exchanged = |give: usize, take: usize, part: f64| {
                let part = part.min(found[give]);
                let mut other = found;
                other[give] -= part;
                other[take] += part;
                value(&program, &from, &other)
            };
            for (give, take) in (0..5).flat_map(|a| (0..5).map(move |b| (a, b))) {
                for part in [1e-6, 1e-4, 1e-2, 0.1] {
                    let off = lowest - exchanged(give, take, part);
                    prop_assert!(off < 1e-7, "{found:?} {give} {take} {part} {off}");
                }
            }
            prop_assert!(lowest <= value(&program, &from, &from) + 1e-9);
        }
    }
}
