//! A number a cell: cut, turned, averaged, compared.

use maulstick_types::paint::TILE;

/// Coordinates along and across a heading, about a place of the canvas.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Its origin on the canvas, mm.
    pub middle: [f64; 2],
    /// Angle of the first axis against the rows of cells, degrees.
    pub heading_deg: f64,
}

impl Frame {
    /// A place of the frame on the canvas, mm.
    #[must_use]
    pub fn place(&self, [along, across]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = maulstick_num::sin_cos(self.heading_deg.to_radians());
        [
            self.middle[0] + along * cosine - across * sine,
            self.middle[1] + along * sine + across * cosine,
        ]
    }
}

/// A number a cell, row after row from the bottom.
#[derive(Clone, Debug)]
pub struct Map {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Side of a cell, mm.
    pub cell_mm: f64,
    /// The numbers, row after row from the bottom.
    pub cells: Vec<f32>,
}

impl Map {
    pub(crate) fn new(size_mm: [f64; 2], cell_mm: f64) -> Self {
        let size = size_mm.map(|mm| (mm / cell_mm).round() as usize);
        Self {
            size,
            cell_mm,
            cells: vec![0.0; size[0] * size[1]],
        }
    }

    /// The same value in all cells.
    #[cfg(test)]
    pub fn level(size: [usize; 2], cell_mm: f64, value: f32) -> Self {
        Self {
            size,
            cell_mm,
            cells: vec![value; size[0] * size[1]],
        }
    }

    pub(crate) fn add(&mut self, tile: [u32; 2], plane: &[f32], scale: f32) {
        let [left, bottom] = tile.map(|place| place as usize * TILE);
        for (row, cells) in plane.chunks_exact(TILE).enumerate() {
            let y = bottom + row;
            if y >= self.size[1] {
                break;
            }
            let width = TILE.min(self.size[0].saturating_sub(left));
            let to = &mut self.cells[y * self.size[0] + left..][..width];
            to.iter_mut()
                .zip(cells)
                .for_each(|(to, value)| *to += value * scale);
        }
    }

    /// Cells of a rectangle in mm, as columns and rows.
    fn span(&self, from: [f64; 2], to: [f64; 2]) -> [std::ops::Range<usize>; 2] {
        let cell =
            |mm: f64, i: usize| ((mm / self.cell_mm).round().max(0.0) as usize).min(self.size[i]);
        [0, 1].map(|i| cell(from[i], i)..cell(to[i], i))
    }

    /// A rectangle in mm.
    pub fn cut(&self, from: [f64; 2], to: [f64; 2]) -> Self {
        let [across, up] = self.span(from, to);
        let size = [across.len(), up.len()];
        let rows = up.map(|y| &self.cells[y * self.size[0]..][across.clone()]);
        Self {
            size,
            cell_mm: self.cell_mm,
            cells: rows.flatten().copied().collect(),
        }
    }

    /// Value at a place, mm, between the middles of cells.
    #[must_use]
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let place = |mm: f64, i: usize| {
            let cell = (mm / self.cell_mm - 0.5).clamp(0.0, self.size[i] as f64 - 1.0);
            let low = (cell as usize).min(self.size[i].saturating_sub(2));
            (low, cell - low as f64)
        };
        let ((i, u), (j, v)) = (place(x, 0), place(y, 1));
        let of = |di: usize, dj: usize| {
            let [x, y] = [
                (i + di).min(self.size[0] - 1),
                (j + dj).min(self.size[1] - 1),
            ];
            f64::from(self.cells[y * self.size[0] + x])
        };
        let row = |dj: usize| of(0, dj) * (1.0 - u) + of(1, dj) * u;
        row(0) * (1.0 - v) + row(1) * v
    }

    /// A rectangle of a frame, mm: its columns lie along the frame's heading.
    #[must_use]
    pub fn turned(&self, frame: Frame, along: [f64; 2], across: [f64; 2]) -> Self {
        let size = [along, across].map(|[from, to]| ((to - from) / self.cell_mm).round() as usize);
        let cell = |i: usize, from: f64| from + (i as f64 + 0.5) * self.cell_mm;
        let cells = (0..size[0] * size[1]).map(|i| {
            let place = [cell(i % size[0], along[0]), cell(i / size[0], across[0])];
            self.at(frame.place(place)) as f32
        });
        Self {
            size,
            cell_mm: self.cell_mm,
            cells: cells.collect(),
        }
    }

    /// Less the mean of each row.
    pub fn less_rows(mut self) -> Self {
        let means = self.profile(1);
        for (row, mean) in self.cells.chunks_exact_mut(self.size[0]).zip(means) {
            row.iter_mut().for_each(|value| *value -= mean as f32);
        }
        self
    }

    /// Mean of all.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.cells.iter().map(|v| f64::from(*v)).sum::<f64>() / self.cells.len().max(1) as f64
    }

    /// Sum with another map of the same cells.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.cells
            .iter_mut()
            .zip(&other.cells)
            .for_each(|(a, b)| *a += b);
        sum
    }

    /// Means of the columns (0) or rows (1).
    pub fn profile(&self, axis: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.size[axis]];
        for (i, value) in self.cells.iter().enumerate() {
            let place = if axis == 0 {
                i % self.size[0]
            } else {
                i / self.size[0]
            };
            sums[place] += f64::from(*value);
        }
        let count = self.size[1 - axis] as f64;
        sums.iter().map(|sum| sum / count).collect()
    }
}

/// Slope of y by x, least squares.
pub fn slope(x: &[f32], y: &[f32]) -> f64 {
    let count = x.len() as f64;
    let mean = |v: &[f32]| v.iter().map(|v| f64::from(*v)).sum::<f64>() / count;
    let (mx, my) = (mean(x), mean(y));
    let (mut sxy, mut sxx) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        sxy += (f64::from(*x) - mx) * (f64::from(*y) - my);
        sxx += (f64::from(*x) - mx) * (f64::from(*x) - mx);
    }
    sxy / sxx
}

/// Correlation of two profiles.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len() as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / count, b.iter().sum::<f64>() / count);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        ab += (x - ma) * (y - mb);
        aa += (x - ma) * (x - ma);
        bb += (y - mb) * (y - mb);
    }
    ab / (aa * bb).sqrt()
}
