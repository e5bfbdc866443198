//! The buffers of the device and their use: upload, steps, read-back.

use std::ops::Range;
use std::sync::Arc;

use bytemuck::cast_slice;
use maulstick_brush::Head;
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::StepReport;
use wgpu::BufferUsages as Usage;

use super::device_layout::{DeviceLayout, Settled};
use super::kernels::{Binding, Groups, Kernel, Pipeline};
use super::record::{RECORD_BYTES, RECORD_WORDS, StepRecord};
use super::traffic::Traffic;
use crate::arena::{Arena, read};
use crate::device::{Device, GpuError};

/// Number of steps of a submission.
pub const BATCH: usize = 64;
/// Greatest number of blends of a batch: the device does some while the next ones are prepared.
const MOST_BLENDS: usize = 128;
/// Greatest size of a batch's poses, bytes.
const POSES_BYTES: usize = 16 << 20;
/// Words of the statistics of all steps: cells touched, wet paint and thinner on them, the highest paint.
const TALLY: u64 = 4;
/// Words of the statistics: those, and STEP_STATS a step.
const STATS: u64 = TALLY + 20 * BATCH as u64;
/// Number of invocations of a workgroup over a grid, and over strips or segments.
const GROUP: [u64; 2] = [256, 64];

/// Dispatch of a stage.
#[derive(Clone, Copy, Debug)]
pub struct Call {
    /// Index of the stage among the model's.
    pub stage: usize,
    /// Index of the record of its step.
    pub record: usize,
    /// Index of the record of its blend.
    pub blend: usize,
}

/// Steps that are not yet submitted.
#[derive(Default)]
pub struct Batch {
    /// Number of steps.
    pub steps: usize,
    /// Parameters of steps, and of the parts of steps in which the head is drawn anew.
    pub records: Vec<StepRecord>,
    /// Poses of their heads.
    pub poses: Vec<f32>,
    /// Parameters of blends.
    pub blends: Vec<[u32; RECORD_WORDS]>,
    /// Stages in order.
    pub calls: Vec<Call>,
}

impl Batch {
    /// Appends a record; returns a call of a stage with it and the next blend.
    pub fn next(&mut self, record: StepRecord, stage: usize) -> Call {
        self.records.push(record);
        Call {
            stage,
            record: self.records.len() - 1,
            blend: self.blends.len(),
        }
    }

    /// Drops all calls after the last one of the stage called `name`.
    pub fn end_after(&mut self, kernels: &[Kernel], name: &str) {
        let last = |call: &Call| kernels[call.stage].name == name;
        let count = self.calls.iter().rposition(last);
        self.calls.truncate(count.map_or(0, |last| last + 1));
    }

    /// True if the batch is to be submitted.
    pub fn is_full(&self) -> bool {
        self.steps == BATCH
            || self.blends.len() >= MOST_BLENDS
            || 4 * self.poses.len() > POSES_BYTES
    }
}

/// The device with its pipelines and buffers.
pub struct Workspace {
    /// The device.
    pub gpu: Device,
    pipelines: Vec<Pipeline>,
    records: Arena,
    buffers: Vec<Arena>,
    back: Arena,
    /// Traffic of its steps.
    pub traffic: Arc<Traffic>,
}

impl Workspace {
    /// Compiles the pipelines.
    pub fn new(gpu: Device, kernels: &'static [Kernel]) -> Result<Self, GpuError> {
        let pipelines =
            gpu.guarded(|| Ok(kernels.iter().map(|k| Pipeline::new(&gpu, k)).collect()))?;
        let storage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let buffer = |binding| {
            const GROUPS: usize = Binding::Groups as usize;
            const BLEND: usize = Binding::Blend as usize;
            let usage = match binding {
                GROUPS => storage | Usage::INDIRECT,
                BLEND => Usage::UNIFORM | Usage::COPY_DST,
                _ => storage,
            };
            Arena::new("steps", usage)
        };
        Ok(Self {
            pipelines,
            records: Arena::new("records", Usage::UNIFORM | Usage::COPY_DST),
            buffers: (0..Binding::COUNT).map(buffer).collect(),
            back: Arena::new("back", Usage::MAP_READ | Usage::COPY_DST),
            traffic: Arc::default(),
            gpu,
        })
    }

    fn fill(&mut self, binding: Binding, parts: &[&[u8]]) -> Result<(), GpuError> {
        self.buffers[binding as usize].filled(&self.gpu, parts)?;
        Ok(())
    }

    fn room(&mut self, binding: Binding, words: u64) {
        self.buffers[binding as usize].of(&self.gpu, 4 * words);
    }

