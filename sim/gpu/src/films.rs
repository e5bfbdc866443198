//! Kubelka-Munk films of many tiles at once, on the device.

use bytemuck::pod_collect_to_vec;
use maulstick_optics::backend::{TILE_CELLS, check};
use maulstick_optics::{BackendError, FilmBackend, FilmPlanes, Studio};
use wgpu::BufferUsages;

use crate::arena::{Arena, read};
use crate::bake_films::BAKE_FILMS;
use crate::batch::{Batch, fitting};
use crate::device::{Device, GpuError};
use crate::shade_films::SHADE_FILMS;
use crate::stage::Pipelines;

/// Number of buffers that a shader reads.
const INPUTS: usize = 4;
/// Bytes of a plane of a tile.
const PLANE_BYTES: usize = TILE_CELLS * size_of::<f32>();
/// Greatest size of a buffer, bytes: a quarter of what every device can bind, since its memory belongs to the window
/// as well.
const BUFFER_BYTES: usize = 32 << 20;

/// Films on the device, with buffers that stay from batch to batch.
pub struct GpuFilms {
    workspace: Workspace,
    shade: Pipelines,
    bake: Pipelines,
}

impl GpuFilms {
    /// Films on a device.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver rejects the shaders.
    pub fn new(gpu: Device) -> Result<Self, GpuError> {
        Self::with_buffers(gpu, BUFFER_BYTES)
    }

    /// Films whose buffers hold at most `buffer_bytes`; larger batches are cut.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_buffers(gpu: Device, buffer_bytes: usize) -> Result<Self, GpuError> {
        let [shade, bake] = [&SHADE_FILMS, &BAKE_FILMS]
            .map(|stage| gpu.guarded(|| Ok(Pipelines::new(&gpu, stage, INPUTS as u32))));
        let input = |name| Arena::new(name, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let workspace = Workspace {
            buffer_bytes,
            inputs: ["tiles", "optics", "thickness", "under"].map(input),
            out: Arena::new("out", BufferUsages::STORAGE | BufferUsages::COPY_SRC),
            back: Arena::new("back", BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            gpu,
        };
        Ok(Self {
            workspace,
            shade: shade?,
            bake: bake?,
        })
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.workspace.gpu
    }
}

/// Shared state of all stages.
struct Workspace {
    gpu: Device,
    buffer_bytes: usize,
    inputs: [Arena; INPUTS],
    out: Arena,
    back: Arena,
}

impl Workspace {
    /// Runs a stage, and returns the planes of each tile.
    fn run<T>(
        &mut self,
        stage: &mut Pipelines,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
        split: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, BackendError> {
        check(studio, tiles)?;
        let planes = (stage.stage.planes)(studio);
        let mut all = Vec::with_capacity(tiles.len());
        let mut rest = tiles;
        while !rest.is_empty() {
            let count = fitting(studio, rest, planes, self.buffer_bytes);
            let (now, later) = rest.split_at(count);
            let gpu = self.gpu.clone();
            let made = gpu
                .guarded(|| self.batch(stage, studio, now, &split))
                .map_err(|error| BackendError::Device(Box::new(error)))?;
            all.extend(made);
            rest = later;
        }
        Ok(all)
    }

    fn batch<T>(
        &mut self,
        stage: &mut Pipelines,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
        split: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, GpuError> {
        let gpu = &self.gpu;
        let batch = Batch::new(studio, tiles);
        let tile_bytes = (stage.stage.planes)(studio) * PLANE_BYTES;
        let bytes = (tiles.len() * tile_bytes) as u64;
        let [records, optics, thickness, under] = &mut self.inputs;
        let out = self.out.of(gpu, bytes);
        let buffers = [
            records.filled(gpu, &[batch.records()])?,
            optics.filled(gpu, &[batch.optics()])?,
            thickness.filled(gpu, &batch.thickness)?,
            under.filled(gpu, &batch.under)?,
            out,
        ];
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let size = [tiles.len(), TILE_CELLS];
        stage.run(gpu, &mut encoder, studio, &buffers, size);
        let back = self.back.of(gpu, bytes);
        encoder.copy_buffer_to_buffer(out, 0, back, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        read(gpu, back, bytes, |bytes| {
            bytes.chunks_exact(tile_bytes).map(split).collect()
        })
    }
}

impl FilmBackend for GpuFilms {
    fn name(&self) -> &str {
        self.device().name()
    }

    fn shade(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<[Vec<f32>; 3]>, BackendError> {
        self.workspace.run(&mut self.shade, studio, tiles, |bytes| {
            let plane = |channel: usize| &bytes[channel * PLANE_BYTES..][..PLANE_BYTES];
            [0, 1, 2].map(|channel| pod_collect_to_vec(plane(channel)))
        })
    }

    fn bake(
        &mut self,
        studio: &Studio,
        tiles: &[FilmPlanes<'_>],
    ) -> Result<Vec<Vec<f32>>, BackendError> {
        self.workspace
            .run(&mut self.bake, studio, tiles, pod_collect_to_vec)
    }
}
