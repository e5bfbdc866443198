//! Stage 3: conservative advection (Baxter 2004, § 6.4.1), counted in quanta.
//!
//! Each paint is moved along one axis and then along the other. What goes through a face is what
//! stands over the way of that face in a second-order reconstruction with van Leer's limiter (van
//! Leer 1974), truncated to quanta, taken from the one cell and given to the other, so nothing is
//! lost or created, and no cell gives more than it has. Where velocities diverge or meet, paint thins
//! or piles up.

use std::ops::Range;

use maulstick_num::wide;

use super::velocity::Faces;
use crate::quantum::CELL_MAX;
use crate::window::{Area, Window};

/// What stays on a cell however hard it is brushed, unless the painter says otherwise, quanta: 3 µm of
/// stain (§ 6.4.1, size).
pub const STAIN: f32 = 2013.0;
/// Kept free on a cell, quanta: more than what is truncated.
const SPARE: f32 = 64.0;
/// Where no cell holds more than this share of the most that one can, all that comes has room.
const HALF_EMPTY: f32 = 0.1;

/// Room for a step.
#[derive(Clone, Debug, Default)]
pub struct Advection {
    /// Wet quanta of all paints on each cell.
    totals: Vec<f32>,
    /// Share of its paint that a cell may give.
    loose: Vec<f32>,
    /// Share of what comes that a cell has room for.
    room: Vec<f32>,
    /// One paint.
    plane: Vec<f32>,
    /// Quanta that leave each cell for the next and for the one before.
    sent: [Vec<f32>; 2],
}

/// Which axis paint is moved along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// To the right and left.
    X,
    /// Up and down.
    Y,
}

wide! {
    /// Moves the paint of an area along one axis, on which cells are `next` apart.
    fn along(
        room: &mut Advection,
        window: &mut Window,
        area: &Area,
        velocity: &[f32],
        next: usize,
        stain: f32,
    ) {
        window.weigh(area, &mut room.totals);
        room.find_loose(stain);
        room.find_room(velocity, next);
        room.shift(area, window, velocity, next);
    }
}

impl Advection {
    /// Moves the wet paint of an area along both axes, `first` before the other; `stain` quanta stay
    /// on each cell.
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
            along(self, window, &area, velocity, next, stain);
        }
    }

    #[inline(always)]
    fn find_loose(&mut self, stain: f32) {
        let share = |total: &f32| (total - stain).max(0.0) / total.max(1.0);
        self.loose.clear();
        self.loose.extend(self.totals.iter().map(share));
    }

    /// A cell holds at most one unit: inflow beyond it stays with its donors.
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
        // At most this share of a column leaves, whatever its slope is.
        let leaves = |v: f32, from: usize| v * (2.0 - v) * self.totals[from] * self.loose[from];
        for (cell, v) in velocity.iter().enumerate().take(cells.saturating_sub(next)) {
            if *v > 0.0 {
                self.room[cell + next] += leaves(*v, cell);
            } else {
                self.room[cell] += leaves(-v, cell + next);
            }
        }
        for (room, total) in self.room.iter_mut().zip(&self.totals) {
            let free = (CELL_MAX as f32 - SPARE - total).max(0.0);
            *room = if *room > free { free / *room } else { 1.0 };
        }
    }

    #[inline(always)]
    fn shift(&mut self, area: &Area, window: &mut Window, velocity: &[f32], next: usize) {
        let width = window.width();
        let cells = self.totals.len();
        for (_, plane) in window.planes_mut() {
            self.plane.clear();
            for row in area.rows(width) {
                self.plane.extend_from_slice(&plane[row]);
            }
            if self.plane.iter().all(|count| *count == 0.0) {
                continue;
            }
            self.send(velocity, next, area.size[0]);
            let [on, back] = &self.sent;
            let sent = on.iter().zip(back);
            for (count, (on, back)) in self.plane.iter_mut().zip(sent) {
                *count -= on + back;
            }
            if cells > next {
                let on = self.plane[next..].iter_mut().zip(on);
                on.for_each(|(count, sent)| *count += sent);
                let back = self.plane.iter_mut().zip(&back[next..]);
                back.for_each(|(count, sent)| *count += sent);
            }
            let rows = self.plane.chunks_exact(area.size[0]);
            for (row, moved) in area.rows(width).zip(rows) {
                plane[row].copy_from_slice(moved);
            }
        }
    }

    /// What of one paint leaves each cell.
    #[inline(always)]
    fn send(&mut self, velocity: &[f32], next: usize, width: usize) {
        let cells = self.plane.len();
        for sent in &mut self.sent {
            sent.clear();
            sent.resize(cells, 0.0);
        }
        let height = cells / width;
        for row in 0..height {
            let start = row * width;
            if next == 1 {
                self.send_at_edge(velocity, next, start);
                if width > 2 {
                    self.send_run(velocity, next, start + 1..start + width - 1);
                }
                self.send_at_edge(velocity, next, start + width - 1);
            } else if row == 0 || row + 1 == height {
                (start..start + width).for_each(|place| self.send_at_edge(velocity, next, place));
            } else {
                self.send_run(velocity, next, start..start + width);
            }
        }
    }

    /// What leaves cells that have a neighbour on both sides.
    #[inline(always)]
    fn send_run(&mut self, velocity: &[f32], next: usize, run: Range<usize>) {
        let on_by = |range: &Range<usize>| range.start + next..range.end + next;
        let back_by = |range: &Range<usize>| range.start - next..range.end - next;
        let [on, back] = &mut self.sent;
        let (on, back) = (&mut on[run.clone()], &mut back[run.clone()]);
        let count = on.len();
        let (q, loose) = (&self.plane[run.clone()], &self.loose[run.clone()]);
        let (before, after) = (&self.plane[back_by(&run)], &self.plane[on_by(&run)]);
        let (ahead, behind) = (&velocity[run.clone()], &velocity[back_by(&run)]);
        let leaves = |i: usize, room: [f32; 2]| {
            let slope = van_leer(q[i] - before[i], after[i] - q[i]);
            let out = [ahead[i], -behind[i]];
            leaving(q[i], slope, out, [loose[i] * room[0], loose[i] * room[1]])
        };
        if self.room.is_empty() {
            for i in 0..count {
                [on[i], back[i]] = leaves(i, [1.0; 2]);
            }
        } else {
            let (to, from) = (&self.room[on_by(&run)], &self.room[back_by(&run)]);
            for i in 0..count {
                [on[i], back[i]] = leaves(i, [to[i], from[i]]);
            }
        }
    }

    /// What leaves a cell at the edge of the surface, beyond which it goes on as it is.
    fn send_at_edge(&mut self, velocity: &[f32], next: usize, place: usize) {
        let room = |place: usize| self.room.get(place).copied().unwrap_or(1.0);
        let loose = self.loose[place];
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
