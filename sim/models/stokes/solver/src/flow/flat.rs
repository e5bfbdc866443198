//! Loops over the fields of a flow.

use maulstick_num::wide;

use crate::stencil::Span;

/// Tolerated excess or deficit of a cell, as a share of its volume.
const SLACK: f32 = 1e-3;

wide! {
    /// Velocities of solids at their faces, of paint unchanged, 0 in air.
    pub(super) fn choose(u: &mut [f32], free: &[f32], solid: &[f32], of_solid: &[f32]) {
        let n = u.len();
        let (free, solid, of_solid) = (&free[..n], &solid[..n], &of_solid[..n]);
        for i in 0..n {
            let other = if solid[i] > 0.0 { of_solid[i] } else { 0.0 };
            u[i] = if free[i] > 0.0 { u[i] } else { other };
        }
    }
}

wide! {
    /// Multiplies a field in wet cells; elsewhere it is 0.
    pub(super) fn rescale(field: &mut [f32], wet: &[f32], by: f32) {
        let wet = &wet[..field.len()];
        for i in 0..field.len() {
            field[i] = if wet[i] > 0.0 { field[i] * by } else { 0.0 };
        }
    }
}

wide! {
    /// Adds the excess of wet cells, and the deficit of those within the paint.
    pub(super) fn relieve(displaced: &mut [f32], wet: &[f32], fill: &[f32], per_step: f32, span: Span) {
        let (west, east) = (span.before(wet, 1), span.after(wet, 1));
        let (south, north) = (span.before(wet, span.row), span.after(wet, span.row));
        let (down, up) = (span.before(wet, span.plane), span.after(wet, span.plane));
        let (wet, fill) = (span.here(wet), span.here(fill));
        let displaced = span.here_mut(displaced);
        for i in 0..displaced.len() {
            let inside = (west[i] * east[i]) * (south[i] * north[i]) * (down[i] * up[i]);
            let excess = fill[i] - 1.0;
            let counts = (excess > SLACK) | ((excess < -SLACK) & (inside > 0.0));
            let most = if excess < 1.0 { excess } else { 1.0 };
            let gives = if counts & (wet[i] > 0.0) { per_step * most } else { 0.0 };
            displaced[i] += gives;
        }
    }
}

wide! {
    /// Velocities of air beside paint: the mean of those of paint around it.
    pub(super) fn extrapolate(into: &mut [f32], u: &[f32], free: &[f32], solid: &[f32], span: Span) {
        let (west, east) = (span.before(free, 1), span.after(free, 1));
        let (south, north) = (span.before(free, span.row), span.after(free, span.row));
        let (down, up) = (span.before(free, span.plane), span.after(free, span.plane));
        let (u_west, u_east) = (span.before(u, 1), span.after(u, 1));
        let (u_south, u_north) = (span.before(u, span.row), span.after(u, span.row));
        let (u_down, u_up) = (span.before(u, span.plane), span.after(u, span.plane));
        let (u, free, solid) = (span.here(u), span.here(free), span.here(solid));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let count = (west[i] + east[i]) + (south[i] + north[i]) + (down[i] + up[i]);
            let x = west[i] * u_west[i] + east[i] * u_east[i];
            let y = south[i] * u_south[i] + north[i] * u_north[i];
            let z = down[i] * u_down[i] + up[i] * u_up[i];
            let is_beside = (count > 0.0) & (free[i] + solid[i] == 0.0);
            into[i] = if is_beside { ((x + y) + z) / count } else { u[i] };
        }
    }
}
