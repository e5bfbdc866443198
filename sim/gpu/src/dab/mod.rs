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

/// The grid on which the head is drawn, which may go beyond the window; none where it is beside the surface.
fn drawn_on(step: &Step<'_>) -> Option<Grid> {
    let (from, to) = step.bounds;
    let origin = step.window.origin();
    let size = [0, 1].map(|i| (to[i] - from[i]).max(0) as u32);
    let grid = Grid {
        from: [0, 1].map(|i| from[i] - origin[i]),
        size,
        inside: [[0; 2], size],
    };
    (!step.window.area(from, to).is_empty()).then_some(grid)
}

impl Planner for Steps {
    fn plan(
        &self,
        step: &Step<'_>,
        on: &Residence,
        number: u64,
        batch: &mut Batch,
    ) -> Option<Range<usize>> {
        let grid = drawn_on(step)?;
        let cells = u64::from(grid.size[0]) * u64::from(grid.size[1]);
        if !on.has_room(cells) {
            return None;
        }
        let stroker = self.stroker.unwrap_or_else(|| Stroker::of(step));
        let (drawings, way) = drawings(step, stroker);
        let own = BlendRecord::new(step, &grid, (number, way));
        let mut blend = first_blend(number);
        for (place, drawing) in drawings.iter().enumerate() {
            let [before, after] = &drawing.poses;
            let sweep = Sweep {
                before: None,
                from: before,
                to: after,
            };
            let of = (&grid, batch.steps);
            let record = StepRecord::new(step, &sweep, on, of, &mut batch.poses);
            let number = batch.records.len();
            batch.records.push(record);
            let call = |stage, blends: usize| Call {
                stage,
                record: number,
                blend: blends,
            };
            let first = batch.blends.len();
            match place {
                0 => batch.calls.push(call(BEGINS, first)),
                _ => batch.calls.extend(GOES_ON.map(|stage| call(stage, first))),
            }
            batch.calls.extend(DRAWS.map(|stage| call(stage, first)));
            let count = drawing.shifts.len();
            for (i, shift) in drawing.shifts.iter().enumerate() {
                let dither = Dither::new(step.load.seed(), blend);
                blend = blend.wrapping_add(1);
                let thresholds = (dither, step.bounds.0);
                let mut own = own.at((i, count), *shift, thresholds);
                own.by_even = drawing.by_even;
                batch.calls.push(call(BLENDS, batch.blends.len()));
                batch.blends.push(bytemuck::cast(own));
            }
            if place + 1 == drawings.len() {
                batch.calls.push(call(ENDS, first));
            }
        }
        batch.steps += 1;
        let canvas = step.window.area(step.bounds.0, step.bounds.1);
        Some(canvas.from[1]..canvas.from[1] + canvas.size[1])
    }
}
