//! dAb on the device: the stages of the paint model `dab`, in WGSL.
//!
//! Which blends a step has, and where, follows from the heads alone, so the processor knows it beforehand: the head is
//! drawn on the device once for each drawing, and a dispatch blends it with the canvas at each place of its way. Between
//! them the brush's films are on the cells of the drawing, in whole quanta; the thresholds are those of the processor in
//! fixed point.
//!
//! | module | holds |
//! | --- | --- |
//! | `stages` | the stages |
//! | `record` | a blend as the shaders take it |
//! | [`probe`] | what single stages leave, for tests |

pub mod probe;
mod record;
mod stages;

use std::ops::Range;

use maulstick_brush::HeadPose;
use maulstick_dab::dither::Dither;
use maulstick_dab::stroke::{Course, Stroker, bend, between, parts, places};
use maulstick_dab::{Dab, first_blend};
use maulstick_model::brush::head::low_bounds;
use maulstick_model::interface::{Step, Sweep};

use crate::device::{Device, GpuError};
use crate::steps::model::{GpuModel, Planner};
use crate::steps::record::{Grid, StepRecord};
use crate::steps::residence::Residence;
use crate::steps::workspace::{Batch, Call};
use record::BlendRecord;
use stages::{BEGINS, BLENDS, DRAWS, ENDS, GOES_ON, KERNELS};

impl GpuModel {
    /// The paint model `dab` on a device; the load on the machine chooses how it strokes.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver does not take the shaders.
    pub fn dab(gpu: Device) -> Result<Self, GpuError> {
        let steps = Steps { stroker: None };
        Self::new(gpu, &KERNELS, Box::new(steps), Box::<Dab>::default())
    }

    /// The same, but it always strokes by this algorithm.
    ///
    /// # Errors
    /// As [`dab`](Self::dab).
    pub fn dab_stroking(gpu: Device, stroker: Stroker) -> Result<Self, GpuError> {
        let steps = Steps {
            stroker: Some(stroker),
        };
        let cpu = Box::new(Dab::stroking(stroker));
        Self::new(gpu, &KERNELS, Box::new(steps), cpu)
    }
}

/// Steps of dAb as stages.
struct Steps {
    stroker: Option<Stroker>,
}

/// A drawing of the head, in the middle of a motion, which is blended at places beside it.
struct Drawing {
    poses: [HeadPose; 2],
    shifts: Vec<[i64; 2]>,
    /// Way of a cell of the head, reference cells: by the cells that its strip goes, and besides.
    by_even: [f32; 2],
}

/// The drawings of a step, and the way of its anchor point, cells.
fn drawings(step: &Step<'_>, stroker: Stroker) -> (Vec<Drawing>, f32) {
    let whole = &step.sweep;
    let reference = step.traits.cell_per_reference;
    let bend = match stroker {
        Stroker::Spline => bend(whole),
        Stroker::Faster | Stroker::Better => None,
    };
    let course = Course::of(whole, bend);
    let [x, y] = course.way;
    let length = (x * x + y * y).sqrt();
    if stroker == Stroker::Faster {
        let shifts: Vec<[i64; 2]> = places(course.way).collect();
        let each = length / shifts.len() as f32;
        let drawing = Drawing {
            poses: [whole.to, whole.to].map(HeadPose::clone),
            shifts,
            by_even: [0.0, each * reference],
        };
        return (vec![drawing], length);
    }
    let drawn = course.runs(parts(whole)).map(|run| Drawing {
        poses: run.part.map(|t| {
            let mut pose = HeadPose::default();
            between(whole, bend, t, &mut pose);
            pose
        }),
        shifts: run.shifts,
        by_even: [reference, 0.0],
    });
    (drawn.collect(), length)
}

impl Drawing {
    /// The cells of the step's bounds on which it can be, beside the window too; none where it is beside them.
    fn grid(&self, step: &Step<'_>) -> Option<Grid> {
        let [_, pose] = &self.poses;
        let (low, high) = low_bounds(step.head, pose, &step.traits, f32::MAX)?;
        let (from, to) = step.bounds;
        let from = [0, 1].map(|i| low[i].max(from[i]));
        let to = [0, 1].map(|i| high[i].min(to[i]));
        (0..2)
            .all(|i| from[i] < to[i])
            .then(|| grid(step, from, to))
    }
}

/// The cells of the surface from the first up to but not with the second, all of which may be drawn on.
fn grid(step: &Step<'_>, from: [i64; 2], to: [i64; 2]) -> Grid {
    let origin = step.window.origin();
    let size = [0, 1].map(|i| (to[i] - from[i]) as u32);
    Grid {
        from: [0, 1].map(|i| from[i] - origin[i]),
        size,
        inside: [[0; 2], size],
    }
}

impl Planner for Steps {
    fn plan(
        &self,
        step: &Step<'_>,
        on: &Residence,
        number: u64,
        batch: &mut Batch,
    ) -> Option<Range<usize>> {
        let (from, to) = step.bounds;
        let canvas = step.window.area(from, to);
        if canvas.is_empty() {
            return None;
        }
        let bounds = grid(step, from, to);
        if !on.has_room(bounds.cells()) {
            return None;
        }
        let (drawings, way) = drawings(step, self.stroker.unwrap_or_else(|| Stroker::of(step)));
        let drawings = drawings
            .iter()
            .filter_map(|drawing| Some((drawing, drawing.grid(step)?)));
        let drawings: Vec<_> = drawings.collect();
        let mut whole = BlendRecord::new(step, &bounds, (number, way));
        whole.first_drawn = drawings.first().map_or(0, |(_, grid)| grid.cells() as u32);
        let whole_step = Call {
            stage: BEGINS,
            record: batch.records.len(),
            blend: batch.blends.len(),
        };
        batch.blends.push(bytemuck::cast(whole));
        let record = StepRecord::new(step, &step.sweep, on, (&bounds, batch.steps));
        batch.records.push(record);
        batch.calls.push(whole_step);
        let mut blend = first_blend(number);
        for (place, (drawing, grid)) in drawings.iter().enumerate() {
            let [before, after] = &drawing.poses;
            let sweep = Sweep {
                before: None,
                from: before,
                to: after,
            };
            let first = Call {
                stage: BLENDS,
                record: batch.records.len(),
                blend: batch.blends.len(),
            };
            let record = StepRecord::new(step, &sweep, on, (grid, batch.steps));
            batch
                .records
                .push(record.draw(step, &sweep, &mut batch.poses));
            let goes_on = if place > 0 { &GOES_ON[..] } else { &[] };
            let stages = goes_on.iter().chain(&DRAWS);
            batch.calls.extend(stages.map(|stage| Call {
                stage: *stage,
                ..first
            }));
            let mut own = BlendRecord::new(step, grid, (number, way));
            own.by_even = drawing.by_even;
            let count = drawing.shifts.len();
            for (i, shift) in drawing.shifts.iter().enumerate() {
                let threshold = Dither::new(step.load.seed(), blend).parts_at(from);
                blend = blend.wrapping_add(1);
                batch.calls.push(Call {
                    blend: batch.blends.len(),
                    ..first
                });
                let own = own.at((i, count), *shift, threshold);
                batch.blends.push(bytemuck::cast(own));
            }
        }
        batch.calls.push(Call {
            stage: ENDS,
            ..whole_step
        });
        batch.steps += 1;
        Some(canvas.from[1]..canvas.from[1] + canvas.size[1])
    }
}
