//! The staggered grid of the bench: pressure in cells, velocities on their faces.

/// A rectangle of square cells with its lower left corner at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// Side of a cell, m.
    pub cell_m: f64,
}

impl Grid {
    /// Number of cells.
    pub(crate) fn count(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Faces across `axis`, along x and y.
    pub(crate) fn faces(&self, axis: usize) -> [usize; 2] {
        let [x, y] = self.cells;
        [x + usize::from(axis == 0), y + usize::from(axis == 1)]
    }

    /// Middle of a face across `axis`, m.
    pub(crate) fn face_m(&self, axis: usize, [i, j]: [usize; 2]) -> [f64; 2] {
        let half = |of: usize| if of == axis { 0.0 } else { 0.5 };
        [
            (i as f64 + half(0)) * self.cell_m,
            (j as f64 + half(1)) * self.cell_m,
        ]
    }

    /// The velocity across `axis` between its faces, bilinear, at a place; faces beyond the grid are like the last.
    pub(crate) fn sample(&self, axis: usize, values: &[f64], [x, y]: [f64; 2]) -> f64 {
        let [width, height] = self.faces(axis);
        let half = |of: usize| if of == axis { 0.0 } else { 0.5 };
        let split = |at: f64, of: usize, count: usize| {
            let at = (at / self.cell_m - half(of)).clamp(0.0, (count - 1) as f64);
            let whole = (at as usize).min(count.saturating_sub(2));
            (whole, at - whole as f64)
        };
        let (i, s) = split(x, 0, width);
        let (j, t) = split(y, 1, height);
        let row = |j: usize| {
            let at = j * width + i;
            values[at] * (1.0 - s) + values[at + 1] * s
        };
        row(j) * (1.0 - t) + row(j + 1) * t
    }
}