    /// Uploads window and load.
    pub fn upload(
        &mut self,
        on: &DeviceLayout,
        (window, load): (&Window, &BrushLoad),
        head: &Head,
    ) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.guarded(|| {
            let nothing = vec![0.0; on.cells];
            self.fill(Binding::Planes, &on.planes(window, &nothing))?;
            let heights = [window.base(), window.ride()].map(cast_slice);
            self.fill(Binding::Base, &heights)?;
            self.fill(Binding::Load, &[cast_slice(&on.load(load))])?;
            self.fill(Binding::Head, &[cast_slice(&on.head(head))])?;
            self.fill(Binding::Asks, &[&vec![0; 4 * on.asks_words()]])?;
            let mut stats = vec![0; STATS as usize];
            stats[TALLY as usize - 1] = window.top().to_bits();
            self.fill(Binding::Stats, &[cast_slice(&stats)])?;
            self.room(Binding::Segments, 16 * on.segments() as u64);
            self.room(Binding::Groups, 24);
            Ok(())
        })
    }

    /// Submits a batch of steps.
    pub fn submit(&mut self, on: &DeviceLayout, batch: &Batch) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        gpu.guarded(|| {
            let cells = batch.records.iter().map(StepRecord::cells).max();
            let cells = cells.unwrap_or(0);
            for binding in Binding::OF_GRID {
                self.room(binding, binding.words_by_cell() * cells);
            }
            // A grid may extend beyond the window.
            let most = cells.max(on.cells as u64);
            self.room(Binding::Other, most * on.planes_in_use() as u64);
            self.fill(Binding::Blend, &[cast_slice(&batch.blends)])?;
            self.fill(Binding::Poses, &[cast_slice(&batch.poses)])?;
            self.records.filled(&gpu, &[cast_slice(&batch.records)])?;
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let buffers = &mut self.buffers;
            let buffers: Vec<&wgpu::Buffer> =
                buffers.iter_mut().map(|arena| arena.of(&gpu, 4)).collect();
            let stats = buffers[Binding::Stats as usize];
            encoder.clear_buffer(stats, 4 * TALLY, Some(4 * (STATS - TALLY)));
            let records = self.records.of(&gpu, 4);
            let bound: Vec<wgpu::BindGroup> = self
                .pipelines
                .iter()
                .map(|p| p.bind(&gpu, records, |binding| buffers[binding as usize]))
                .collect();
            let mut pass = encoder.begin_compute_pass(&Default::default());
            (0..batch.steps).for_each(|_| self.traffic.step());
            let mut last = None;
            for call in &batch.calls {
                let (pipeline, bound) = (&self.pipelines[call.stage], &bound[call.stage]);
                let record = &batch.records[call.record];
                self.traffic.dispatch(pipeline.kernel, on, record.cells());
                let offset = |number: usize| (number as u64 * RECORD_BYTES) as u32;
                let offsets = [call.record, call.blend].map(offset);
                let count = 1 + usize::from(pipeline.kernel.blends());
                if last.replace(call.stage) != Some(call.stage) {
                    pass.set_pipeline(&pipeline.pipeline);
                }
                pass.set_bind_group(0, bound, &offsets[..count]);
                let [grid, few] = GROUP;
                let count = match pipeline.kernel.groups {
                    Groups::Grid => record.cells().div_ceil(grid),
                    Groups::GridAndStrips => record.cells().max(on.strips as u64).div_ceil(grid),
                    Groups::Strips => on.strips as u64,
                    Groups::Segments => (on.segments() as u64).div_ceil(few),
                    Groups::One => 1,
                    Groups::Planned(place) => {
                        let groups = buffers[Binding::Groups as usize];
                        pass.dispatch_workgroups_indirect(groups, 16 * place);
                        continue;
                    }
                };
                pass.dispatch_workgroups(count as u32, 1, 1);
            }
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// Reads back rows of the window, the load, and the statistics.
    pub fn read_back(
        &mut self,
        on: &DeviceLayout,
        rows: Range<usize>,
        row: usize,
    ) -> Result<(Settled, StepReport), GpuError> {
        let words = rows.len() * row * on.planes_in_use();
        let load_words = on.load_words();
        let plane = |place: usize| 4 * ((place * on.cells + rows.start * row) as u64);
        let mut ranges: Vec<(Binding, u64, u64)> = (0..on.planes_in_use())
            .map(|place| (Binding::Planes, plane(place), 4 * (rows.len() * row) as u64))
            .collect();
        ranges.push((Binding::Load, 0, 4 * load_words as u64));
        ranges.push((Binding::Stats, 0, 4 * TALLY));
        self.read(&ranges, |bytes| {
            let (bytes, tally) = bytes.split_at(bytes.len() - 4 * TALLY as usize);
            let tally: Vec<u32> = bytemuck::pod_collect_to_vec(tally);
            let quanta = |word: usize| f64::from(f32::from_bits(tally[word])) * 256.0;
            let report = StepReport {
                footprint_cells: u64::from(tally[0]),
                wet: quanta(1) as u64,
                thinner: quanta(2) as u64,
                ..StepReport::default()
            };
            let top = f32::from_bits(tally[3]);
            (Settled::read(bytes, words, rows, top), report)
        })
    }

    /// Reads concatenated parts of buffers: which, offset, number of bytes.
    pub fn read<T>(
        &mut self,
        ranges: &[(Binding, u64, u64)],
        take: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, GpuError> {
        let gpu = self.gpu.clone();
        gpu.guarded(|| {
            let bytes = ranges.iter().map(|(_, _, bytes)| bytes).sum();
            let back = self.back.of(&gpu, bytes);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut at = 0;
            for (binding, from, bytes) in ranges {
                let buffer = self.buffers[*binding as usize].of(&gpu, 4);
                encoder.copy_buffer_to_buffer(buffer, *from, back, at, *bytes);
                at += bytes;
            }
            gpu.queue.submit([encoder.finish()]);
            read(&gpu, back, bytes, take)
        })
    }
}
