//! Transfer between a grid and one half as fine, one axis after the other.
//!
//! Coarse cell C covers the fine cells 2C and 2C + 1. Along the axis across which a component's faces lie, coarse face C is
//! the fine face 2C, so values there are interpolated between nodes; everywhere else between middles of cells.
//!
//! Fields are wrapped on both sides, so the values of layers beyond the sides are right too.

use std::ops::Range;

use maulstick_num::wide;

use crate::grid::{Ends, Grid};

/// Positions of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Along {
    /// In the middle of cells.
    Middles,
    Faces,
}

/// Weights of the four fine places around a coarse one, from the second before its first child on.
pub(crate) type Weights = [f32; 4];

impl Along {
    /// Weights of the restriction, the adjoint of the interpolation.
    pub(crate) const fn restriction(self) -> Weights {
        match self {
            Self::Middles => [0.25, 0.75, 0.75, 0.25],
            Self::Faces => [0.5, 1.0, 0.5, 0.0],
        }
    }

    /// The sum over a coarse cell's volume.
    pub(crate) const fn sum(self) -> Weights {
        match self {
            Self::Middles => [0.0, 1.0, 1.0, 0.0],
            Self::Faces => [0.5, 1.0, 0.5, 0.0],
        }
    }

    /// The link of a coarse place with the one before it: fine ones in series.
    pub(crate) const fn link(self) -> Weights {
        match self {
            Self::Middles => [0.0, 0.5, 0.0, 0.0],
            Self::Faces => [0.25, 0.25, 0.0, 0.0],
        }
    }

    /// Weights of the children.
    pub(crate) const fn children(self) -> Weights {
        match self {
            Self::Middles => [0.0, 1.0, 1.0, 0.0],
            Self::Faces => [0.0, 1.0, 0.0, 0.0],
        }
    }

    /// The two coarse layers beside a fine one, and their weights.
    const fn beside(self, at: usize) -> ([usize; 2], [f32; 2]) {
        match (self, at % 2) {
            (Self::Middles, 1) => ([at.div_ceil(2), at / 2], [0.75, 0.25]),
            (Self::Middles, _) => ([at / 2, at / 2 + 1], [0.75, 0.25]),
            (Self::Faces, 1) => ([at.div_ceil(2), at.div_ceil(2)], [1.0, 0.0]),
            (Self::Faces, _) => ([at / 2, at / 2 + 1], [0.5, 0.5]),
        }
    }
}

/// A grid half as fine along one axis.
pub(crate) fn halved(grid: &Grid, axis: usize) -> Grid {
    let mut coarse = *grid;
    coarse.cells[axis] = grid.cells[axis].div_ceil(2);
    coarse
}

/// True if an axis can be halved: a periodic one must have an even number of cells.
pub(crate) fn can_halve(grid: &Grid, axis: usize) -> bool {
    let cells = grid.cells[axis];
    cells > 1 && (cells.is_multiple_of(2) || grid.ends[axis] != Ends::Periodic)
}

/// Layers of the two upper axes, y and z, counted from the first of the field.
pub(crate) type Layers = [Range<usize>; 2];

/// Layers of a coarse grid's cells and upper faces.
pub(crate) fn all_layers(grid: &Grid) -> Layers {
    [1, 2].map(|axis| 1..grid.cells[axis] + 2)
}

wide! {
    fn weigh(into: &mut [f32], weights: Weights, a: &[f32], b: &[f32], c: &[f32], d: &[f32]) {
        let n = into.len();
        let (a, b, c, d) = (&a[..n], &b[..n], &c[..n], &d[..n]);
        for i in 0..n {
            into[i] = (weights[0] * a[i] + weights[1] * b[i]) + (weights[2] * c[i] + weights[3] * d[i]);
        }
    }
}

wide! {
    /// Weighted sums along a row.
    fn weigh_row(into: &mut [f32], weights: Weights, from: &[f32]) {
        let last = into.len() - 2;
        let pairs = from.as_chunks::<2>().0;
        let (low, high) = (&pairs[..last - 1], &pairs[1..last]);
        let cells = &mut into[1..last];
        for i in 0..cells.len() {
            let ([a, b], [c, d]) = (low[i], high[i]);
            cells[i] = (weights[0] * a + weights[1] * b) + (weights[2] * c + weights[3] * d);
        }
        // Above the last cell.
        let places = from[2 * last - 2..].iter().zip(weights);
        into[last] = places.map(|(value, weight)| weight * value).sum();
    }
}

