//! Deposit along a step.
//!
//! A step is up to several cells long, but its head is drawn once, in the middle. What a texel gives to a cell it gives
//! along the step, so it is spread evenly over as many cells; otherwise rows of cells would alternate with the bristle
//! that leaves them last.

use maulstick_canvas::quantum::CELL_MAX;

use crate::interface::{Step, Transfer};

/// Largest number of cells to one side.
pub const REACH: usize = 4;

/// Distribution of a deposit over cells in a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// The axis along which it is longer: 0 x, 1 y.
    pub axis: u32,
    /// Its length along that axis, cells; 0 for a deposit on one cell.
    pub cells: u32,
    /// Cells along the other axis in [`SLOPES`] cells along this one.
    pub slope: i32,
}

/// Steps of a slope.
pub const SLOPES: i32 = 64;

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
        let way = [way(&from.x, &to.x), way(&from.y, &to.y)];
        let axis = usize::from(way[1].abs() > way[0].abs());
        let slope = way[1 - axis] / way[axis];
        if !slope.is_finite() {
            return Self::default();
        }
        // Where painting falls behind, steps become longer, but not what is seen of them.
        let usual = 1.0 / step.traits.cell_per_reference;
        let length = step.traits.step_cells.min(usual) / (1.0 + slope * slope).sqrt();
        let cells = (length.round() as u32).min(2 * REACH as u32);
        // A longer step on coarse cells draws its head over a cell's neighbours itself.
        let drawn = cells == 1 && step.traits.step_cells > 1.5 * usual;
        Self {
            axis: axis as u32,
            cells: if drawn { 0 } else { cells },
            slope: (slope * SLOPES as f32).round() as i32,
        }
    }

    /// Number of cells to one side that get a part.
    #[must_use]
    pub fn reach(self) -> usize {
        self.cells.div_ceil(2) as usize
    }

    /// Columns and rows from a cell to the one that is `off` further ahead.
    #[must_use]
    pub fn offset(self, off: usize) -> [isize; 2] {
        let off = off as i32;
        let aside = (off * self.slope + SLOPES / 2).div_euclid(SLOPES);
        let [along, aside] = [off as isize, aside as isize];
        if self.axis == 0 {
            [along, aside]
        } else {
            [aside, along]
        }
    }

    /// Share of a deposit that a cell `off` > 0 cells to the side gets: of a bar whose middle may lie anywhere in its cell.
    #[must_use]
    pub fn share(self, off: usize) -> f32 {
        // Twice the distance from the end of a bar in the middle of its cell.
        let ahead = 2 * off as i32 - self.cells as i32;
        let covered = match ahead {
            ..=-2 => 1.0,
            -1 => 0.875,
            0 => 0.5,
            _ => 0.125,
        };
        covered / self.cells.max(1) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deposit_is_spread_over_the_length_of_a_step() {
        for cells in 0..=8 {
            let spread = Spread {
                cells,
                ..Spread::default()
            };
            let reach = spread.reach();
            assert!(reach <= REACH && (reach == 0) == (cells == 0));
            let sides: f32 = (1..=reach).map(|off| 2.0 * spread.share(off)).sum();
            let moment: f32 = (1..=reach)
                .map(|off| 2.0 * spread.share(off) * (off * off) as f32)
                .sum();
            // A bar's variance, that of its place and that of a place in the cell it falls on.
            let want = if reach > 0 {
                (cells * cells + 2) as f32 / 12.0
            } else {
                0.0
            };
            assert!(
                sides < 1.0 && (moment - want).abs() < 1e-5,
                "{cells}: {moment}"
            );
        }
    }

    #[test]
    fn a_spread_lies_along_the_step() {
        for (axis, slope, want) in [
            (0, 0, [3, 0]),
            (1, 0, [0, 3]),
            (0, SLOPES, [3, 3]),
            (1, -SLOPES, [-3, 3]),
            (0, SLOPES / 2, [3, 2]),
        ] {
            let spread = Spread {
                axis,
                cells: 8,
                slope,
            };
            assert_eq!(spread.offset(3), want);
        }
    }
}
