//! IMPaSTo on the device: the stages of the paint model `impasto`, in WGSL.
//!
//! Counts stay whole: all requests to one donor are summed in integers, truncated, and moved from one side to the
//! other.
//!
//! | module | holds |
//! | --- | --- |
//! | `stages` | the stages in their order |
//! | [`measure`] | the advection beside a copy, for the benchmark |
//! | [`probe`] | results of single stages, for tests |

pub mod measure;
pub mod probe;
mod stages;

use std::ops::Range;

use maulstick_model::interface::Step;

use crate::Impasto;

use maulstick_gpu::steps::device_layout::DeviceLayout;
use maulstick_gpu::steps::model::{GpuModel, Planner};
use maulstick_gpu::steps::record::{Grid, StepRecord};
use maulstick_gpu::steps::workspace::{Batch, Call};
use maulstick_gpu::{Choice, Device, GpuError, OnDevice};
use stages::{KERNELS, PUSHES};

/// The paint model on a device.
///
/// # Errors
/// A [`GpuError`] where the driver rejects the shaders.
pub fn model(gpu: Device) -> Result<GpuModel, GpuError> {
    GpuModel::new(gpu, &KERNELS, Box::new(Steps), Box::<Impasto>::default())
}

/// Constructor for the registry.
pub(crate) fn make(gpu: Device, _choice: Choice) -> Result<OnDevice, GpuError> {
    model(gpu).map(OnDevice::from)
}

/// Planner of impasto's steps.
struct Steps;

impl Planner for Steps {
    fn has_sheets(&self) -> bool {
        true
    }

    fn plan(
        &self,
        step: &Step<'_>,
        on: &DeviceLayout,
        _number: u64,
        batch: &mut Batch,
    ) -> Option<Range<usize>> {
        let grid = pushed(step)?;
        let of = (&grid, batch.steps);
        let record = StepRecord::new(step, &step.sweep, on, of);
        let record = record.draw(step, &step.sweep, &mut batch.poses);
        let call = batch.next(record, 0);
        let stages = stages(step.traits.parts);
        batch
            .calls
            .extend(stages.map(|stage| Call { stage, ..call }));
        batch.steps += 1;
        let first = grid.from[1] as usize;
        Some(first..first + grid.size[1] as usize)
    }
}

/// The cells on which paint may move: it is pushed a cell beyond the reach of the brush. `None` where the head is
/// beside the surface.
fn pushed(step: &Step<'_>) -> Option<Grid> {
    let touched = step.window.area(step.bounds.0, step.bounds.1);
    if touched.is_empty() {
        return None;
    }
    let (from, to) = step.bounds;
    let around = step.window.area(from.map(|at| at - 1), to.map(|at| at + 1));
    let low = [0, 1].map(|i| (touched.from[i] - around.from[i]) as u32);
    Some(Grid {
        from: around.from.map(|cell| cell as i64),
        size: around.size.map(|cells| cells as u32),
        inside: [low, [0, 1].map(|i| low[i] + touched.size[i] as u32)],
    })
}

/// The stages of a step, in order; those that push paint once for each of its parts.
fn stages(parts: u32) -> impl Iterator<Item = usize> {
    let pushes = |place: &usize| KERNELS[*place].name == PUSHES;
    let pushing: Vec<usize> = (0..KERNELS.len()).filter(pushes).collect();
    let end = pushing.last().map_or(0, |last| last + 1);
    let again = pushing.repeat(parts.saturating_sub(1) as usize);
    (0..end).chain(again).chain(end..KERNELS.len())
}
