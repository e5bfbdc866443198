//! The ride of a bristle: the height at which it rests on the relief under it.
//!
//! A bristle is stiff along its length, so it bridges gaps narrower than its bend: its lower side is the upper envelope
//! of the relief under parabolas of one radius of curvature (grey dilation by a paraboloid, which is separable; van den
//! Boomgaard and Smeulders 1994). Tooth alone is bridged from peak to peak; between ridges of dry paint it hangs by
//! d²/2ρ at a distance of d.

/// Radius of curvature to which a bristle bends under the hand, m.
pub const RADIUS_M: f64 = 28e-3;
/// Greatest distance over which a ridge carries a bristle, m.
pub const REACH_M: f64 = 3e-3;

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
    let curve = 0.5 / (RADIUS_M * cells_per_m) as f32;
    // Beyond this no peak is higher than the parabola of the lowest cell.
    let bridged = ((high - low).max(0.0) / curve).sqrt().ceil() as usize;
    let taps = bridged.min(reach(1.0 / cells_per_m));
    let mut across = base.to_vec();
    for (row, out) in base.chunks_exact(width).zip(across.chunks_exact_mut(width)) {
        for d in 1..=taps.min(width - 1) {
            let drop = curve * (d * d) as f32;
            raise(&mut out[d..], &row[..width - d], drop);
            raise(&mut out[..width - d], &row[d..], drop);
        }
    }
    let mut up = across.clone();
    for d in 1..=taps {
        let drop = curve * (d * d) as f32;
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
