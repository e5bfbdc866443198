//! Heights with bounded slope and curvature, at which no device shakes.
//!
//! Steps become ramps beside the higher side (the upper envelope under pyramids of the greatest slope, as a bristle
//! rests on peaks). Binomial filters then reduce the curvature, like a head that rests on several millimetres at once,
//! and any remaining excess is scaled down. Each of these depends continuously on the heights.

use super::{Heights, SIDE};

/// Greatest slope along each axis.
const SLOPE_MOST: f64 = 0.5;
/// Greatest curvature, 1/m: a ridge of 5 mm may be .5 mm high.
const CURVATURE_MOST: f64 = 200.0;
/// Greatest number of binomial filters.
const FILTERS: usize = 8;

/// The heights with bounded slope and curvature.
pub(super) fn smoothed(heights: &Heights, cell_m: f64) -> Heights {
    let mut heights = enveloped(heights, SLOPE_MOST * cell_m);
    let mut sharp = curvature(&heights, cell_m);
    if sharp <= CURVATURE_MOST {
        return heights;
    }
    for _ in 0..FILTERS {
        let softer = filtered(&heights);
        let soft = curvature(&softer, cell_m);
        if soft <= CURVATURE_MOST {
            // The least share of the last filter that suffices.
            let share = (sharp - CURVATURE_MOST) / (sharp - soft);
            return mixed(&heights, &softer, share);
        }
        (heights, sharp) = (softer, soft);
    }
    mixed(&heights, &[[0.0; SIDE]; SIDE], 1.0 - CURVATURE_MOST / sharp)
}

/// Bound of |∇h|: each derivative of a B-spline is a mean of differences.
pub(super) fn slope(heights: &Heights, cell_m: f64) -> f64 {
    let greatest = |heights: &Heights| {
        let pairs = heights.iter().flat_map(|row| row.windows(2));
        pairs.fold(0.0, |most: f64, pair| most.max((pair[1] - pair[0]).abs()))
    };
    let [x, y] = [greatest(heights), greatest(&turned(heights))];
    (x * x + y * y).sqrt() / cell_m
}

/// Bound of the greatest curvature, 1/m: second derivatives are means of second differences, and the eigenvalues of
/// [[a, b], [b, d]] are at most the larger of |a| and |d|, and |b|, together.
pub(super) fn curvature(heights: &Heights, cell_m: f64) -> f64 {
    let bent = |heights: &Heights| {
        let bends = heights.iter().flat_map(|row| {
            (0..SIDE).map(|i| {
                let [last, next] = beside(i);
                (row[last] - 2.0 * row[i] + row[next]).abs()
            })
        });
        bends.fold(0.0, f64::max)
    };
    let straight = bent(heights).max(bent(&turned(heights)));
    let twists = heights.windows(2).flat_map(|rows| {
        let pairs = rows[0].windows(2).zip(rows[1].windows(2));
        pairs.map(|(low, high)| (low[0] - low[1] - high[0] + high[1]).abs())
    });
    (straight + twists.fold(0.0, f64::max)) / (cell_m * cell_m)
}

/// Neighbouring cells; beyond the edge the outermost continues.
fn beside(i: usize) -> [usize; 2] {
    [i.saturating_sub(1), (i + 1).min(SIDE - 1)]
}

/// The lowest heights that are nowhere below `heights` and fall by at most `step` a cell.
fn enveloped(heights: &Heights, step: f64) -> Heights {
    let mut heights = *heights;
    for _ in 0..2 {
        for row in &mut heights {
            for i in 1..SIDE {
                row[i] = row[i].max(row[i - 1] - step);
            }
            for i in (1..SIDE).rev() {
                row[i - 1] = row[i - 1].max(row[i] - step);
            }
        }
        heights = turned(&heights);
    }
    heights
}

/// The binomial filter ¼, ½, ¼ along rows and columns.
fn filtered(heights: &Heights) -> Heights {
    let mut heights = *heights;
    for _ in 0..2 {
        for row in &mut heights {
            let before = *row;
            for (i, height) in row.iter_mut().enumerate() {
                let [last, next] = beside(i);
                *height = 0.25 * before[last] + 0.5 * before[i] + 0.25 * before[next];
            }
        }
        heights = turned(&heights);
    }
    heights
}

fn turned(heights: &Heights) -> Heights {
    std::array::from_fn(|j| std::array::from_fn(|i| heights[i][j]))
}

/// Interpolation between heights by `share`.
fn mixed(from: &Heights, to: &Heights, share: f64) -> Heights {
    std::array::from_fn(|j| std::array::from_fn(|i| from[j][i] + share * (to[j][i] - from[j][i])))
}
