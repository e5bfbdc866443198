//! Relief under the brush: heights over a plane, evaluated at the tip a thousand times a second.
//!
//! The heights are coefficients of a uniform cubic B-spline h(x), so height, slope and curvature are continuous, also across
//! the patch's edge, beyond which the outermost heights continue. The contact force is −∇U of
//!
//! ```text
//! U = Φ₁(d + h) + Φ₂(d)        f = N₁(d + h)·(n − ∇h) + N₂(d)·n
//! ```
//!
//! with d the depth below the plane, N the force of the law and N = N₁ + N₂, N₁ = G·(1 − e^(−N/G)): relief acts on
//! about the first newton of a force, and harder pressure feels the plane. As U is a potential, a closed path gains
//! nothing. The Hessian of U is at most
//!
//! ```text
//! (N₁' + N₂')·(n − ∇h)(n − ∇h)ᵀ + N₁·∇²h
//! ```
//!
//! so steep or sharply curved heights are smoothed on arrival, and the law is softened by the stiffness that slope and
//! curvature add ([`Relief::law_stiffness`]): nothing exceeds the device's bound.

mod smoothing;
#[cfg(test)]
pub(crate) mod tests;

use glam::DVec3;
use maulstick_num::exp;
use maulstick_types::haptics::{HeightPatch, heights_um};

use self::smoothing::{curvature, slope, smoothed};

/// Number of cells along a side.
const SIDE: usize = HeightPatch::SIDE;
/// Sides of a cell, m.
const CELLS_M: std::ops::RangeInclusive<f64> = 2.5e-4..=2.5e-2;
/// G: force up to which relief acts, N.
const LIGHT_N: f64 = 1.0;
/// Greatest stiffness by curvature, as a share of the device's greatest.
const CURVED: f64 = 0.4;

/// Heights by cell, m, row after row.
type Heights = [[f64; SIDE]; SIDE];

/// A height patch in the form that the servo evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    corner: DVec3,
    /// Unit vectors along a row, and from row to row.
    axes: [DVec3; 2],
    cell_m: f64,
    heights: Heights,
    /// Greatest slope and curvature, 1/m.
    slope: f64,
    curvature: f64,
    /// Depth of the lowest height below the plane, m.
    hollow_m: f64,
}

/// Height of the relief at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Height {
    /// Height over the plane, m.
    pub height_m: f64,
    /// ∇h, in the plane.
    pub slope: DVec3,
}

