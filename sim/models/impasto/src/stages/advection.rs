//! Stage 3: conservative advection (Baxter 2004, § 6.4.1), counted in quanta.
//!
//! Each paint is moved along one axis and then along the other. The flux through a face is the paint upstream of that
//! face within one step's travel, in a second-order reconstruction with van Leer's limiter (van Leer 1974), truncated
//! to quanta, taken from the one cell and given to the other, so nothing is lost or created, and no cell gives more
//! than it has. Where velocities diverge or meet, paint thins or piles up.

use std::ops::Range;

use maulstick_canvas::quantum::CELL_MAX;
use maulstick_canvas::window::{Area, Window};
use maulstick_num::fork_join::each;
use maulstick_num::wide;

use maulstick_model::footprint::shares_of;

use super::velocity::Faces;

/// Default stain: paint that stays on a cell however hard it is brushed, quanta, 3 µm (§ 6.4.1, size).
pub const STAIN: f32 = 2013.0;
/// Capacity kept free on a cell, quanta: more than the truncation error.
const SPARE_QUANTA: f32 = 64.0;
/// Share of a cell's capacity up to which all inflow fits.
const HALF_EMPTY: f32 = 0.1;

/// Buffers of a step.
#[derive(Clone, Debug, Default)]
pub struct Advection {
    /// Wet quanta of all paints on each cell.
    totals: Vec<f32>,
    /// Share of its paint that a cell may give.
    loose: Vec<f32>,
    /// Share of the inflow that fits a cell.
    room: Vec<f32>,
    /// Buffers, one for each core.
    movers: Vec<Mover>,
}

/// Buffers for moving one paint.
#[derive(Clone, Debug, Default)]
struct Mover {
    /// Its quanta by cell.
    plane: Vec<f32>,
    /// Quanta from each cell to the next and to the one before.
    sent: [Vec<f32>; 2],
}

/// Fluxes of all paints along an axis.
#[derive(Clone, Copy, Debug)]
struct Flux<'a> {
    /// Area of the window.
    area: Area,
    /// Columns of the window.
    width: usize,
    /// Through the face of each cell towards the next.
    velocity: &'a [f32],
    /// Offset of the neighbouring cell along the axis, in the arrays.
    next: usize,
    /// Loose shares; see [`Advection`].
    loose: &'a [f32],
    /// Shares of inflow that fit, see [`Advection`]; empty where all of it fits.
    room: &'a [f32],
}

/// Axis along which paint is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// To the right and left.
    X,
    /// Up and down.
    Y,
}

wide! {
    fn move_planes(mover: &mut Mover, flux: &Flux<'_>, planes: &mut [&mut Vec<f32>]) {
        // A loop, as a closure would not be compiled for wide registers.
        for plane in planes {
            mover.shift(flux, plane);
        }
    }
}

wide! {
    fn find_room(advection: &mut Advection, velocity: &[f32], next: usize) {
        advection.find_room(velocity, next);
    }
}

wide! {
    /// Wet quanta of all paints on each cell, and the loose share of them.
    fn weigh(window: &Window, area: &Area, stain: f32, totals: &mut [f32], loose: &mut [f32]) {
        window.weigh(area, totals);
        for (loose, total) in loose.iter_mut().zip(totals) {
            *loose = (*total - stain).max(0.0) / total.max(1.0);
        }
    }
}

impl Advection {
    /// Moves the wet paint of an area along both axes, `first` before the other; `stain` quanta stay on each cell.
    pub fn run(&mut self, area: Area, faces: &Faces, window: &mut Window, first: Axis, stain: f32) {
        if area.is_empty() {
            return;
        }
        let axes = match first {
            Axis::X => [Axis::X, Axis::Y],
            Axis::Y => [Axis::Y, Axis::X],
        };
        for axis in axes {
            let (velocity, next) = match axis {
                Axis::X => (&faces.right, 1),
                Axis::Y => (&faces.above, area.size[0]),
            };
            self.weigh(window, &area, stain);
            find_room(self, velocity, next);
            let flux = Flux {
                area,
                width: window.width(),
                velocity,
                next,
                loose: &self.loose,
                room: &self.room,
            };
            let parts = window.planes_in_parts(shares_of(area.cells()));
            let movers = self.movers.len().max(parts.len());
            self.movers.resize_with(movers, Mover::default);
            let mut shares: Vec<_> = self.movers.iter_mut().zip(parts).collect();
            each(&mut shares, |(mover, planes)| {
                move_planes(mover, &flux, planes);
            });
        }
    }

    fn weigh(&mut self, window: &Window, area: &Area, stain: f32) {
        self.totals.resize(area.cells(), 0.0);
        self.loose.resize(area.cells(), 0.0);
        let (mut totals, mut loose) = (&mut self.totals[..], &mut self.loose[..]);
        let parts = area.parts(shares_of(area.cells())).map(|part| {
            let planes = [&mut totals, &mut loose];
            let own = planes.map(|plane| plane.split_off_mut(..part.cells()).unwrap_or_default());
            (part, own)
        });
        each(&mut parts.collect::<Vec<_>>(), |(part, [totals, loose])| {
            weigh(window, part, stain, totals, loose);
        });
    }

