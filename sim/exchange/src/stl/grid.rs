//! Vertices over a surface, and their heights.

use maulstick_appearance::bands::{Banded, in_order};

use crate::ExchangeError;
use crate::surface::Steps;

/// Vertices in the middles of blocks of `step` cells a side, counted from the lower left corner, and on the
/// surface's edges beside them. The height of one is the highest of its block, so no peak is lost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    cells: [usize; 2],
    step: usize,
}

/// The highest of each block in a row of cells, m, with the row's number.
type Highest = (usize, Vec<f64>);

impl Grid {
    /// Over a surface of so many cells; `step` is 1 or more.
    pub(super) fn new(cells: [usize; 2], step: usize) -> Self {
        Self { cells, step }
    }

    /// Spaces between vertices, across and up.
    pub(super) fn spaces(&self) -> [usize; 2] {
        self.cells.map(|cells| cells.div_ceil(self.step) + 1)
    }

    /// Triangles of the closed solid: two a space on top, two a space around and one under it.
    pub(super) fn triangles(&self) -> u64 {
        let [across, up] = self.spaces().map(|spaces| spaces as u64);
        2 * across * up + 6 * (across + up)
    }

    /// Where a vertex is, cells.
    pub(super) fn at(&self, axis: usize, vertex: usize) -> f64 {
        let cells = self.cells[axis];
        let Some(block) = vertex.checked_sub(1) else {
            return 0.0;
        };
        if vertex == self.spaces()[axis] {
            return cells as f64;
        }
        let end = (vertex * self.step).min(cells);
        0.5 * (block * self.step + end) as f64
    }

    /// Hands the heights of the vertices to `take`, m, row after row from the highest.
    pub(super) fn rows(
        &self,
        banded: &Banded<'_>,
        steps: &mut Steps<'_>,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), ExchangeError>,
    ) -> Result<(), ExchangeError> {
        let width = self.cells[0];
        let highest = |cells: &[f32]| cells.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let job = |band: usize| -> Vec<Highest> {
            let heights = banded.heights(band);
            let rows = banded.rows(band).zip(heights.chunks_exact(width)).rev();
            rows.map(|(y, row)| {
                let blocks = row.chunks(self.step).map(|cells| f64::from(highest(cells)));
                (y, blocks.collect())
            })
            .collect()
        };
        let up = self.spaces()[1];
        let mut block = vec![f64::NEG_INFINITY; self.spaces()[0] - 1];
        in_order(banded.bands(), job, |_, rows| {
            for (y, row) in rows {
                let pairs = block.iter_mut().zip(&row);
                pairs.for_each(|(most, height)| *most = most.max(*height));
                if y % self.step > 0 {
                    continue;
                }
                let edges = [block[0], block[block.len() - 1]];
                let row = [&edges[..1], &block, &edges[1..]].concat();
                let vertex = y / self.step + 1;
                if vertex + 1 == up {
                    take(up, &row)?;
                }
                take(vertex, &row)?;
                if vertex == 1 {
                    take(0, &row)?;
                }
                block.fill(f64::NEG_INFINITY);
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
    fn vertices_rise_from_edge_to_edge() {
        for (cells, step) in [(1, 1), (7, 1), (7, 2), (7, 3), (64, 5), (65, 64), (3, 100)] {
            let grid = Grid::new([cells, 1], step);
            let spaces = grid.spaces()[0];
            let at: Vec<f64> = (0..=spaces).map(|vertex| grid.at(0, vertex)).collect();
            assert_eq!((at[0], at[spaces]), (0.0, cells as f64));
            assert!(at.windows(2).all(|two| two[0] < two[1]), "{at:?}");
        }
        assert_eq!(
            Grid::new([5, 1], 2).at(0, 3),
            4.5,
            "the middle of the last cell"
        );
    }
}
