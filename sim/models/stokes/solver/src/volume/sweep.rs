//! Paint that moves along one axis: the flux through each face, as fields.

use maulstick_num::wide;

use super::{LARGEST_COURANT, LEAST_ROOM};
use crate::domain::Domain;
use crate::grid::Grid;
use crate::runs::Runs;
use crate::stencil::Span;

/// Gradient of fill below which a cell has no surface.
const LEAST_GRADIENT: f32 = 1e-3;
/// Largest sum of a cell's shares through two faces, so that rounding never exceeds the cell.
const BELOW_ONE: f32 = 1.0 - 4.0 * f32::EPSILON;

/// Buffers of sweeps.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    capacity: u32,
    /// Cells that paint may leave or enter, and the faces between them.
    runs: Runs,
    mask: Vec<f32>,
    fill: Vec<f32>,
    /// Share of each cell occupied by paint or a solid.
    taken: Vec<f32>,
    /// Component of a cell's normal along the axis, signed; 0 without a surface.
    across: Vec<f32>,
    /// Requested flux through each face, as a share of a cell, upward.
    courant: Vec<f32>,
    /// Quanta requested through each face, upward.
    asks: Vec<i32>,
    /// Share of the donor that goes through each face.
    share: Vec<f32>,
    /// Quanta of one paint through each face.
    goes: Vec<i32>,
}

impl Sweep {
    pub(super) fn new(grid: &Grid) -> Self {
        let len = grid.len();
        Self {
            capacity: 0,
            runs: Runs::default(),
            mask: vec![0.0; len],
            fill: vec![0.0; len],
            taken: vec![0.0; len],
            across: vec![0.0; len],
            courant: vec![0.0; len],
            asks: vec![0; len],
            share: vec![0.0; len],
            goes: vec![0; len],
        }
    }

    /// Begins a step: finds the cells that paint may enter.
    pub(super) fn begin(&mut self, domain: &Domain, capacity: u32) {
        self.capacity = capacity;
        let grid = domain.grid;
        self.mask.fill(0.0);
        let mask = &mut self.mask[..grid.len()];
        for axis in 0..3 {
            mark(mask, &domain.free[axis], grid.stride(axis));
        }
        let before = std::mem::take(&mut self.runs);
        self.runs.find(grid.range(), mask);
        // Nothing goes through faces outside of them.
        for run in before.without(&self.runs) {
            self.courant[run.clone()].fill(0.0);
            self.asks[run.clone()].fill(0);
            self.goes[run].fill(0);
        }
    }

    /// Moves paint along an axis; `total` has all quanta of a cell, `room` its capacity.
    pub(super) fn along<'a>(
        &mut self,
        domain: &Domain,
        (axis, courant): (usize, f32),
        (velocity, open): (&[f32], &[f32]),
        (total, room): (&mut [u32], &mut [f32]),
        paints: impl Iterator<Item = &'a mut Vec<u32>>,
    ) {
        let grid = domain.grid;
        let by = grid.stride(axis);
        let capacity = self.capacity as f32;
        let (free, area) = (&domain.free[axis], &domain.area[axis]);
        let len = grid.len();
        // Paint that came too fast for the other axes leaves at least the capacity beside a solid.
        fill_flat(&mut self.fill[..len], &*total, room, LEAST_ROOM * capacity);
        take(&mut self.taken[..len], &self.fill, open);
        let (fill, taken) = (&self.fill, &self.taken);
        self.runs.write([&mut *self.across], |run, [across]| {
            find_across(across, fill, taken, axis, Span::of(&grid, run));
        });
        grid.wrap(&mut self.across[..len]);
        self.runs.write([&mut *self.courant], |run, [c]| {
            find_courant(c, free, area, velocity, courant, Span::of(&grid, run));
        });
        let (across, courant) = (&self.across, &self.courant);
        self.runs.write([&mut *self.asks], |run, [asks]| {
            let donors = (fill.as_slice(), across.as_slice(), &*total);
            find_asks(asks, courant, donors, capacity, by, Span::of(&grid, run));
        });
        self.runs.write([room], |run, [room]| {
            change_room(room, courant, capacity, by, Span::of(&grid, run));
        });
        grid.wrap(&mut room[..len]);
        let asks = &self.asks;
        self.runs.write([&mut *self.share], |run, [share]| {
            find_share(share, asks, &*total, by, Span::of(&grid, run));
        });
        let share = &self.share;
        for paint in paints {
            grid.wrap(&mut paint[..len]);
            self.runs.write([&mut *self.goes], |run, [goes]| {
                find_goes(goes, share, paint, by, Span::of(&grid, run));
            });
            let goes = &self.goes;
            self.runs.write([paint, total], |run, [paint, total]| {
                carry(paint, total, goes, by, Span::of(&grid, run));
            });
        }
        grid.wrap(&mut total[..len]);
    }
}

