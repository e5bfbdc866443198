//! Vertices over a surface, and their heights.

use std::collections::VecDeque;
use std::ops::Range;

use maulstick_paint::bands::{Banded, in_order};

use crate::ExchangeError;
use crate::surface::Steps;

/// Vertices at the corners of cells: one each `step` cells from the lower left corner, and on the far
/// edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    cells: [usize; 2],
    step: usize,
}

/// Sums of heights at the vertices of a row of cells, with the row's number.
type Sums = (usize, Vec<f64>);

impl Grid {
    /// Over a surface of so many cells; `step` is 1 or more.
    pub(super) fn new(cells: [usize; 2], step: usize) -> Self {
        Self { cells, step }
    }

    /// Spaces between vertices, across and up.
    pub(super) fn spaces(&self) -> [usize; 2] {
        self.cells.map(|cells| cells.div_ceil(self.step))
    }

    /// Triangles of the closed solid: two a space on top, two a space around and one under it.
    pub(super) fn triangles(&self) -> u64 {
        let [across, up] = self.spaces().map(|spaces| spaces as u64);
        2 * across * up + 6 * (across + up)
    }

    /// Where a vertex is, cells.
    pub(super) fn at(&self, axis: usize, vertex: usize) -> usize {
        (vertex * self.step).min(self.cells[axis])
    }

    /// The cells within half a step of a vertex, at least those that meet there.
    fn around(&self, axis: usize, vertex: usize) -> Range<usize> {
        let (at, half) = (self.at(axis, vertex), self.step.div_ceil(2));
        at.saturating_sub(half)..(at + half).min(self.cells[axis])
    }

    /// For each vertex of a row the sum over the cells around it.
    fn across(&self, row: &[f32]) -> Vec<f64> {
        let mut before = Vec::with_capacity(row.len() + 1);
        let mut sum = 0.0;
        before.push(sum);
        before.extend(row.iter().map(|height| {
            sum += f64::from(*height);
            sum
        }));
        let around = (0..=self.spaces()[0]).map(|vertex| self.around(0, vertex));
        around
            .map(|cells| before[cells.end] - before[cells.start])
            .collect()
    }

    /// Hands the heights of the vertices to `take`, m, row after row from the highest: means over the
    /// cells around them.
    pub(super) fn rows(
        &self,
        banded: &Banded<'_>,
        steps: &mut Steps<'_>,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), ExchangeError>,
    ) -> Result<(), ExchangeError> {
        let width = self.cells[0];
        let job = |band: usize| -> Vec<Sums> {
            let heights = banded.heights(band);
            let rows = banded.rows(band).zip(heights.chunks_exact(width));
            rows.rev().map(|(y, row)| (y, self.across(row))).collect()
        };
        let columns: Vec<f64> = (0..=self.spaces()[0])
            .map(|vertex| self.around(0, vertex).len() as f64)
            .collect();
        let mut open: VecDeque<Sums> = VecDeque::new();
        let mut next = Some(self.spaces()[1]);
        in_order(banded.bands(), job, |_, sums| {
            for (y, sums) in sums {
                open.push_back((y, sums));
                while let Some(vertex) = next
                    && self.around(1, vertex).start == y
                {
                    let around = self.around(1, vertex);
                    while open.front().is_some_and(|(y, _)| *y >= around.end) {
                        open.pop_front();
                    }
                    let mut row = vec![0.0; columns.len()];
                    for (_, sums) in &open {
                        row.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum);
                    }
                    let cells = columns.iter().map(|cells| cells * around.len() as f64);
                    row.iter_mut()
                        .zip(cells)
                        .for_each(|(sum, cells)| *sum /= cells);
                    take(vertex, &row)?;
                    next = vertex.checked_sub(1);
                }
            }
            steps.step();
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_counts_and_the_edges_are_met() {
        for (cells, step) in [(1, 1), (7, 1), (7, 2), (7, 3), (64, 5), (65, 64), (3, 100)] {
            let grid = Grid::new([cells, 1], step);
            let spaces = grid.spaces()[0];
            assert_eq!((grid.at(0, 0), grid.at(0, spaces)), (0, cells));
            let mut met = vec![0; cells];
            for vertex in 0..=spaces {
                let around = grid.around(0, vertex);
                assert!(!around.is_empty());
                around.for_each(|cell| met[cell] += 1);
            }
            assert!(met.iter().all(|times| (1..=2).contains(times)), "{met:?}");
        }
    }
}
