//! Memory of a window on the device: its fields, the record of a step and those of its calls.

use bytemuck::bytes_of;
use wgpu::BufferUsages as Usage;

use maulstick_gpu::device::Device;

use super::kernels::Pipelines;
use super::record::{CALL_BYTES, CALL_STRIDE, WINDOW_BYTES};
use super::schedule::Dispatch;

/// Buffers for windows up to a size.
#[derive(Debug)]
pub(crate) struct WindowBuffers {
    pub(crate) fields: wgpu::Buffer,
    pub(crate) records: wgpu::Buffer,
    calls: wgpu::Buffer,
    pub(crate) bound: wgpu::BindGroup,
}

impl WindowBuffers {
    /// Buffers for fields of `bytes` and for `dispatches` records.
    pub(crate) fn new(gpu: &Device, pipelines: &Pipelines, bytes: u64, dispatches: usize) -> Self {
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let storage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
        let uniform = Usage::UNIFORM | Usage::COPY_DST;
        let fields = buffer("stokes fields", bytes, storage);
        let size = CALL_STRIDE * (dispatches as u64).max(1);
        let calls = buffer("stokes calls", size, uniform);
        let records = buffer("stokes step", WINDOW_BYTES, uniform);
        let call = wgpu::BufferBinding {
            buffer: &calls,
            offset: 0,
            size: wgpu::BufferSize::new(CALL_BYTES),
        };
        let resources = [
            wgpu::BindingResource::Buffer(call),
            records.as_entire_binding(),
            fields.as_entire_binding(),
        ];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let bound = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("stokes"),
            layout: &pipelines.bindings,
            entries: &entries,
        });
        Self {
            fields,
            records,
            calls,
            bound,
        }
    }

    /// True if fields of `bytes` and `dispatches` records fit.
    pub(crate) fn holds(&self, bytes: u64, dispatches: usize) -> bool {
        bytes <= self.fields.size() && CALL_STRIDE * dispatches as u64 <= self.calls.size()
    }

    /// Writes the records of the calls of a step.
    pub(crate) fn write_calls(&self, gpu: &Device, dispatches: &[Dispatch]) {
        let mut bytes = vec![0; CALL_STRIDE as usize * dispatches.len()];
        for (slot, dispatch) in bytes.chunks_mut(CALL_STRIDE as usize).zip(dispatches) {
            slot[..CALL_BYTES as usize].copy_from_slice(bytes_of(&dispatch.call));
        }
        gpu.queue.write_buffer(&self.calls, 0, &bytes);
    }
}