impl Relief {
    /// Converts a patch over a plane of unit `normal`, with heights multiplied by `share`, 0 to 1. `None` where it is
    /// flat.
    ///
    /// # Errors
    /// The fault: a number that is not finite, an axis that is not a unit vector in the plane, a cell that is
    /// not of .25 to 25 mm, a number of heights that is not 256, a height of more than 5 mm.
    pub fn new(
        patch: &HeightPatch,
        normal: DVec3,
        share: f64,
    ) -> Result<Option<Self>, &'static str> {
        if patch.is_flat() {
            return Ok(None);
        }
        let corner = DVec3::from_array(patch.corner_m);
        let along = DVec3::from_array(patch.along);
        if !corner.is_finite() || !along.is_finite() || !share.is_finite() {
            return Err("a number of the relief is not finite");
        }
        if (along.length() - 1.0).abs() > 1e-6 || along.dot(normal).abs() > 1e-6 {
            return Err("the relief's axis is not a unit vector in the plane");
        }
        if !CELLS_M.contains(&patch.cell_m) {
            return Err("a cell of the relief is not of .25 to 25 mm");
        }
        if patch.heights_um.len() != 2 * SIDE * SIDE {
            return Err("the relief has not got 256 heights");
        }
        let mut heights = [[0.0; SIDE]; SIDE];
        let cells = heights.iter_mut().flatten();
        for (height, um) in cells.zip(heights_um(&patch.heights_um)) {
            if um.unsigned_abs() > HeightPatch::MOST_UM.unsigned_abs() {
                return Err("a height of the relief is more than 5 mm");
            }
            *height = share.clamp(0.0, 1.0) * f64::from(um) * 1e-6;
        }
        let heights = smoothed(&heights, patch.cell_m);
        let lowest = heights.iter().flatten().copied().fold(0.0, f64::min);
        Ok(Some(Self {
            corner,
            axes: [along, normal.cross(along)],
            cell_m: patch.cell_m,
            slope: slope(&heights, patch.cell_m),
            curvature: curvature(&heights, patch.cell_m),
            hollow_m: -lowest,
            heights,
        }))
    }

    /// Factor on the heights that keeps a device of this greatest stiffness, N/m, within its bound.
    fn share(&self, max_stiffness: f64) -> f64 {
        let asked = LIGHT_N * self.curvature;
        if asked > CURVED * max_stiffness {
            CURVED * max_stiffness / asked
        } else {
            1.0
        }
    }

    /// Height and slope at the place of a tip, m, for a device of this greatest stiffness, N/m.
    #[must_use]
    pub fn at(&self, tip: DVec3, max_stiffness: f64) -> Height {
        let place = tip - self.corner;
        let [x, y] = self
            .axes
            .map(|axis| weights(axis.dot(place) / self.cell_m - 0.5));
        let (mut height, mut by_x, mut by_y) = (0.0, 0.0, 0.0);
        for j in 0..4 {
            let row = &self.heights[y.cells[j]];
            let (mut sum, mut slope) = (0.0, 0.0);
            for i in 0..4 {
                sum += x.values[i] * row[x.cells[i]];
                slope += x.slopes[i] * row[x.cells[i]];
            }
            height += y.values[j] * sum;
            by_x += y.values[j] * slope;
            by_y += y.slopes[j] * sum;
        }
        let share = self.share(max_stiffness);
        let slope = self.axes[0] * by_x + self.axes[1] * by_y;
        Height {
            height_m: share * height,
            slope: slope * (share / self.cell_m),
        }
    }

    /// Greatest stiffness of a law over this relief, N/m, with which nothing exceeds `max_stiffness`; `across` is that
    /// of friction at rest and grain, N/m.
    ///
    /// Of [[a, −a·s], [−a·s, a·s² + q]], law and curvature along the normal and along the slope, the greatest eigenvalue is at
    /// most K where a ≤ K·(K − q)/(K − q + K·s²). In hollows both parts of the law act at different depths, and add up to at
    /// most 2 − e^(−a·depth/G) times its stiffness.
    #[must_use]
    pub fn law_stiffness(&self, across: f64, max_stiffness: f64) -> f64 {
        if max_stiffness <= 0.0 {
            return 0.0;
        }
        let share = self.share(max_stiffness);
        let room = max_stiffness - share * self.curvature * LIGHT_N - across;
        let slope = share * self.slope;
        let most = max_stiffness * room / (room + max_stiffness * slope * slope);
        most / (2.0 - exp(-most * share * self.hollow_m / LIGHT_N))
    }
}

/// N₁ of a force, N, and its derivative by that force.
#[must_use]
pub fn light(force_n: f64) -> [f64; 2] {
    let left = exp(-force_n / LIGHT_N);
    [LIGHT_N * (1.0 - left), left]
}

/// First cell that acts at a place along an axis, and the values and derivatives of the B-splines.
struct Weights {
    cells: [usize; 4],
    values: [f64; 4],
    slopes: [f64; 4],
}

/// The uniform cubic B-splines at `x`, in cells from the middle of the first.
fn weights(x: f64) -> Weights {
    // From two cells beyond the edge on, only the outermost cell acts.
    let x = x.clamp(-2.0, SIDE as f64 + 1.0);
    let first = x.floor();
    let (t, u) = (x - first, 1.0 - (x - first));
    let cell = |k: i64| (first as i64 + k - 1).clamp(0, SIDE as i64 - 1) as usize;
    Weights {
        cells: [0, 1, 2, 3].map(cell),
        values: [
            u * u * u / 6.0,
            (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
            (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
            t * t * t / 6.0,
        ],
        slopes: [
            -0.5 * u * u,
            0.5 * t * (3.0 * t - 4.0),
            -0.5 * u * (3.0 * u - 4.0),
            0.5 * t * t,
        ],
    }
}