wide! {
    /// Marks both cells beside faces.
    fn mark(mask: &mut [f32], faces: &[f32], by: usize) {
        let n = mask.len();
        let high = &faces[..n];
        for i in 0..n {
            mask[i] += high[i];
        }
        for (mask, face) in mask.iter_mut().zip(&faces[by..]) {
            *mask += face;
        }
    }
}

wide! {
    fn fill_flat(fill: &mut [f32], total: &[u32], room: &[f32], least: f32) {
        let n = fill.len();
        let (total, room) = (&total[..n], &room[..n]);
        for i in 0..n {
            let room = if room[i] > least { room[i] } else { least };
            fill[i] = total[i] as f32 / room;
        }
    }
}

wide! {
    /// Paint and its base have one surface: otherwise a film thinner than a cell would have no normal, and be torn
    /// along itself.
    fn take(taken: &mut [f32], fill: &[f32], open: &[f32]) {
        let n = taken.len();
        let (fill, open) = (&fill[..n], &open[..n]);
        for i in 0..n {
            let filled = if fill[i] < 1.0 { fill[i] } else { 1.0 };
            taken[i] = 1.0 - open[i] * (1.0 - filled);
        }
    }
}

wide! {
    fn find_across(across: &mut [f32], fill: &[f32], taken: &[f32], axis: usize, span: Span) {
        let (west, east) = (span.before(taken, 1), span.after(taken, 1));
        let (south, north) = (span.before(taken, span.row), span.after(taken, span.row));
        let (down, up) = (span.before(taken, span.plane), span.after(taken, span.plane));
        let fill = span.here(fill);
        let across = span.own(across);
        for i in 0..across.len() {
            let (x, y, z) = (east[i] - west[i], north[i] - south[i], up[i] - down[i]);
            let own = if axis == 0 { x } else if axis == 1 { y } else { z };
            let sum = (x.abs() + y.abs()) + z.abs();
            let has_surface = (sum >= LEAST_GRADIENT) & (fill[i] < 1.0);
            across[i] = if has_surface { own / sum } else { 0.0 };
        }
    }
}

wide! {
    fn find_courant(c: &mut [f32], free: &[f32], area: &[f32], u: &[f32], courant: f32, span: Span) {
        let (free, area, u) = (span.here(free), span.here(area), span.here(u));
        let c = span.own(c);
        for i in 0..c.len() {
            let goes = area[i] * courant * u[i];
            let goes = if goes < LARGEST_COURANT { goes } else { LARGEST_COURANT };
            let goes = if goes > -LARGEST_COURANT { goes } else { -LARGEST_COURANT };
            c[i] = if free[i] > 0.0 { goes } else { 0.0 };
        }
    }
}

wide! {
    /// Requested quanta, from the donors' fill, normals and content.
    fn find_asks(asks: &mut [i32], courant: &[f32], donors: (&[f32], &[f32], &[u32]), capacity: f32, by: usize, span: Span) {
        let (fill, across, total) = donors;
        let (f_low, f_high) = (span.before(fill, by), span.here(fill));
        let (a_low, a_high) = (span.before(across, by), span.here(across));
        let (t_low, t_high) = (span.before(total, by), span.here(total));
        let c = span.here(courant);
        let asks = span.own(asks);
        for i in 0..asks.len() {
            // All of them first, so that none is looked up separately.
            let fills = [f_low[i], f_high[i]];
            let shares = [a_low[i], a_high[i]];
            let counts = [t_low[i], t_high[i]];
            let is_up = c[i] > 0.0;
            let fill = if is_up { fills[0] } else { fills[1] };
            let across = if is_up { shares[0] } else { shares[1] };
            let has = (if is_up { counts[0] } else { counts[1] }) as i32;
            let reach = c[i].abs();
            let least = if reach < fill { reach } else { fill };
            let rest = reach - (1.0 - fill);
            let rest = if rest > 0.0 { rest } else { 0.0 };
            // Paint lies on the side that it leaves to, or behind air.
            let piled = if (across > 0.0) == is_up { least } else { rest };
            let across = across.abs();
            let share = across * piled + (1.0 - across) * reach * fill;
            let wanted = whole(share * capacity);
            let wanted = if wanted < has { wanted } else { has };
            asks[i] = if is_up { wanted } else { -wanted };
        }
    }
}

