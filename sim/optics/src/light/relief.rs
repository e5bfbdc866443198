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

impl<'a> HeightField<'a> {
    /// A row; beyond the border it is the border's.
    #[must_use]
    pub fn row(&self, y: i64) -> &'a [f32] {
        let [width, height] = self.cells;
        let at = y.clamp(0, height as i64 - 1) as usize;
        &self.heights[at * width..][..width]
    }

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

    /// Covariance Σ (xx, xy, yy) of the slopes about [`slope`](Self::slope) within a pixel's part of the cell and its
    /// neighbours: to first order slopes change by H·d at the offset d, H being the Hessian of the heights, and for
    /// offsets with a variance of half a cell² Σ = H·Hᵀ/2.
    #[must_use]
    pub fn spread(&self, x: usize, y: usize) -> [f32; 3] {
        let [below, row, above] = [-1, 0, 1].map(|dy| self.row(y as i64 + dy));
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.cells[0] - 1));
        let middle = 2.0 * row[x];
        let xx = row[left] + row[right] - middle;
        let yy = below[x] + above[x] - middle;
        let xy = 0.25 * (above[right] + below[left] - above[left] - below[right]);
        let scale = 0.5 / (self.cell_m * self.cell_m);
        [
            (xx * xx + xy * xy) * scale,
            (xx + yy) * xy * scale,
            (yy * yy + xy * xy) * scale,
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
        assert_eq!((one.slope(0, 0), one.spread(0, 0)), ([0.0; 2], [0.0; 3]));
    }

    #[test]
    fn slopes_spread_across_bristle_marks_and_not_along_them() {
        // Marks of two cells along y: the central differences are 0, and each cell has both flanks.
        const SIDE: usize = 6;
        let field = |height: fn(usize, usize) -> f32| {
            (0..SIDE * SIDE)
                .map(|i| height(i % SIDE, i / SIDE))
                .collect::<Vec<f32>>()
        };
        let at = |heights: &[f32]| {
            let field = HeightField {
                heights,
                cells: [SIDE, SIDE],
                cell_m: 2.0,
            };
            (field.slope(3, 3), field.spread(3, 3))
        };
        let (slope, spread) = at(&field(|x, _| (x % 2) as f32));
        assert_eq!(slope, [0.0; 2]);
        // Flanks of slope ±½ about a bend: twice their variance, for a pixel is wider than a cell.
        assert_eq!(spread, [0.5, 0.0, 0.0]);
        assert_eq!(
            at(&field(|x, y| (2 * x + y) as f32)).1,
            [0.0; 3],
            "a plane has one slope"
        );
        let [xx, xy, yy] = at(&field(|x, y| ((x + y) % 2) as f32)).1;
        assert!(xx == yy && xy == 0.0 && xx > 0.0);
    }
}
