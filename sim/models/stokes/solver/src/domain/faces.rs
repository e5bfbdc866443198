//! Faces of solids and of the grid's sides, and cells that resist pressure.

use maulstick_num::wide;

use super::{Domain, TOUCHES, open};
use crate::grid::{Ends, Grid, Side, others};
use crate::stencil::Span;

wide! {
    fn find_flat(fields: [&mut [f32]; 3], corners: &[f32], by: [usize; 2]) {
        let [near, solid, area] = fields;
        let n = near.len();
        let row = |by: usize| &corners[by..by + n];
        let (a, b, c, d) = (row(0), row(by[0]), row(by[1]), row(by[0] + by[1]));
        let (solid, area) = (&mut solid[..n], &mut area[..n]);
        for i in 0..n {
            let distance = 0.25 * ((a[i] + b[i]) + (c[i] + d[i]));
            let is_solid = distance <= TOUCHES;
            near[i] = distance;
            solid[i] = if is_solid { 1.0 } else { 0.0 };
            area[i] = if is_solid { 0.0 } else { open([a[i], b[i], c[i], d[i]]) };
        }
    }
}

/// Distance of each face across an axis from solids, mask of the faces of solids, and open part of the others.
pub(super) fn find_faces(grid: &Grid, axis: usize, corners: &[f32], fields: [&mut Vec<f32>; 3]) {
    let by = others(axis).map(|axis| grid.stride(axis));
    let last = grid.len() - by[0] - by[1];
    let fields = fields.map(|field| {
        field[last..].fill(0.0);
        &mut field[..last]
    });
    find_flat(fields, corners, by);
}

/// Faces across an axis in the sides of the grid and beyond them.
pub(super) fn find_sides(grid: &Grid, axis: usize, solid: &mut [f32], area: &mut [f32]) {
    for along in 0..3 {
        let Ends::Sides([low, high]) = grid.ends[along] else {
            continue;
        };
        let last = grid.cells[along] as isize + isize::from(along == axis);
        let mut close = |layer: isize, side: Side| {
            let is_in_side = along == axis && (layer == 0 || layer == last - 1);
            if is_in_side || side == Side::NoSlip {
                grid.fill_layer(solid, along, layer, 1.0);
                grid.fill_layer(area, along, layer, 0.0);
            }
        };
        close(-1, low);
        for layer in last..=grid.cells[along] as isize + 1 {
            close(layer, high);
        }
        if along == axis {
            close(0, low);
            close(last - 1, high);
        }
    }
}

wide! {
    fn cells_flat(fields: [&mut [f32]; 2], fill: &[f32], corners: &[f32], solid: &[Vec<f32>; 3], least: f32, span: Span) {
        let [wet, volume] = fields;
        let (y, z) = (span.row, span.plane);
        let (a, b) = (span.here(corners), span.after(corners, 1));
        let (c, d) = (span.after(corners, y), span.after(corners, 1 + y));
        let (e, f) = (span.after(corners, z), span.after(corners, 1 + z));
        let (g, h) = (span.after(corners, y + z), span.after(corners, 1 + y + z));
        let (west, east) = (span.here(&solid[0]), span.after(&solid[0], 1));
        let (south, north) = (span.here(&solid[1]), span.after(&solid[1], y));
        let (down, up) = (span.here(&solid[2]), span.after(&solid[2], z));
        let fill = span.here(fill);
        let (wet, volume) = (span.here_mut(wet), span.here_mut(volume));
        for i in 0..wet.len() {
            let closed = (west[i] * east[i]) * (south[i] * north[i]) * (down[i] * up[i]);
            let is_wet = (fill[i] >= least) & (closed == 0.0);
            let filled = if fill[i] < 1.0 { fill[i] } else { 1.0 };
            let share = filled * open([a[i], b[i], c[i], d[i], e[i], f[i], g[i], h[i]]);
            wet[i] = if is_wet { 1.0 } else { 0.0 };
            volume[i] = if is_wet { share } else { 0.0 };
        }
    }
}

/// Cells that resist pressure.
pub(super) fn find_cells(domain: &mut Domain, (fill, least): (&[f32], f32), corners: &[f32]) {
    let grid = domain.grid;
    let fields = [domain.wet.as_mut_slice(), domain.volume.as_mut_slice()];
    // Every place up to the last cell has all of its corners in the field.
    let last = grid.at(grid.cells.map(|cells| cells as isize - 1)) + 1;
    let span = Span::of(&grid, 0..last);
    cells_flat(fields, fill, corners, &domain.solid, least, span);
    for field in [&mut domain.wet, &mut domain.volume] {
        field[last..].fill(0.0);
        grid.clear_beyond(field);
        grid.wrap(field);
    }
}