    /// Bounds the inflow by a cell's capacity of one unit; the excess stays with its donors.
    #[inline(always)]
    fn find_room(&mut self, velocity: &[f32], next: usize) {
        self.room.clear();
        let fullest = self
            .totals
            .iter()
            .fold(0.0f32, |most, total| most.max(*total));
        if fullest <= HALF_EMPTY * CELL_MAX as f32 {
            return;
        }
        let cells = self.totals.len();
        self.room.resize(cells, 0.0);
        // Greatest share that leaves a column, whatever its slope.
        let leaves = |v: f32, from: usize| v * (2.0 - v) * self.totals[from] * self.loose[from];
        for (cell, v) in velocity.iter().enumerate().take(cells.saturating_sub(next)) {
            if *v > 0.0 {
                self.room[cell + next] += leaves(*v, cell);
            } else {
                self.room[cell] += leaves(-v, cell + next);
            }
        }
        for (room, total) in self.room.iter_mut().zip(&self.totals) {
            let free = (CELL_MAX as f32 - SPARE_QUANTA - total).max(0.0);
            *room = if *room > free { free / *room } else { 1.0 };
        }
    }
}

impl Mover {
    #[inline(always)]
    fn shift(&mut self, flux: &Flux<'_>, plane: &mut [f32]) {
        self.plane.clear();
        for row in flux.area.rows(flux.width) {
            self.plane.extend_from_slice(&plane[row]);
        }
        if self.plane.iter().all(|count| *count == 0.0) {
            return;
        }
        self.send(flux);
        let next = flux.next;
        let [on, back] = &self.sent;
        let sent = on.iter().zip(back);
        for (count, (on, back)) in self.plane.iter_mut().zip(sent) {
            *count -= on + back;
        }
        if self.plane.len() > next {
            let on = self.plane[next..].iter_mut().zip(on);
            on.for_each(|(count, sent)| *count += sent);
            let back = self.plane.iter_mut().zip(&back[next..]);
            back.for_each(|(count, sent)| *count += sent);
        }
        let rows = self.plane.chunks_exact(flux.area.size[0]);
        for (row, moved) in flux.area.rows(flux.width).zip(rows) {
            plane[row].copy_from_slice(moved);
        }
    }

    /// Outflow of one paint from each cell.
    #[inline(always)]
    fn send(&mut self, flux: &Flux<'_>) {
        let (next, width) = (flux.next, flux.area.size[0]);
        let cells = self.plane.len();
        for sent in &mut self.sent {
            sent.clear();
            sent.resize(cells, 0.0);
        }
        let height = cells / width;
        for row in 0..height {
            let start = row * width;
            if next == 1 {
                self.send_at_edge(flux, start);
                if width > 2 {
                    self.send_run(flux, start + 1..start + width - 1);
                }
                self.send_at_edge(flux, start + width - 1);
            } else if row == 0 || row + 1 == height {
                (start..start + width).for_each(|place| self.send_at_edge(flux, place));
            } else {
                self.send_run(flux, start..start + width);
            }
        }
    }

    /// Outflow of cells that have a neighbour on both sides.
    #[inline(always)]
    fn send_run(&mut self, flux: &Flux<'_>, run: Range<usize>) {
        let (velocity, next) = (flux.velocity, flux.next);
        let on_by = |range: &Range<usize>| range.start + next..range.end + next;
        let back_by = |range: &Range<usize>| range.start - next..range.end - next;
        let [on, back] = &mut self.sent;
        let (on, back) = (&mut on[run.clone()], &mut back[run.clone()]);
        let count = on.len();
        let (q, loose) = (&self.plane[run.clone()], &flux.loose[run.clone()]);
        let (before, after) = (&self.plane[back_by(&run)], &self.plane[on_by(&run)]);
        let (ahead, behind) = (&velocity[run.clone()], &velocity[back_by(&run)]);
        let leaves = |i: usize, room: [f32; 2]| {
            let slope = van_leer(q[i] - before[i], after[i] - q[i]);
            let out = [ahead[i], -behind[i]];
            leaving(q[i], slope, out, [loose[i] * room[0], loose[i] * room[1]])
        };
        if flux.room.is_empty() {
            for i in 0..count {
                [on[i], back[i]] = leaves(i, [1.0; 2]);
            }
        } else {
            let (to, from) = (&flux.room[on_by(&run)], &flux.room[back_by(&run)]);
            for i in 0..count {
                [on[i], back[i]] = leaves(i, [to[i], from[i]]);
            }
        }
    }

    /// Outflow of a cell at the edge of the surface, beyond which it continues unchanged.
    fn send_at_edge(&mut self, flux: &Flux<'_>, place: usize) {
        let (velocity, next) = (flux.velocity, flux.next);
        let room = |place: usize| flux.room.get(place).copied().unwrap_or(1.0);
        let loose = flux.loose[place];
        let below = place.checked_sub(next);
        let behind = below.map_or(0.0, |below| velocity[below]);
        if velocity[place] <= 0.0 && behind >= 0.0 {
            return;
        }
        let shares = [loose * room(place + next), loose * below.map_or(0.0, room)];
        let out = [velocity[place], -behind];
        let [on, back] = leaving(self.plane[place], 0.0, out, shares);
        (self.sent[0][place], self.sent[1][place]) = (on, back);
    }
}

/// Quanta of a column of `q` that leave through its two faces by velocities away from it.
#[inline(always)]
fn leaving(q: f32, slope: f32, [v, w]: [f32; 2], [ahead, behind]: [f32; 2]) -> [f32; 2] {
    let v = if v > 0.0 { v } else { 0.0 };
    let w = if w > 0.0 { w } else { 0.0 };
    let on = v * (q + 0.5 * (1.0 - v) * slope) * ahead;
    let back = w * (q - 0.5 * (1.0 - w) * slope) * behind;
    let (on, back) = (on.floor(), back.floor());
    let rest = q - on;
    [on, if back < rest { back } else { rest }]
}

/// Van Leer's mean of the differences to both sides: 0 at an extremum, so that no new one appears.
#[must_use]
#[inline(always)]
pub fn van_leer(before: f32, after: f32) -> f32 {
    let product = before * after;
    let slope = 2.0 * product / (before + after);
    if product > 0.0 { slope } else { 0.0 }
}
