//! Deposit along a step.
//!
//! A step is up to several cells long, but its head is drawn once, in the middle. What a texel gives to a cell it gives
//! along the step, so it is spread evenly over as many cells; otherwise rows of cells would alternate with the bristle
//! that leaves them last.

use maulstick_canvas::quantum::CELL_MAX;

use crate::interface::{Step, Transfer};

/// Largest number of cells to one side.
pub const REACH: usize = 4;

/// Distribution of a deposit over cells along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// 0 along x, 1 along y.
    pub axis: u32,
    /// Length of the step, cells; a deposit on one cell where it is at most 1.
    pub cells: u32,
}

impl Spread {
    /// The distribution in a step. Films with a limit and paint that lasts stay where they are laid, and a sponge and a
    /// marker lay what they lay.
    #[must_use]
    pub fn of(step: &Step<'_>) -> Self {
        let is_limited = step.handling.most < CELL_MAX as f32;
        if is_limited || step.lasting || step.handling.transfer != Transfer::Paint {
            return Self::default();
        }
        let way = |from: &[f32], to: &[f32]| -> f32 {
            to.iter().zip(from).map(|(to, from)| to - from).sum()
        };
        let (from, to) = (step.sweep.from, step.sweep.to);
        let [x, y] = [way(&from.x, &to.x), way(&from.y, &to.y)];
        Self {
            axis: u32::from(y.abs() > x.abs()),
            cells: (step.traits.step_cells.round() as u32).min(2 * REACH as u32),
        }
    }

    /// Number of cells to one side that get a part.
    #[must_use]
    pub fn reach(self) -> usize {
        if self.cells > 1 {
            self.cells as usize / 2
        } else {
            0
        }
    }

    /// Share of a deposit that a cell `off` cells to the side gets.
    #[must_use]
    pub fn share(self, off: usize) -> f32 {
        // An even number of cells ends in the middle of two.
        let halves = self.cells % 2 == 0 && off == self.reach() && off > 0;
        let part = 1.0 / self.cells.max(1) as f32;
        if halves { 0.5 * part } else { part }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deposit_is_spread_over_the_length_of_a_step() {
        for cells in 0..=8 {
            let spread = Spread { axis: 0, cells };
            let reach = spread.reach();
            assert!(reach <= REACH && (reach == 0) == (cells < 2));
            let sides: f32 = (1..=reach).map(|off| 2.0 * spread.share(off)).sum();
            assert!((sides + spread.share(0) - 1.0).abs() < 1e-6, "{cells}");
            // Its variance is that of a bar of so many cells, measured from cell to cell.
            let moment: f32 = (1..=reach)
                .map(|off| 2.0 * spread.share(off) * (off * off) as f32)
                .sum();
            let length = cells.max(1) as f32;
            assert!(
                (moment - (length * length - 1.0) / 12.0).abs() < 0.26,
                "{cells}: {moment}"
            );
        }
    }
}
