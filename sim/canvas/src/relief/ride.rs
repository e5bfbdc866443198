//! The ride of a bristle: the height at which it rests on the relief under it.
//!
//! A bristle is stiff along its length, so it bridges gaps narrower than its bend: its lower side is the upper envelope
//! of the relief under one curve (grey dilation, separable where the curve is a sum over both axes; van den Boomgaard
//! and Smeulders 1994). It hangs by d²/2ρ at a distance of d, and where its tip is free by (d − f)²/2ρ′ more: tooth is
//! bridged from thread to thread, and beside a cliff of .7 mm the tip is on the ground after .9 mm.

/// Radius of curvature to which a bristle bends under the hand, ρ, m.
const RADIUS_M: f64 = 28e-3;
/// Distance from its support beyond which a bristle is a free tip, f, m: half the way between two threads.
const FREE_M: f64 = 0.4e-3;
/// Radius of curvature of a free tip, ρ′, m.
const TIP_RADIUS_M: f64 = 0.15e-3;
/// Greatest distance over which a ridge carries a bristle, m.
pub const REACH_M: f64 = 1.5e-3;

/// How far a bristle hangs below its support at a distance of `off_m`, m.
fn hang_m(off_m: f64) -> f64 {
    let free = (off_m - FREE_M).max(0.0);
    off_m * off_m / (2.0 * RADIUS_M) + free * free / (2.0 * TIP_RADIUS_M)
}

/// Greatest distance over which a ridge carries a bristle, cells of `cell_m`.
#[must_use]
pub fn reach(cell_m: f64) -> usize {
    (REACH_M / cell_m).ceil() as usize
}

/// The ride over `base`, rows of `width` cells, both in cells; exact where the planes extend by [`reach`] cells on all
/// sides.
#[must_use]
pub fn ride(base: &[f32], width: usize, cells_per_m: f64) -> Vec<f32> {
    let (low, high) = base
        .iter()
        .fold((f32::MAX, f32::MIN), |(low, high), height| {
            (low.min(*height), high.max(*height))
        });
    let hangs = (1..=reach(1.0 / cells_per_m))
        .map(|d| (hang_m(d as f64 / cells_per_m) * cells_per_m) as f32)
        // Farther off no peak carries a bristle over the lowest cell.
        .take_while(|hang| *hang < high - low);
    let hangs: Vec<f32> = hangs.collect();
    let mut across = base.to_vec();
    for (row, out) in base.chunks_exact(width).zip(across.chunks_exact_mut(width)) {
        for (d, drop) in (1..width).zip(hangs.iter().copied()) {
            raise(&mut out[d..], &row[..width - d], drop);
            raise(&mut out[..width - d], &row[d..], drop);
        }
    }
    let mut up = across.clone();
    for (d, drop) in (1..).zip(hangs) {
        let off = d * width;
        if off < up.len() {
            raise(&mut up[off..], &across[..across.len() - off], drop);
            let end = across.len() - off;
            raise(&mut up[..end], &across[off..], drop);
        }
    }
    up
}

fn raise(heights: &mut [f32], others: &[f32], drop: f32) {
    for (height, other) in heights.iter_mut().zip(others) {
        let carried = other - drop;
        *height = if carried > *height { carried } else { *height };
    }
}
