//! Bidirectional transfer of one blend (Baxter 2004, § 4.5.2): each side loses V_l = V_i·(1 − (1 − R)^T), in whole
//! units, in the same proportion for all paints, so colours mix by volume.
//!
//! The text's sum V_i + T·R would create paint; as a power the result is independent of the subdivision of a path.

use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_model::interface::{Step, Transfer};
use maulstick_num::lanes::{Lanes, Plain};
use maulstick_num::wide;

use crate::dither::Dither;
use crate::volume::{MOST, UNIT};

/// Limits of a blend, equal for all its cells.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Quanta on a cell of the canvas up to which the brush adds any.
    pub most: f32,
    /// Quanta that always stay on a cell.
    pub stain: f32,
    /// 1 where both sides give their share, 0 where the brush deposits its flow and takes up nothing.
    pub exchanges: f32,
    /// Additional units deposited along a reference cell.
    pub flow: f32,
    /// True if the canvas loses no more than it gains.
    pub lasting: bool,
}

impl Limits {
    /// Limits of a step.
    #[must_use]
    pub fn of(step: &Step<'_>) -> Self {
        let flow = match step.handling.transfer {
            Transfer::Marker { flow } => Some(flow * (QUANTA_PER_UNIT as f32 / UNIT)),
            _ => None,
        };
        Self {
            exchanges: f32::from(u8::from(flow.is_none())),
            flow: flow.unwrap_or(0.0),
            most: step.handling.most.min(MOST * UNIT).floor(),
            stain: step.stain,
            lasting: step.lasting,
        }
    }
}

/// Contact of brush and canvas on a cell, or on the cells of a run; paint in quanta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Meeting<T = f32> {
    /// Paint of the brush, quanta.
    pub brush: T,
    /// Paint of the canvas, quanta.
    pub canvas: T,
    /// Transferred share of either side, 1 − (1 − R)^T, times the cover of the cell.
    pub rate: T,
    /// Path of the brush, times the cover of the cell, reference cells.
    pub way: T,
    /// Share of the canvas's paint that the brush reaches.
    pub reach: T,
    /// Gap between brush and canvas, which the brush's paint bridges, quanta.
    pub gap: T,
}

/// Number of cells processed together.
pub(crate) const RUN: usize = 8;
/// Offsets of the cells in a run.
pub(crate) const PLACES: [f32; RUN] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Quanta from the brush to the canvas, and from the canvas to the brush: whole units, as far as each side has them and
/// the other has room.
#[must_use]
pub fn leaving(meeting: &Meeting, limits: &Limits, threshold: f32) -> [f32; 2] {
    let splat = Plain::splat;
    let run = Meeting {
        brush: splat(meeting.brush),
        canvas: splat(meeting.canvas),
        rate: splat(meeting.rate),
        way: splat(meeting.way),
        reach: splat(meeting.reach),
        gap: splat(meeting.gap),
    };
    let both = run.leaving(limits, splat(threshold));
    both.map(|side| side.values()[0])
}

impl<L: Lanes> Meeting<L> {
    /// [`leaving`] on the cells of a run.
    #[inline(always)]
    fn leaving(self, limits: &Limits, threshold: L) -> [L; 2] {
        let Self {
            brush,
            canvas,
            rate,
            way,
            reach,
            gap,
        } = self;
        let (none, half, unit) = (L::splat(0.0), L::splat(0.5), L::splat(UNIT));
        let full = L::splat(MOST * UNIT);
        let whole = |units: L, threshold: L| (units + threshold).floor() * unit;
        let free = (brush - gap).most(none).least(full);
        let loose = (canvas - L::splat(limits.stain)).most(none);
        let reached = (canvas.least(full) * reach).least(loose);
        let rate = rate * L::splat(limits.exchanges * (1.0 / UNIT));
        let given = free * rate + L::splat(limits.flow) * way;
        let taken = reached * rate;
        // Half a turn apart, so that the rounding of both sides is independent.
        let opposite = threshold + threshold.less(half).choose(half, L::splat(-0.5));
        let given = whole(given, threshold).least(free);
        let taken = whole(taken, opposite).least(loose);
        let taken = taken.least((full - brush).most(none) + given);
        let given = given.least((L::splat(limits.most) - canvas).most(none) + taken);
        [given, taken]
    }
}

