//! Heights and their slopes.

/// A plane of heights.
#[derive(Clone, Copy, Debug)]
pub struct HeightField<'a> {
    /// m, row after row from the lowest.
    pub heights: &'a [f32],
    /// Cells across and up.
    pub cells: [usize; 2],
    /// Side of a cell, m.
    pub cell_m: f32,
}

impl HeightField<'_> {
    /// ∂h/∂x and ∂h/∂y at a cell: central differences, one-sided at the border, 0 where the plane
    /// is one cell wide.
    #[must_use]
    pub fn slope(&self, x: usize, y: usize) -> [f32; 2] {
        let [width, height] = self.cells;
        let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
        let (below, above) = (y.saturating_sub(1), (y + 1).min(height - 1));
        let at = |x: usize, y: usize| self.heights[y * width + x];
        let span = |cells: usize| cells.max(1) as f32 * self.cell_m;
        [
            (at(right, y) - at(left, y)) / span(right - left),
            (at(x, above) - at(x, below)) / span(above - below),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_beyond_the_border_are_not_guessed() {
        let heights = [0.0, 1.0, 3.0, 0.0, 1.0, 3.0];
        let field = HeightField {
            heights: &heights,
            cells: [3, 2],
            cell_m: 2.0,
        };
        let rises = [0, 1, 2].map(|x| field.slope(x, 0)[0]);
        assert_eq!(rises, [0.5, 0.75, 1.0]);
        let one = HeightField {
            heights: &heights[..1],
            cells: [1, 1],
            cell_m: 2.0,
        };
        assert_eq!(one.slope(0, 0), [0.0; 2]);
    }
}
