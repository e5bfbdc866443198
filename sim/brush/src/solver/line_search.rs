//! Step length along a direction.

use super::{ContactConstraint, Energy, Problem, Solver};
use crate::spine::SpineShape;

/// Greatest rotation of a segment in one step, rad.
const LONGEST_TURN: f64 = 0.7;
/// Greatest number of times that a step is halved.
const HALVINGS: usize = 30;

/// Sum of the depths of all joints within their half spaces, m.
fn sunk(gaps: &[f64]) -> f64 {
    gaps.iter().map(|gap| (-gap).max(0.0)).sum()
}

impl Solver {
    /// Moves along the step while energy and penetration together fall, and returns the energy there; `None` if they
    /// do not, with everything unchanged.
    pub(super) fn line_search(
        &mut self,
        problem: Problem<'_>,
        shape: &mut SpineShape,
        constraints: &[ContactConstraint],
        energy: Energy,
    ) -> Option<Energy> {
        let price = 2.0 * self.multipliers.iter().copied().fold(0.0, f64::max)
            + problem.spine.stiffest() / problem.spine.length_m();
        let merit = |energy: Energy, gaps: &[f64]| energy.total() + price * sunk(gaps);
        let start = merit(energy, &self.point.gaps);
        let downhill = self.step.iter().zip(&self.model.gradient);
        let slope = downhill.map(|(d, g)| d.dot(*g)).sum::<f64>() - price * sunk(&self.point.gaps);
        let turns = self.step.iter().map(|u| u.length_squared());
        let turn = turns.fold(0.0, f64::max).sqrt();
        let mut fraction = if turn > LONGEST_TURN {
            LONGEST_TURN / turn
        } else {
            1.0
        };
        let noise = 1e-13 * start.abs().max(1e-12);
        self.search.from.clone_from(&shape.directions);
        for _ in 0..HALVINGS {
            self.search.way.clear();
            let part = self.step.iter().map(|step| *step * fraction);
            self.search.way.extend(part);
            self.set_shape(shape);
            let tried = self.look(problem, shape, constraints);
            let aim = start + 1e-4 * fraction * slope.min(0.0) + noise;
            if merit(tried, &self.point.gaps) <= aim {
                return Some(tried);
            }
            if self.correct(shape) {
                let tried = self.look(problem, shape, constraints);
                if merit(tried, &self.point.gaps) <= start + noise {
                    return Some(tried);
                }
            }
            fraction *= 0.5;
        }
        shape.directions.copy_from_slice(&self.search.from);
        self.look(problem, shape, constraints);
        None
    }

    /// The shape at the end of a trial step.
    fn set_shape(&self, shape: &mut SpineShape) {
        let ways = self.search.way.iter().zip(&self.model.tangents);
        let segments = shape.directions.iter_mut().zip(&self.search.from);
        for ((direction, from), (way, tangents)) in segments.zip(ways) {
            *direction = (*from + tangents.vector(*way)).normalize();
        }
    }

    /// Second-order correction. The half spaces are curved in the directions, so a straight step leaves the binding
    /// constraints; this moves the trial back onto them along their columns. False if no constraint binds.
    fn correct(&mut self, shape: &mut SpineShape) -> bool {
        let program = &mut self.program;
        let (candidates, gaps) = (&self.candidates, &self.point.gaps);
        program.lambda.clear();
        program.lambda.extend(
            candidates
                .iter()
                .map(|candidate| -gaps[candidate.constraint]),
        );
        let binding =
            (0..candidates.len()).filter(|i| self.multipliers[candidates[*i].constraint] > 0.0);
        let floor = program.floor();
        if !program
            .active_set
            .solve_equalities(&program.dual, binding, floor, &mut program.lambda)
        {
            return false;
        }
        program.add_columns(&mut self.search.way);
        self.set_shape(shape);
        true
    }
}