wide! {
    /// Both fine places of each coarse one of a row: weights of those before, at and after it.
    fn mix_row(into: &mut [f32], weights: [[f32; 3]; 2], row: &[f32], pairs: usize) {
        let count = pairs.next_multiple_of(LANES).min((into.len() - 1) / 2).min(row.len() - 2);
        let (before, at, after) = (&row[..count], &row[1..count + 1], &row[2..count + 2]);
        let pairs = &mut into[1..].as_chunks_mut::<2>().0[..count];
        let [low, high] = weights;
        for i in 0..count {
            let first = low[0] * before[i] + low[1] * at[i] + low[2] * after[i];
            let second = high[0] * before[i] + high[1] * at[i] + high[2] * after[i];
            pairs[i] = [first, second];
        }
    }
}

wide! {
    fn mix(into: &mut [f32], weights: [f32; 2], a: &[f32], b: &[f32]) {
        let n = into.len();
        let (a, b) = (&a[..n], &b[..n]);
        for i in 0..n {
            into[i] = weights[0] * a[i] + weights[1] * b[i];
        }
    }
}

wide! {
    fn add_mixed(into: &mut [f32], scale: &[f32], weights: [f32; 2], a: &[f32], b: &[f32]) {
        let n = into.len();
        let (a, b, scale) = (&a[..n], &b[..n], &scale[..n]);
        for i in 0..n {
            into[i] += scale[i] * (weights[0] * a[i] + weights[1] * b[i]);
        }
    }
}

/// Fine layers around a coarse one: the second before its first child and on. Beyond the last one all weights are zero.
fn four(at: usize, cells: usize) -> [usize; 4] {
    [2 * at - 2, 2 * at - 1, 2 * at, 2 * at + 1].map(|at| at.min(cells + 2))
}

/// Number of values processed together in rows: values behind a row's end are overwritten by the next row.
const LANES: usize = 16;

/// The beginnings of rows of a common length, rounded up to [`LANES`] at most.
fn padded<'a, const N: usize>(
    width: usize,
    into: &'a mut [f32],
    rows: [&'a [f32]; N],
) -> (&'a mut [f32], [&'a [f32]; N]) {
    let all = rows.iter().map(|row| row.len()).min().unwrap_or(width);
    let len = width.next_multiple_of(LANES).min(all).min(into.len());
    (&mut into[..len], rows.map(|row| &row[..len]))
}

/// Buffers between two grids: by z the field of the grid that is halved along z alone, by y along y and z.
pub(crate) struct Workspace<'a> {
    pub(crate) grids: &'a [Grid; 3],
    pub(crate) by_z: &'a mut [f32],
    pub(crate) by_y: &'a mut [f32],
}

impl Workspace<'_> {
    /// Interpolates rows of a coarse plane along x, into the field that is halved along y and z.
    fn mix_along_x(&mut self, along: Along, from: &[f32], rows: Range<usize>, z: usize) {
        let [_, y_grid, coarse] = self.grids;
        let width = y_grid.stride(1);
        let weights = match along {
            Along::Middles => [[0.25, 0.75, 0.0], [0.0, 0.75, 0.25]],
            Along::Faces => [[0.0, 1.0, 0.0], [0.0, 0.5, 0.5]],
        };
        for y in rows {
            let start = y * coarse.stride(1) + z * coarse.stride(2);
            let row = &from[start..];
            let start = y * width + z * y_grid.stride(2);
            let into = &mut self.by_y[start..];
            if y_grid.cells[0] != coarse.cells[0] {
                mix_row(into, weights, row, (width - 1) / 2);
            } else {
                into[..width].copy_from_slice(&row[..width]);
            }
        }
    }

    /// Interpolates the rows of a plane along y, into the field that is halved along z.
    fn mix_along_y(&mut self, along: Along, rows: Range<usize>, z: usize) {
        let [z_grid, y_grid, _] = self.grids;
        let width = z_grid.stride(1);
        let source = &self.by_y[z * y_grid.stride(2)..];
        for y in rows {
            let row = |y: usize| &source[y * width..];
            let start = y * width + z * z_grid.stride(2);
            let into = &mut self.by_z[start..];
            if z_grid.cells[1] != y_grid.cells[1] {
                let ([a, b], weights) = along.beside(y);
                let (into, [a, b]) = padded(width, into, [row(a), row(b)]);
                mix(into, weights, a, b);
            } else {
                into[..width].copy_from_slice(&row(y)[..width]);
            }
        }
    }
}

