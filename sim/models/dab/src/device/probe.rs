//! State on the device after a stage of a step, for tests that compare each stage with its twin.

use bytemuck::pod_collect_to_vec;
use maulstick_model::interface::Step;

use crate::stroke::Stroker;

use maulstick_gpu::device::{Device, GpuError};
use maulstick_gpu::steps::kernels::Binding;
use maulstick_gpu::steps::probing::Probing;

use super::Steps;
use super::drawing::drawings;
use super::stages::KERNELS;

/// The part of the head over a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Over {
    /// Column and row of the cell on the grid.
    pub at: [usize; 2],
    /// Texel of the brush.
    pub texel: u32,
    /// Share of the cell that is covered.
    pub cover: f32,
    /// Transferred share, times the cover.
    pub rate: f32,
    /// Path times the cover, reference cells.
    pub way: f32,
    /// Height of the middle line of the bristle, cells.
    pub height: f32,
    /// Height of its lower side over the middle line, cells.
    pub clearance: f32,
}

/// State after a stage.
#[derive(Clone, Debug)]
pub struct Probe {
    /// The surface's cell at the lower left corner of the grid.
    pub origin: [i64; 2],
    /// Columns and rows of the grid.
    pub size: [usize; 2],
    /// The cells below the last drawing of the head, row by row.
    pub over: Vec<Over>,
}

/// Stages of steps, run separately.
pub struct Prober {
    stages: Probing<Steps>,
    stroker: Stroker,
}

impl Prober {
    /// The stages on a device, with this stroking algorithm.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver rejects the shaders.
    pub fn new(gpu: Device, stroker: Stroker) -> Result<Self, GpuError> {
        let steps = Steps {
            stroker: Some(stroker),
        };
        let stages = Probing::new(gpu, &KERNELS, steps)?;
        Ok(Self { stages, stroker })
    }

    /// Runs the stages of a step up to the last one called `last`, writes their result to its window and load, and
    /// returns their other results. `None` where the head is beside the surface, or its window is too large.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn run(&mut self, step: &mut Step<'_>, last: &str) -> Result<Option<Probe>, GpuError> {
        let grid = drawings(step, self.stroker).0.pop();
        let grid = grid.and_then(|drawing| drawing.grid(step));
        let (Some(probed), Some(grid)) = (self.stages.run(step, last)?, grid) else {
            return Ok(None);
        };
        let size = grid.size.map(|cells| cells as usize);
        let bytes = 32 * (size[0] * size[1]) as u64;
        let ranges = [(Binding::Contacts, 0, bytes)];
        let drawn: Vec<[u32; 8]> = self.stages.workspace.read(&ranges, pod_collect_to_vec)?;
        self.stages.write(probed, step)?;
        let over = drawn.iter().enumerate().filter_map(|(cell, words)| {
            let value = |word: usize| f32::from_bits(words[word]);
            (words[0] != u32::MAX).then(|| Over {
                at: [cell % size[0], cell / size[0]],
                texel: words[0],
                cover: value(1),
                rate: value(2),
                way: value(3),
                height: value(4),
                clearance: value(5),
            })
        });
        Ok(Some(Probe {
            origin: [0, 1].map(|i| step.window.origin()[i] + grid.from[i]),
            size,
            over: over.collect(),
        }))
    }
}
