//! The quadratic programme of a Gauss-Newton step over shares.
//!
//! Minimise ½|e + Σ jₛ·(zₛ − yₛ)|² + ½λ|z − o|² + Σ cₛ·zₛ over z ≥ 0, Σz = 1, by sequential minimal optimisation (Platt
//! 1998): share goes from one paint to another, each time between the two for which that gains most.

/// Weight λ of the distance from the own shares.
pub(crate) const NEAR: f64 = 0.02;
/// Most exchanges.
const EXCHANGES: usize = 400;
/// Gain a unit of share below which no exchange is worth making.
const LEAST: f64 = 1e-3;

/// What a step is to minimise.
pub(crate) struct Program<'a> {
    /// Weighted difference from the colour wanted, e.
    pub(crate) residual: [f64; 3],
    /// Its slopes by the shares, j.
    pub(crate) slopes: &'a [[f64; 3]],
    /// Own shares, o.
    pub(crate) own: &'a [f64],
    /// Cost of a share, c.
    pub(crate) costs: &'a [f64],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Program<'_> {
    /// Moves shares from where they are, y, to the minimum.
    pub(crate) fn minimise(&self, shares: &mut [f64]) {
        let mut residual = self.residual;
        for _ in 0..EXCHANGES {
            let gradient = |paint: usize, share: f64| {
                dot(self.slopes[paint], residual)
                    + NEAR * (share - self.own[paint])
                    + self.costs[paint]
            };
            let mut to = (0, f64::INFINITY);
            for (paint, share) in shares.iter().enumerate() {
                let slope = gradient(paint, *share);
                if slope < to.1 {
                    to = (paint, slope);
                }
            }
            let mut best = None;
            let mut most = 0.0;
            for (paint, share) in shares.iter().enumerate() {
                let gap = gradient(paint, *share) - to.1;
                if *share <= 0.0 || gap <= LEAST {
                    continue;
                }
                let apart = [0, 1, 2].map(|i| self.slopes[to.0][i] - self.slopes[paint][i]);
                let curved = dot(apart, apart) + 2.0 * NEAR;
                let part = (gap / curved).min(*share);
                let gain = part * (gap - 0.5 * part * curved);
                if gain > most {
                    most = gain;
                    best = Some((paint, part, apart));
                }
            }
            let Some((from, part, apart)) = best else {
                return;
            };
            shares[from] = (shares[from] - part).max(0.0);
            shares[to.0] += part;
            residual = [0, 1, 2].map(|i| residual[i] + part * apart[i]);
        }
    }
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
            rest += 0.5 * NEAR * off * off + program.costs[paint] * at[paint];
        }
        0.5 * dot(residual, residual) + rest
    }

    proptest! {
        /// No exchange between two paints from the minimum gains anything, whatever its size.
        #[test]
        fn nothing_beside_the_minimum_is_lower(
            slopes in prop::collection::vec(prop::array::uniform3(-60.0..60.0f64), 5),
            residual in prop::array::uniform3(-20.0..20.0f64),
            own in 0usize..5,
        ) {
            let mut owns = [0.0; 5];
            owns[own] = 1.0;
            let costs = owns.map(|share| 0.05 * (1.0 - share));
            let program = Program { residual, slopes: &slopes, own: &owns, costs: &costs };
            let from = [0.2; 5];
            let mut found = from;
            program.minimise(&mut found);
            prop_assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let lowest = value(&program, &from, &found);
            for (give, take) in (0..5).flat_map(|a| (0..5).map(move |b| (a, b))) {
                for part in [1e-3, 1e-2, 0.1] {
                    let part = f64::min(part, found[give]);
                    let mut other = found;
                    other[give] -= part;
                    other[take] += part;
                    prop_assert!(value(&program, &from, &other) > lowest - 0.02, "{found:?}");
                }
            }
            prop_assert!(lowest <= value(&program, &from, &from) + 1e-9);
        }
    }
}