/// Cells of a row under the head: parameters of the contact, a plane each.
#[derive(Debug)]
pub struct Row<'a> {
    /// [`Meeting::rate`].
    pub rate: &'a [f32],
    /// [`Meeting::way`].
    pub way: &'a [f32],
    /// [`Meeting::reach`].
    pub reach: &'a [f32],
    /// [`Meeting::gap`].
    pub gap: &'a [f32],
}

/// Paints of a row, by slot: planes, and the offset of the row in them.
#[derive(Debug)]
pub struct Paints<'a, 'b> {
    /// Paints of the brush.
    pub brush: &'a mut [&'b mut [f32]],
    /// Paints of the canvas, in the same order.
    pub canvas: &'a mut [&'b mut [f32]],
    /// Offsets of the row in those of the brush, and in those of the canvas.
    pub starts: [usize; 2],
}

/// Loads the cells of a run; 0 beyond the plane's end.
#[inline(always)]
pub(crate) fn run<L: Lanes>(plane: &[f32], at: usize) -> L {
    match plane.get(at..).and_then(|rest| rest.first_chunk()) {
        Some(run) => L::of(run),
        None => L::of(&last(plane, at)),
    }
}

#[cold]
fn last(plane: &[f32], at: usize) -> [f32; RUN] {
    let rest = plane.get(at..).unwrap_or_default();
    let mut run = [0.0; RUN];
    run[..rest.len()].copy_from_slice(rest);
    run
}

/// Stores the cells of a run, up to the plane's end.
#[inline(always)]
fn put<L: Lanes>(plane: &mut [f32], at: usize, run: L) {
    let values = run.values();
    let rest = plane.get_mut(at..).unwrap_or_default();
    match rest.first_chunk_mut() {
        Some(run) => *run = values,
        None => rest.copy_from_slice(&values[..rest.len()]),
    }
}

/// Sums of all paints on the cells of a run.
#[inline(always)]
pub(crate) fn sums<L: Lanes>(planes: &[&mut [f32]], at: usize) -> L {
    let mut sums = L::splat(0.0);
    for plane in planes {
        sums = sums + run(plane, at);
    }
    sums
}

wide! {
    /// Blends a row whose first cell has the threshold `first`, in the same proportion for all paints of a side. Cells
    /// beyond the row are unchanged.
    pub fn blend<L>(row: &Row<'_>, limits: &Limits, first: f32, paints: &mut Paints<'_, '_>) {
        let (none, one) = (L::splat(0.0), L::splat(1.0));
        let count = row.rate.len();
        let [on_brush, on_canvas] = paints.starts;
        for at in (0..count).step_by(RUN) {
            let [rate, way]: [L; 2] = [row.rate, row.way].map(|plane| run(plane, at));
            if !none.less(rate.most(way)).any() {
                continue;
            }
            let [reach, gap] = [row.reach, row.gap].map(|plane| run(plane, at));
            let brush = sums(paints.brush, on_brush + at);
            let canvas = sums(paints.canvas, on_canvas + at);
            let place = L::splat(at as f32) + L::of(&PLACES);
            let sum = L::splat(first) + place * L::splat(Dither::ACROSS);
            let meeting = Meeting { brush, canvas, rate, way, reach, gap };
            let [given, taken] = meeting.leaving(limits, sum - sum.floor());
            let gives = given / brush.most(one);
            let takes = taken / canvas.most(one);
            let lost = if limits.lasting { given.least(taken) } else { taken };
            let leaves = lost / taken.most(one);
            for (film, plane) in paints.brush.iter_mut().zip(&mut *paints.canvas) {
                let held: L = run(film, on_brush + at);
                let lies: L = run(plane, on_canvas + at);
                let given = (held * gives).floor();
                let taken = (lies * takes).floor();
                put(film, on_brush + at, held + (taken - given));
                put(plane, on_canvas + at, lies + (given - (taken * leaves).floor()));
            }
        }
    }
}
