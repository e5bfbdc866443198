//! Grid of vertices over a surface.

/// Grid of vertices in the middles of blocks of `step` cells a side, counted from the lower left corner, and on the
/// surface's rim beside them. A vertex has the column of its block's highest cell, so no peak is lost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    cells: [usize; 2],
    step: usize,
}

impl Grid {
    /// The grid over a surface of `cells`; `step` is 1 or more.
    pub(crate) fn new(cells: [usize; 2], step: usize) -> Self {
        Self { cells, step }
    }

    /// Spaces between vertices, across and up.
    pub(crate) fn spaces(&self) -> [usize; 2] {
        self.cells.map(|cells| cells.div_ceil(self.step) + 1)
    }

    /// Cells across.
    pub(super) fn width(&self) -> usize {
        self.cells[0]
    }

    /// Cells from vertex to vertex.
    pub(super) fn step(&self) -> usize {
        self.step
    }

    /// Number of triangles of the closed solid without paint over air: two a space on top, two a space around and one
    /// under it.
    pub(crate) fn triangles(&self) -> u64 {
        let [across, up] = self.spaces().map(|spaces| spaces as u64);
        2 * across * up + 6 * (across + up)
    }

    /// Place of a vertex along an axis, cells.
    pub(crate) fn at(&self, axis: usize, vertex: usize) -> f64 {
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
