//! Relative height field (Baxter 2004, § 4.8): the height of dried paint as differences between neighbours, a byte
//! each.
//!
//! absheight(i, j) = h(i, j) + absheight(i − 1, j), and absheight(0, j) = h(0, j) + absheight(0, j − 1): the sums that
//! the text leaves out. Differences beyond a byte are in a separate table, so that any height is exact.

use std::collections::BTreeMap;

use crate::volume::units;

/// Heights of a grid of cells in units, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RelativeHeights {
    columns: usize,
    differences: Vec<i8>,
    /// Differences that do not fit a byte, by cell.
    beyond: BTreeMap<usize, i64>,
}

impl RelativeHeights {
    /// Heights before any drying.
    #[must_use]
    pub fn level(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            differences: vec![0; columns * rows],
            beyond: BTreeMap::new(),
        }
    }

    /// Dries `quanta` of wet paint on a cell: whole units, at most 255. Absent cells and negative amounts are ignored.
    pub fn dry(&mut self, cell: usize, quanta: f32) {
        let by = i64::from(units(quanta));
        if cell >= self.differences.len() || by == 0 {
            return;
        }
        self.add(cell, by);
        // The cells whose height is derived from this one.
        if !(cell + 1).is_multiple_of(self.columns) {
            self.add(cell + 1, -by);
        }
        let above = cell + self.columns;
        if cell.is_multiple_of(self.columns) && above < self.differences.len() {
            self.add(above, -by);
        }
    }

    fn difference(&self, cell: usize) -> i64 {
        let beyond = self.beyond.get(&cell);
        beyond.copied().unwrap_or(i64::from(self.differences[cell]))
    }

    fn add(&mut self, cell: usize, by: i64) {
        let sum = self.difference(cell) + by;
        self.beyond.remove(&cell);
        self.differences[cell] = match i8::try_from(sum) {
            Ok(byte) => byte,
            Err(_) => {
                self.beyond.insert(cell, sum);
                0
            }
        };
    }

    /// Heights of all cells, units.
    #[must_use]
    pub fn absolute(&self) -> Vec<i64> {
        let mut heights: Vec<i64> = Vec::with_capacity(self.differences.len());
        for cell in 0..self.differences.len() {
            let neighbour = match cell % self.columns {
                0 => cell.checked_sub(self.columns),
                _ => Some(cell - 1),
            };
            let under = neighbour.map_or(0, |neighbour| heights[neighbour]);
            heights.push(under + self.difference(cell));
        }
        heights
    }

    /// Number of differences beyond a byte.
    #[must_use]
    pub fn beyond(&self) -> usize {
        self.beyond.len()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::volume::UNIT;

    proptest! {
        #[test]
        fn heights_come_back_after_random_drying(
            dried in prop::collection::vec((0..77usize, -3.0..400.0f32), 0..400),
        ) {
            let mut field = RelativeHeights::level(11, 7);
            let mut heights = vec![0i64; 77];
            for (cell, volume) in dried {
                field.dry(cell, volume * UNIT);
                heights[cell] += (volume as i64).clamp(0, 255);
            }
            prop_assert_eq!(field.absolute(), heights);
        }
    }

    /// As printed, a height is the sum of two differences.
    #[test]
    fn the_printed_recursion_would_be_found() {
        let mut field = RelativeHeights::level(5, 1);
        field.dry(1, 9.0 * UNIT);
        let printed = field.difference(3) + field.difference(2);
        assert_eq!((field.absolute()[3], printed), (0, -9));
    }

    #[test]
    fn steep_steps_lie_in_the_table_and_leave_it_again() {
        let mut field = RelativeHeights::level(4, 3);
        (0..3).for_each(|_| field.dry(5, 200.0 * UNIT));
        assert_eq!((field.absolute()[5], field.beyond()), (600, 2));
        (0..3).for_each(|_| field.dry(6, 200.0 * UNIT));
        assert_eq!((field.absolute()[6], field.beyond()), (600, 2));
        (0..3).for_each(|_| field.dry(7, 200.0 * UNIT));
        assert_eq!((field.absolute()[7], field.beyond()), (600, 1));
        let before = field.clone();
        field.dry(12, 100.0 * UNIT);
        field.dry(3, -100.0 * UNIT);
        assert_eq!(field, before, "beside the grid, and below nothing");
    }
}
