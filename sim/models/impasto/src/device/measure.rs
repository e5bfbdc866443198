//! The advection alone, compared with a plain copy, for the benchmark.

use std::time::{Duration, Instant};

use bytemuck::cast_slice;

use maulstick_gpu::arena::Arena;
use maulstick_gpu::device::{Device, GpuError};
use maulstick_gpu::steps::kernels::{Binding, Kernel, Pipeline};
use maulstick_gpu::steps::record::{RECORD_BYTES, StepRecord};

use super::stages::{COPIES, KERNELS};
use crate::stages::advection::STAIN;

/// A square of cells on which all paint moves.
pub struct Measured {
    gpu: Device,
    buffers: Vec<Arena>,
    records: Arena,
    advection: Vec<Pipeline>,
    copy: Vec<Pipeline>,
    side: usize,
    paints: usize,
}

impl Measured {
    /// A square of `side` × `side` cells with `paints` paints, 40 µm of each, that moves by a third of a cell.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn new(gpu: Device, side: usize, paints: usize) -> Result<Self, GpuError> {
        let made = |kernels: &'static [Kernel], name: &str| -> Vec<Pipeline> {
            let named = kernels.iter().filter(|kernel| kernel.name == name);
            named.map(|kernel| Pipeline::new(&gpu, kernel)).collect()
        };
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let mut measured = Self {
            advection: gpu.guarded(|| Ok(made(&KERNELS, "advection")))?,
            copy: gpu.guarded(|| Ok(made(&COPIES, "copy_planes")))?,
            buffers: (0..Binding::COUNT)
                .map(|_| Arena::new("measured", storage))
                .collect(),
            records: Arena::new(
                "records",
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            ),
            gpu,
            side,
            paints,
        };
        let gpu = measured.gpu.clone();
        gpu.guarded(|| measured.fill())?;
        Ok(measured)
    }

    fn fill(&mut self) -> Result<(), GpuError> {
        let cells = self.side * self.side;
        let count = |i: usize| 26_843.0 + (i * 7919 % 4096) as f32;
        let planes: Vec<f32> = (0..cells * (1 + self.paints)).map(count).collect();
        let total = |cell: usize| {
            (0..self.paints)
                .map(|paint| count(paint * cells + cell))
                .sum()
        };
        let totals: Vec<f32> = (0..cells).map(total).collect();
        let faces = vec![[0.3f32, -0.3]; cells];
        let stats = stats_of_square(self.side as u32);
        let record = StepRecord::of_square(self.side as u32, self.paints as u32, STAIN);
        let gpu = &self.gpu;
        for (binding, bytes) in [
            (Binding::Planes, cast_slice::<f32, u8>(&planes)),
            (Binding::Other, cast_slice(&planes)),
            (
                Binding::Totals,
                cast_slice(&[&totals[..], &totals].concat()),
            ),
            (Binding::Faces, cast_slice(&faces)),
            (Binding::Stats, cast_slice(&stats)),
        ] {
            self.buffers[binding as usize].filled(gpu, &[bytes])?;
        }
        self.records.filled(gpu, &[cast_slice(&[record])])?;
        Ok(())
    }

    /// Duration of `times` advections, two passes each, submitted together.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn advection(&mut self, times: usize) -> Result<Duration, GpuError> {
        let side = self.side as u32;
        let groups = [
            [side.div_ceil(31), side.div_ceil(8)],
            [side.div_ceil(32), side.div_ceil(7)],
        ];
        Self::run(
            &self.gpu,
            &mut self.buffers,
            &mut self.records,
            &self.advection,
            groups,
            times,
        )
    }

    /// Duration of copying all counts and their sums `times` times, in as many dispatches.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn copy(&mut self, times: usize) -> Result<Duration, GpuError> {
        let half = (self.side * self.side * (1 + self.paints) / 2) as u32;
        let groups = [[half.div_ceil(256), 1]; 2];
        Self::run(
            &self.gpu,
            &mut self.buffers,
            &mut self.records,
            &self.copy,
            groups,
            times,
        )
    }

    fn run(
        gpu: &Device,
        buffers: &mut [Arena],
        records: &mut Arena,
        pipelines: &[Pipeline],
        groups: [[u32; 2]; 2],
        times: usize,
    ) -> Result<Duration, GpuError> {
        gpu.guarded(|| {
            let records = records.of(gpu, RECORD_BYTES);
            let buffers: Vec<&wgpu::Buffer> =
                buffers.iter_mut().map(|arena| arena.of(gpu, 4)).collect();
            let bind = |p: &Pipeline| p.bind(gpu, records, |binding| buffers[binding as usize]);
            let bound: Vec<wgpu::BindGroup> = pipelines.iter().map(bind).collect();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            for _ in 0..times {
                for ((pipeline, bound), [x, y]) in pipelines.iter().zip(&bound).zip(groups) {
                    pass.set_pipeline(&pipeline.pipeline);
                    pass.set_bind_group(0, bound, &[0]);
                    pass.dispatch_workgroups(x, y, 1);
                }
            }
            drop(pass);
            let commands = encoder.finish();
            gpu.wait()?;
            let begun = Instant::now();
            gpu.queue.submit([commands]);
            gpu.wait()?;
            Ok(begun.elapsed())
        })
    }
}

/// Statistics of a step that touches all of a square of `side` cells, in the layout of step.wgsl.
fn stats_of_square(side: u32) -> [u32; 24] {
    let mut stats = [0; 24];
    stats[4 + 11..4 + 15].copy_from_slice(&[65536, 65536, side, side]);
    stats
}