/// Sums over four fine places around each coarse one along each axis, for some layers of the coarse grid; the fine
/// field is wrapped.
pub(crate) fn gather(
    weights: [Weights; 3],
    (fine, from): (&Grid, &[f32]),
    into: &mut [f32],
    [rows, planes]: &Layers,
    workspace: &mut Workspace<'_>,
) {
    let [z_grid, y_grid, coarse] = workspace.grids;
    let (width, plane) = (fine.stride(1), fine.stride(2));
    let is_halved = |axis: usize| fine.cells[axis] != coarse.cells[axis];
    if rows.is_empty() {
        return;
    }
    // The fine rows that these need.
    let fine_rows = if is_halved(1) {
        2 * rows.start - 2..(2 * rows.end).min(fine.cells[1] + 3)
    } else {
        rows.clone()
    };
    let flat = fine_rows.start * width..fine_rows.end * width;
    for z in planes.clone() {
        let source = if is_halved(2) {
            let [a, b, c, d] =
                four(z, fine.cells[2]).map(|z| &from[z * plane + flat.start..z * plane + flat.end]);
            let start = z * z_grid.stride(2);
            weigh(
                &mut workspace.by_z[start + flat.start..start + flat.end],
                weights[2],
                a,
                b,
                c,
                d,
            );
            &workspace.by_z[start..]
        } else {
            &from[z * plane..]
        };
        for y in rows.clone() {
            let row = |y: usize| &source[y * width..];
            let start = y * y_grid.stride(1) + z * y_grid.stride(2);
            let row = if is_halved(1) {
                let four = four(y, fine.cells[1]).map(row);
                let (into, [a, b, c, d]) = padded(width, &mut workspace.by_y[start..], four);
                weigh(into, weights[1], a, b, c, d);
                &into[..width]
            } else {
                &row(y)[..width]
            };
            let start = y * coarse.stride(1) + z * coarse.stride(2);
            let into = &mut into[start..start + coarse.stride(1)];
            if is_halved(0) {
                weigh_row(into, weights[0], row);
            } else {
                into.copy_from_slice(row);
            }
        }
    }
}

/// Adds the interpolated values, times a scale, in some layers of the fine grid; the coarse field is wrapped.
pub(crate) fn spread(
    along: [Along; 3],
    from: &[f32],
    (fine, into, scale): (&Grid, &mut [f32], &[f32]),
    layers: &Layers,
    workspace: &mut Workspace<'_>,
) {
    let [rows, planes] = layers;
    let [z_grid, _, coarse] = workspace.grids;
    let is_halved = |axis: usize| fine.cells[axis] != coarse.cells[axis];
    if rows.is_empty() || planes.is_empty() {
        return;
    }
    // Coarse layers beside fine ones.
    let beside = |axis: usize, layers: &Range<usize>| {
        if is_halved(axis) {
            layers.start / 2..(layers.end - 1) / 2 + 2
        } else {
            layers.clone()
        }
    };
    let coarse_rows = beside(1, rows);
    for z in beside(2, planes) {
        workspace.mix_along_x(along[0], from, coarse_rows.clone(), z);
        workspace.mix_along_y(along[1], rows.clone(), z);
    }
    let width = fine.stride(1);
    let flat = rows.start * width..rows.end * width;
    for z in planes.clone() {
        let ([a, b], weights) = if is_halved(2) {
            along[2].beside(z)
        } else {
            ([z; 2], [1.0, 0.0])
        };
        let layer = |z: usize| {
            let start = z * z_grid.stride(2);
            &workspace.by_z[start + flat.start..start + flat.end]
        };
        let own = z * fine.stride(2) + flat.start..z * fine.stride(2) + flat.end;
        add_mixed(
            &mut into[own.clone()],
            &scale[own],
            weights,
            layer(a),
            layer(b),
        );
    }
}