wide! {
    /// Updates the capacity of cells by the flow through their faces.
    fn change_room(room: &mut [f32], courant: &[f32], capacity: f32, by: usize, span: Span) {
        let (low, high) = (span.here(courant), span.after(courant, by));
        let room = span.own(room);
        for i in 0..room.len() {
            room[i] += capacity * (low[i] - high[i]);
        }
    }
}

wide! {
    /// Requests as shares of the donors' content, or of all requests to a donor where those exceed it.
    fn find_share(share: &mut [f32], asks: &[i32], total: &[u32], by: usize, span: Span) {
        let (before, here, after) = (span.before(asks, by), span.here(asks), span.after(asks, by));
        let (t_low, t_high) = (span.before(total, by), span.here(total));
        let share = span.own(share);
        for i in 0..share.len() {
            let asks = [-before[i], after[i]];
            let counts = [t_low[i], t_high[i]];
            let is_up = here[i] > 0;
            let other = if is_up { asks[0] } else { asks[1] };
            let other = if other > 0 { other } else { 0 };
            let asked = here[i].wrapping_abs().wrapping_add(other);
            let has = (if is_up { counts[0] } else { counts[1] }) as i32;
            let whole = if asked > has { asked } else { has };
            let whole = if whole > 1 { whole } else { 1 };
            let part = here[i] as f32 / whole as f32 * BELOW_ONE;
            let all = if is_up { 1.0 } else { -1.0 };
            share[i] = if here[i].wrapping_abs() == whole { all } else { part };
        }
    }
}

wide! {
    /// Whole quanta of a paint: together at most a cell's content.
    fn find_goes(goes: &mut [i32], share: &[f32], paint: &[u32], by: usize, span: Span) {
        let (low, high) = (span.before(paint, by), span.here(paint));
        let share = span.here(share);
        let goes = span.own(goes);
        for i in 0..goes.len() {
            let counts = [low[i], high[i]];
            let is_up = share[i] > 0.0;
            let has = (if is_up { counts[0] } else { counts[1] }) as i32;
            let size = share[i].abs();
            let part = if size < 1.0 { whole(size * has as f32) } else { has };
            goes[i] = if is_up { part } else { -part };
        }
    }
}

/// Greatest number of quanta through a face at once.
const MOST_FLUX: f32 = 4_194_304.0;

/// Integer part of a number that is not negative, at most [`MOST_FLUX`]: a cast would be done number by number.
#[inline(always)]
fn whole(number: f32) -> i32 {
    /// From here to twice that, successive f32 numbers differ by one.
    const WHOLE: f32 = 8_388_608.0;
    let number = if number < MOST_FLUX {
        number
    } else {
        MOST_FLUX
    };
    let nearest = number + WHOLE;
    let over = if nearest - WHOLE > number { 1 } else { 0 };
    nearest.to_bits().wrapping_sub(WHOLE.to_bits()) as i32 - over
}

wide! {
    fn carry(paint: &mut [u32], total: &mut [u32], goes: &[i32], by: usize, span: Span) {
        let (low, high) = (span.here(goes), span.after(goes, by));
        let (paint, total) = (span.own(paint), span.own(total));
        for i in 0..paint.len() {
            let gains = low[i].wrapping_sub(high[i]);
            paint[i] = paint[i].wrapping_add_signed(gains);
            total[i] = total[i].wrapping_add_signed(gains);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_parts_are_those_of_a_cast() {
        for number in [
            0.0,
            0.4,
            0.5,
            0.999_999,
            1.0,
            1.5,
            2.5,
            167_772.3,
            4_194_303.8,
        ] {
            assert_eq!(whole(number), number as i32, "{number}");
        }
        assert_eq!([whole(1e20), whole(f32::NAN)], [MOST_FLUX as i32; 2]);
    }
}
