//! dAb on the device: the stages of the paint model `dab`, in WGSL.
//!
//! The number and the places of a step's blends follow from the heads alone, so the processor knows them beforehand.
//! The device draws the head once for each drawing, and a dispatch blends it with the canvas at each place of its path.
//! Between blends the brush's films are on the cells of the drawing, in whole quanta; the thresholds are those of the
//! processor in fixed point.
//!
//! | module | holds |
//! | --- | --- |
//! | `stages` | the stages |
//! | `drawing` | the drawings of the head in a step |
//! | `record` | a blend in the layout of the shaders |
//! | [`probe`] | results of single stages, for tests |

mod drawing;
pub mod probe;
mod record;
mod stages;

use std::ops::Range;

use maulstick_model::interface::Step;

use crate::dither::Dither;
use crate::stroke::Stroker;
use crate::{Dab, first_blend};

use drawing::{drawings, grid};
use maulstick_gpu::steps::device_layout::DeviceLayout;
use maulstick_gpu::steps::model::{GpuModel, Planner};
use maulstick_gpu::steps::record::StepRecord;
use maulstick_gpu::steps::workspace::{Batch, Call};
use maulstick_gpu::{Choice, Device, GpuError, OnDevice};
use record::BlendRecord;
use stages::{BLEND, DRAW, KERNELS, NEXT_DRAWING, REFILL, WEIGH};

/// The paint model on a device; the load on the machine selects its stroking algorithm.
///
/// # Errors
/// A [`GpuError`] where the driver rejects the shaders.
pub fn model(gpu: Device) -> Result<GpuModel, GpuError> {
    let steps = Steps { stroker: None };
    GpuModel::new(gpu, &KERNELS, Box::new(steps), Box::<Dab>::default())
}

/// The paint model with a fixed stroking algorithm.
///
/// # Errors
/// As [`model`].
pub fn stroking(gpu: Device, stroker: Stroker) -> Result<GpuModel, GpuError> {
    let steps = Steps {
        stroker: Some(stroker),
    };
    let cpu = Box::new(Dab::stroking(stroker));
    GpuModel::new(gpu, &KERNELS, Box::new(steps), cpu)
}

/// The model for the registry.
pub(crate) fn make(gpu: Device, _choice: Choice) -> Result<OnDevice, GpuError> {
    model(gpu).map(OnDevice::from)
}

/// Steps of dAb as stages.
struct Steps {
    stroker: Option<Stroker>,
}

impl Planner for Steps {
    fn plan(
        &self,
        step: &Step<'_>,
        on: &DeviceLayout,
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
        let mut own = BlendRecord::new(step, &bounds, (number, way));
        own.first_drawn = drawings.first().map_or(0, |(_, grid)| grid.cells() as u32);
        let record = StepRecord::new(step, &step.sweep, on, (&bounds, batch.steps));
        let whole = batch.next(record, WEIGH);
        batch.blends.push(bytemuck::cast(own));
        batch.calls.push(whole);
        let mut numbered = first_blend(number);
        for (place, (drawing, grid)) in drawings.iter().enumerate() {
            let sweep = drawing.sweep();
            let record = StepRecord::new(step, &sweep, on, (grid, batch.steps));
            let record = record.draw(step, &sweep, &mut batch.poses);
            let call = batch.next(record, BLEND);
            let between = if place > 0 { &NEXT_DRAWING[..] } else { &[] };
            let stages = between.iter().chain(&DRAW);
            batch.calls.extend(stages.map(|stage| Call {
                stage: *stage,
                ..call
            }));
            let mut own = BlendRecord::new(step, grid, (number, way));
            own.by_even = drawing.by_even;
            let count = drawing.shifts.len();
            for (i, shift) in drawing.shifts.iter().enumerate() {
                let threshold = Dither::new(step.load.seed(), numbered).parts_at(from);
                numbered = numbered.wrapping_add(1);
                let blend = batch.blends.len();
                batch.calls.push(Call { blend, ..call });
                let own = own.at((i, count), *shift, threshold);
                batch.blends.push(bytemuck::cast(own));
            }
        }
        batch.calls.push(Call {
            stage: REFILL,
            ..whole
        });
        batch.steps += 1;
        Some(canvas.from[1]..canvas.from[1] + canvas.size[1])
    }
}
