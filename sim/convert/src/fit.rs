//! Shares of paints nearest to a colour: Gauss-Newton steps on the simplex, in the metric of ΔE₀₀ around that colour.
//!
//! Among equally near mixtures the one closest to the cell's own is chosen: leaving it has a small cost, and paints
//! that it lacks a slightly larger one.

use maulstick_optics::colour::{Matrix, apply, delta_e_2000, delta_e_2000_near};

use crate::cell::CellColour;
use crate::program::{Active, OWN_SHARES_WEIGHT, Program};

/// Cost of a mixture entirely of paints that the cell's own lacks, ΔE₀₀²/2.
const FOREIGN: f64 = 0.05;
/// Greatest number of steps.
const STEPS: usize = 16;
/// Gain of the last step, ΔE₀₀²/2.
const LAST_GAIN: f64 = 1e-3;
/// Factor on a step that overshoots.
const SHORTENING: f64 = 0.35;
/// Greatest number of attempts of a step.
const ATTEMPTS: usize = 5;

/// Target of a fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    /// Target colour, CIELAB.
    pub(crate) colour: [f64; 3],
    /// The cell's own shares.
    pub(crate) own: &'a [f64],
}

/// Quality of fitted shares.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Found {
    pub(crate) shares: Vec<f64>,
    /// Distance from the target colour, ΔE₀₀.
    pub(crate) delta_e: f64,
    /// Minimised energy.
    pub(crate) energy: f64,
}

/// A fit, with its buffers.
#[derive(Debug, Default)]
pub(crate) struct Fitter {
    slopes: Vec<[f64; 3]>,
    next_slopes: Vec<[f64; 3]>,
    weighted: Vec<[f64; 3]>,
    costs: Vec<f64>,
    ends: Vec<f64>,
    tried: Vec<f64>,
    active: Active,
}

/// Constant terms of a fit.
struct Terms<'a> {
    wanted: Wanted<'a>,
    metric: Matrix,
}

impl Terms<'_> {
    fn residual(&self, lab: [f64; 3]) -> [f64; 3] {
        let off = [0, 1, 2].map(|i| lab[i] - self.wanted.colour[i]);
        apply(&self.metric, off)
    }

    fn energy(&self, lab: [f64; 3], shares: &[f64]) -> f64 {
        let [l, c, h] = self.residual(lab);
        let mut energy = l * l + c * c + h * h;
        for (share, own) in shares.iter().zip(self.wanted.own) {
            energy += OWN_SHARES_WEIGHT * (share - own) * (share - own);
            if *own <= 0.0 {
                energy += 2.0 * FOREIGN * share;
            }
        }
        0.5 * energy
    }
}

impl Fitter {
    /// A fit of `paints` paints.
    pub(crate) fn new(paints: usize) -> Self {
        let slopes = vec![[0.0; 3]; paints];
        Self {
            next_slopes: slopes.clone(),
            weighted: slopes.clone(),
            slopes,
            costs: vec![0.0; paints],
            ends: vec![0.0; paints],
            tried: vec![0.0; paints],
            active: Active::default(),
        }
    }

    /// Descends from a start to the nearest shares, written to `found`.
    pub(crate) fn descend(
        &mut self,
        colour: &impl CellColour,
        wanted: Wanted<'_>,
        start: &[f64],
        found: &mut Found,
    ) {
        let metric = delta_e_2000_near(wanted.colour);
        let terms = Terms { wanted, metric };
        for (cost, own) in self.costs.iter_mut().zip(wanted.own) {
            *cost = if *own > 0.0 { 0.0 } else { FOREIGN };
        }
        found.shares.clear();
        found.shares.extend_from_slice(start);
        let mut lab = colour.lab(&found.shares, &mut self.slopes);
        found.energy = terms.energy(lab, &found.shares);
        for _ in 0..STEPS {
            for (weighted, slope) in self.weighted.iter_mut().zip(&self.slopes) {
                *weighted = apply(&metric, *slope);
            }
            self.ends.copy_from_slice(&found.shares);
            let program = Program {
                residual: terms.residual(lab),
                slopes: &self.weighted,
                own: wanted.own,
                costs: &self.costs,
            };
            program.minimise(&mut self.ends, &mut self.active);
            let Some((there, energy)) = self.towards(colour, &terms, found) else {
                break;
            };
            let gained = found.energy - energy;
            found.shares.copy_from_slice(&self.tried);
            found.energy = energy;
            lab = there;
            std::mem::swap(&mut self.slopes, &mut self.next_slopes);
            if gained < LAST_GAIN {
                break;
            }
        }
        found.delta_e = delta_e_2000(lab, wanted.colour);
    }

    /// Moves toward the end of a step, less far where it overshoots; returns colour and energy there, `None` where no
    /// attempt is lower.
    fn towards(
        &mut self,
        colour: &impl CellColour,
        terms: &Terms<'_>,
        from: &Found,
    ) -> Option<([f64; 3], f64)> {
        let mut part = 1.0;
        for _ in 0..ATTEMPTS {
            for (place, tried) in self.tried.iter_mut().enumerate() {
                let start = from.shares[place];
                *tried = start + part * (self.ends[place] - start);
            }
            let lab = colour.lab(&self.tried, &mut self.next_slopes);
            let energy = terms.energy(lab, &self.tried);
            if energy < from.energy {
                return Some((lab, energy));
            }
            part *= SHORTENING;
        }
        None
    }
}

/// Whole counts of the sum `all` in the ratio of shares: each rounded down, the remainder going to the largest
/// fractions.
pub(crate) fn whole(shares: &[f64], all: u64, counts: &mut Vec<u64>) {
    counts.clear();
    let sum: f64 = shares.iter().sum();
    let exact = |share: &f64| share / sum * all as f64;
    counts.extend(shares.iter().map(|share| exact(share) as u64));
    let given: u64 = counts.iter().sum();
    // Rounding may have given one more than there is.
    if given > all {
        let most = (0..counts.len()).max_by_key(|place| counts[*place]);
        if let Some(most) = most {
            counts[most] -= (given - all).min(counts[most]);
        }
        return;
    }
    let mut order: Vec<usize> = (0..shares.len())
        .filter(|place| shares[*place] > 0.0)
        .collect();
    let rest = |place: usize| {
        let exact = exact(&shares[place]);
        exact - exact.floor()
    };
    order.sort_by(|one, other| rest(*other).total_cmp(&rest(*one)));
    let left = (all - given) as usize;
    for place in order.iter().cycle().take(left) {
        counts[*place] += 1;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn whole_counts_have_the_sum(
            shares in prop::collection::vec(0.0..1.0f64, 1..13), all in 0u64..20_000_000,
        ) {
            prop_assume!(shares.iter().sum::<f64>() > 1e-3);
            let mut counts = Vec::new();
            whole(&shares, all, &mut counts);
            prop_assert_eq!(counts.iter().sum::<u64>(), all);
            let sum: f64 = shares.iter().sum();
            for (count, share) in counts.iter().zip(&shares) {
                prop_assert!((*count as f64 - share / sum * all as f64).abs() < 1.5);
                prop_assert!(*share > 0.0 || *count == 0);
            }
        }
    }
}
