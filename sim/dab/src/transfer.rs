//! Bidirectional transfer of one blend (Baxter 2004, § 4.5.2): of each side goes V_l = V_i·(1 − (1 − R)^T), in whole
//! units, with all paints alike, so colours mix by the volumes.
//!
//! The text's sum V_i + T·R would create paint; as a power the result does not depend on how a way is cut.

use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_model::interface::{Step, Transfer};
use maulstick_num::wide;

use crate::dither::{Dither, whole};
use crate::volume::{MOST, UNIT};

/// What a blend may move, the same on all of its cells.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most quanta of a cell of the canvas to which the brush adds any.
    pub most: f32,
    /// Quanta that stay on a cell.
    pub stain: f32,
    /// 1 where both sides give their share, 0 where the brush leaves by its flow and takes nothing up.
    pub exchanges: f32,
    /// Units that it leaves besides along a reference cell.
    pub flow: f32,
    /// True if the canvas loses no more than it gains.
    pub lasting: bool,
}

impl Limits {
    /// Those of a step.
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

/// A cell where brush and canvas meet; paint in quanta.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Meeting {
    /// Of the brush over it.
    pub brush: f32,
    /// On the canvas.
    pub canvas: f32,
    /// Share of either side that goes over, 1 − (1 − R)^T, by the share of the cell that is covered.
    pub rate: f32,
    /// Way of the brush by the share of the cell that is covered, reference cells.
    pub way: f32,
    /// Share of the canvas's paint that the brush reaches.
    pub reach: f32,
    /// Gap between brush and canvas, which the brush's paint bridges.
    pub gap: f32,
}

/// Quanta that go from the brush to the canvas, and from the canvas to the brush: whole units, as far as both sides
/// have them and room for them.
#[must_use]
#[inline(always)]
pub fn leaving(meeting: &Meeting, limits: &Limits, threshold: f32) -> [f32; 2] {
    let Meeting {
        brush,
        canvas,
        rate,
        way,
        reach,
        gap,
    } = *meeting;
    let full = MOST * UNIT;
    let free = least(most(brush - gap, 0.0), full);
    let loose = most(canvas - limits.stain, 0.0);
    let reached = least(least(canvas, full) * reach, loose);
    let rate = rate * limits.exchanges * (1.0 / UNIT);
    let given = free * rate + limits.flow * way;
    let taken = reached * rate;
    // Half a turn apart: what leaves one side shall not go by what leaves the other.
    let opposite = threshold + if threshold < 0.5 { 0.5 } else { -0.5 };
    let given = least(whole(given, threshold) * UNIT, free);
    let taken = least(whole(taken, opposite) * UNIT, loose);
    let taken = least(taken, most(full - brush, 0.0) + given);
    let given = least(given, most(limits.most - canvas, 0.0) + taken);
    [given, taken]
}

#[inline(always)]
pub(crate) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(crate) fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Cells that are done together.
pub(crate) const RUN: usize = 16;

/// Cells of a row where the head is: how brush and canvas meet, a plane each.
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

/// Paints of a row, by slot: planes, and where the row begins in them.
#[derive(Debug)]
pub struct Paints<'a, 'b> {
    /// Of the brush.
    pub brush: &'a mut [&'b mut [f32]],
    /// Of the canvas, in the same order.
    pub canvas: &'a mut [&'b mut [f32]],
    /// Where the row begins in those of the brush, and in those of the canvas.
    pub starts: [usize; 2],
}

/// The cells of a run; 0 beyond the plane's end.
#[inline(always)]
pub(crate) fn run(plane: &[f32], at: usize) -> [f32; RUN] {
    let rest = plane.get(at..).unwrap_or_default();
    match rest.first_chunk() {
        Some(run) => *run,
        None => {
            let mut run = [0.0; RUN];
            run[..rest.len()].copy_from_slice(rest);
            run
        }
    }
}

/// Puts the cells of a run where they were, as far as the plane goes.
#[inline(always)]
fn put(plane: &mut [f32], at: usize, values: &[f32; RUN]) {
    let rest = plane.get_mut(at..).unwrap_or_default();
    match rest.first_chunk_mut() {
        Some(run) => *run = *values,
        None => rest.copy_from_slice(&values[..rest.len()]),
    }
}

/// Sums of all paints on the cells of a run.
#[inline(always)]
pub(crate) fn sums(planes: &[&mut [f32]], at: usize) -> [f32; RUN] {
    let mut sums = [0.0f32; RUN];
    for plane in planes {
        let counts = run(plane, at);
        (0..RUN).for_each(|i| sums[i] += counts[i]);
    }
    sums
}

wide! {
    /// Blends a row whose first cell has this threshold: all paints of a side alike. Cells of the planes beyond the row stay.
    pub fn blend(row: &Row<'_>, limits: &Limits, first: f32, paints: &mut Paints<'_, '_>) {
        let count = row.rate.len();
        let [on_brush, on_canvas] = paints.starts;
        for at in (0..count).step_by(RUN) {
            let [rate, way] = [row.rate, row.way].map(|plane| run(plane, at));
            if rate.iter().chain(&way).all(|share| *share == 0.0) {
                continue;
            }
            let [reach, gap] = [row.reach, row.gap].map(|plane| run(plane, at));
            let brush = sums(paints.brush, on_brush + at);
            let canvas = sums(paints.canvas, on_canvas + at);
            let [mut gives, mut takes, mut leaves] = [[0.0f32; RUN]; 3];
            for i in 0..RUN {
                let sum = first + (at + i) as f32 * Dither::ACROSS;
                let meeting = Meeting {
                    brush: brush[i],
                    canvas: canvas[i],
                    rate: rate[i],
                    way: way[i],
                    reach: reach[i],
                    gap: gap[i],
                };
                let [given, taken] = leaving(&meeting, limits, sum - sum.floor());
                gives[i] = given / most(brush[i], 1.0);
                takes[i] = taken / most(canvas[i], 1.0);
                let lost = if limits.lasting { least(given, taken) } else { taken };
                leaves[i] = lost / most(taken, 1.0);
            }
            for (film, plane) in paints.brush.iter_mut().zip(&mut *paints.canvas) {
                let mut held = run(film, on_brush + at);
                let mut lies = run(plane, on_canvas + at);
                for i in 0..RUN {
                    let given = (held[i] * gives[i]).floor();
                    let taken = (lies[i] * takes[i]).floor();
                    held[i] += taken - given;
                    lies[i] += given - (taken * leaves[i]).floor();
                }
                put(film, on_brush + at, &held);
                put(plane, on_canvas + at, &lies);
            }
        }
    }
}
