//! What stages of a step leave on the device: for the tests that hold each beside its twin.

use crate::stroke::Stroker;
use bytemuck::pod_collect_to_vec;
use maulstick_model::interface::Step;

use super::Steps;
use super::drawing::drawings;
use super::stages::KERNELS;
use maulstick_gpu::device::{Device, GpuError};
use maulstick_gpu::steps::kernels::Binding;
use maulstick_gpu::steps::probing::Probing;

/// The head over a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Over {
    /// Column and row of the cell on the grid.
    pub at: [usize; 2],
    /// The brush's texel.
    pub texel: u32,
    /// Share of the cell that is covered.
    pub cover: f32,
    /// Share that goes over, by the cover.
    pub rate: f32,
    /// Way by the cover, reference cells.
    pub way: f32,
    /// Height of the middle line of the bristle, cells.
    pub height: f32,
    /// Height of its lower side over that, cells.
    pub clearance: f32,
}

/// What is looked at.
#[derive(Clone, Debug)]
pub struct Probe {
    /// The surface's cell at the lower left corner of the grid.
    pub origin: [i64; 2],
    /// Columns and rows of the grid.
    pub size: [usize; 2],
    /// The cells below the head as it was drawn last, row after row.
    pub over: Vec<Over>,
}

/// Stages of steps, one after the other.
pub struct Prober {
    stages: Probing<Steps>,
    stroker: Stroker,
}

impl Prober {
    /// The stages on a device, of this stroking algorithm.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver does not take the shaders.
    pub fn new(gpu: Device, stroker: Stroker) -> Result<Self, GpuError> {
        let steps = Steps {
            stroker: Some(stroker),
        };
        let stages = Probing::new(gpu, &KERNELS, steps)?;
        Ok(Self { stages, stroker })
    }

    /// Does those stages of a step that come up to the last one called `last`, writes what they did to
    /// its window and load, and tells what else they left. None where the head is beside the surface,
    /// or its window is too large.
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
