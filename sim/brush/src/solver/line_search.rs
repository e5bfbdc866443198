//! How far to go along a step.

use super::{Energy, Problem, Solver, Stop};
use crate::spine::SpineShape;

/// A step turns no segment by more than this, rad.
const LONGEST_TURN: f64 = 0.7;

impl Solver {
    /// Goes along the step as far as energy and penetration together fall; false where they do not.
    pub(super) fn line_search(
        &mut self,
        problem: Problem<'_>,
        shape: &mut SpineShape,
        stops: &[Stop],
        energy: Energy,
    ) -> bool {
        let price = 2.0 * self.multipliers.iter().copied().fold(0.0, f64::max)
            + problem.spine.stiffest() / problem.spine.length_m();
        let merit = |energy: Energy, gaps: &[f64]| {
            energy.total() + price * gaps.iter().map(|gap| (-gap).max(0.0)).sum::<f64>()
        };
        let start = merit(energy, &self.gap);
        let slope: f64 = self
            .step
            .iter()
            .zip(&self.gradient)
            .map(|(d, g)| d * g)
            .sum::<f64>()
            - price * self.gap.iter().map(|gap| (-gap).max(0.0)).sum::<f64>();
        let turn = self
            .step
            .chunks_exact(2)
            .map(|u| u[0] * u[0] + u[1] * u[1])
            .fold(0.0, f64::max)
            .sqrt();
        let mut fraction = if turn > LONGEST_TURN {
            LONGEST_TURN / turn
        } else {
            1.0
        };
        let noise = 1e-13 * start.abs().max(1e-12);
        for _ in 0..30 {
            self.try_step(shape, fraction, 0.0);
            let tried = self.value(problem, shape, stops);
            if merit(tried, &self.trial_gap) <= start + 1e-4 * fraction * slope.min(0.0) + noise {
                shape.directions.copy_from_slice(&self.trial);
                return true;
            }
            if self.correct(shape, fraction) {
                let tried = self.value(problem, shape, stops);
                if merit(tried, &self.trial_gap) <= start + noise {
                    shape.directions.copy_from_slice(&self.trial);
                    return true;
                }
            }
            fraction *= 0.5;
        }
        false
    }

    /// The shape after a fraction of the step, and of a correction along the constraints' columns.
    pub(super) fn try_step(&mut self, shape: &SpineShape, fraction: f64, correction: f64) {
        let size = self.step.len();
        let correction_at = |p: usize| {
            (0..self.lambda.len())
                .map(|i| self.lambda[i] * self.columns[i * size + p])
                .sum::<f64>()
        };
        self.trial.clear();
        for (j, d) in shape.directions.iter().enumerate() {
            let mut moved = *d;
            for (a, t) in self.tangents[j].iter().enumerate() {
                let p = 2 * j + a;
                let mut along = fraction * self.step[p];
                if correction != 0.0 {
                    along += correction * correction_at(p);
                }
                moved += *t * along;
            }
            self.trial.push(moved.normalize());
        }
    }

    /// Second-order correction: the surface is curved in the directions, so a straight step leaves
    /// the binding constraints; put the trial back onto them. False where none binds.
    pub(super) fn correct(&mut self, shape: &SpineShape, fraction: f64) -> bool {
        let n = self.trial_gap.len();
        self.lambda.clear();
        self.lambda.extend(self.trial_gap.iter().map(|gap| -gap));
        let multipliers = &self.multipliers;
        let binding = (0..n).filter(|i| multipliers[*i] > 0.0);
        if !self
            .active_set
            .solve_equalities(&self.dual, binding, self.floor(n), &mut self.lambda)
        {
            return false;
        }
        self.try_step(shape, fraction, 1.0);
        true
    }
}
