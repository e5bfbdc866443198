//! Between a grid and one half as fine, one axis after the other.
//!
//! Coarse cell C covers the fine cells 2C and 2C + 1. Along the axis across which a component's faces lie, coarse face C is
//! the fine face 2C, so values there are interpolated between nodes; everywhere else between middles of cells.

use maulstick_num::wide;

use crate::grid::{Ends, Grid};

/// Where values lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Along {
    /// In the middle of cells.
    Middles,
    /// On faces.
    Faces,
}

/// Weights of the four fine places around a coarse one, from the second before its first child on.
pub(crate) type Weights = [f32; 4];

impl Along {
    /// Adjoint of interpolation.
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

    /// Children.
    pub(crate) const fn children(self) -> Weights {
        match self {
            Self::Middles => [0.0, 1.0, 1.0, 0.0],
            Self::Faces => [0.0, 1.0, 0.0, 0.0],
        }
    }
}

/// A grid half as fine along one axis.
pub(crate) fn halved(grid: &Grid, axis: usize) -> Grid {
    let mut coarse = *grid;
    coarse.cells[axis] = grid.cells[axis].div_ceil(2);
    coarse
}

/// True if an axis can be halved: what is periodic must have an even number of cells.
pub(crate) fn can_halve(grid: &Grid, axis: usize) -> bool {
    let cells = grid.cells[axis];
    cells > 1 && (cells.is_multiple_of(2) || grid.ends[axis] != Ends::Periodic)
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
    /// The same along a row.
    fn weigh_row(into: &mut [f32], weights: Weights, from: &[f32]) {
        let last = into.len() - 2;
        let pairs = from.as_chunks::<2>().0;
        for (two, into) in pairs.windows(2).zip(&mut into[1..last]) {
            let ([a, b], [c, d]) = (two[0], two[1]);
            *into = (weights[0] * a + weights[1] * b) + (weights[2] * c + weights[3] * d);
        }
        // Above the last cell.
        let places = from[2 * last - 2..].iter().zip(weights);
        into[last] = places.map(|(value, weight)| weight * value).sum();
    }
}

wide! {
    /// Both fine places of each coarse one of a row: weights of those before, at and after it.
    fn mix_row(into: &mut [f32], weights: [[f32; 3]; 2], row: &[f32]) {
        let count = (into.len() - 1) / 2;
        let pairs = into[1..].as_chunks_mut::<2>().0;
        let around = row.windows(3).take(count);
        for (pair, around) in pairs.iter_mut().zip(around) {
            let [low, high] = weights;
            pair[0] = low[0] * around[0] + low[1] * around[1] + low[2] * around[2];
            pair[1] = high[0] * around[0] + high[1] * around[1] + high[2] * around[2];
        }
    }
}

/// Sums over four fine places around each coarse one along an axis; the fine field is wrapped.
pub(crate) fn gather(
    axis: usize,
    weights: Weights,
    (fine, from): (&Grid, &[f32]),
    (coarse, into): (&Grid, &mut [f32]),
) {
    if fine.cells == coarse.cells {
        return into.copy_from_slice(from);
    }
    let [rows, planes] = [1, 2].map(|axis| coarse.cells[axis] + 3);
    let [width, width_from] = [coarse.stride(1), fine.stride(1)];
    let halves = |a: usize, at: usize| if a == axis { 2 * at - 2 } else { at };
    for z in 1..planes - 1 {
        for y in 1..rows - 1 {
            let to = y * coarse.stride(1) + z * coarse.stride(2);
            let first = halves(1, y) * fine.stride(1) + halves(2, z) * fine.stride(2);
            let into = &mut into[to..to + width];
            if axis == 0 {
                weigh_row(into, weights, &from[first..first + width_from]);
            } else {
                let step = fine.stride(axis);
                let row = |i: usize| {
                    let at = first + i * step;
                    // Beyond the last layer there is nothing that has weight.
                    let at = if at + width > from.len() { first } else { at };
                    &from[at..at + width]
                };
                weigh(into, weights, row(0), row(1), row(2), row(3));
            }
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

/// Interpolates along an axis; the coarse field is wrapped.
pub(crate) fn spread(
    axis: usize,
    along: Along,
    (coarse, from): (&Grid, &[f32]),
    (fine, into): (&Grid, &mut [f32]),
) {
    if fine.cells == coarse.cells {
        return into.copy_from_slice(from);
    }
    // A fine place at `at` lies beside coarse ones, with these weights.
    let beside = |at: usize| match (along, at % 2) {
        (Along::Middles, 1) => ([at.div_ceil(2), at / 2], [0.75, 0.25]),
        (Along::Middles, _) => ([at / 2, at / 2 + 1], [0.75, 0.25]),
        (Along::Faces, 1) => ([at.div_ceil(2), at.div_ceil(2)], [1.0, 0.0]),
        (Along::Faces, _) => ([at / 2, at / 2 + 1], [0.5, 0.5]),
    };
    let [columns, rows, planes] = fine.cells.map(|cells| cells + 3);
    let width = coarse.stride(1);
    for z in 1..planes - 1 {
        for y in 1..rows - 1 {
            let to = y * fine.stride(1) + z * fine.stride(2);
            let into = &mut into[to..to + columns];
            if axis == 0 {
                let first = y * width + z * coarse.stride(2);
                let row = &from[first..first + width];
                let weights = match along {
                    Along::Middles => [[0.25, 0.75, 0.0], [0.0, 0.75, 0.25]],
                    Along::Faces => [[0.0, 1.0, 0.0], [0.0, 0.5, 0.5]],
                };
                mix_row(into, weights, row);
            } else {
                let ([a, b], weights) = beside(if axis == 1 { y } else { z });
                let other = if axis == 1 { z } else { y };
                let step = coarse.stride(3 - axis);
                let row = |at: usize| {
                    let first = at * coarse.stride(axis) + other * step;
                    &from[first..first + width]
                };
                mix(into, weights, row(a), row(b));
            }
        }
    }
}
