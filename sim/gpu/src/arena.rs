//! Buffers that are reused from batch to batch and grow as needed.

use crate::device::{Device, GpuError};

/// A growing buffer of the device.
#[derive(Debug)]
pub struct Arena {
    name: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl Arena {
    /// A buffer without memory yet.
    pub fn new(name: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self {
            name,
            usage,
            buffer: None,
        }
    }

    /// The buffer, of at least `bytes`; growing discards its contents.
    pub fn of(&mut self, gpu: &Device, bytes: u64) -> &wgpu::Buffer {
        let large_enough = |buffer: &wgpu::Buffer| buffer.size() >= bytes;
        if !self.buffer.as_ref().is_some_and(large_enough) {
            // A buffer that is too small is dropped first, to make room.
            self.buffer = None;
        }
        self.buffer.get_or_insert_with(|| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.name),
                size: bytes.max(256).next_power_of_two(),
                usage: self.usage,
                mapped_at_creation: false,
            })
        })
    }

    /// The buffer, filled with the concatenated `parts`.
    pub fn filled(&mut self, gpu: &Device, parts: &[&[u8]]) -> Result<&wgpu::Buffer, GpuError> {
        let bytes: usize = parts.iter().map(|part| part.len()).sum();
        let buffer = self.of(gpu, bytes as u64);
        let Some(size) = wgpu::BufferSize::new(bytes as u64) else {
            return Ok(buffer);
        };
        // Absent where the driver is out of memory; the error scope reports it.
        let mut view = gpu
            .queue
            .write_buffer_with(buffer, 0, size)
            .ok_or(GpuError::Memory)?;
        let mut at = 0;
        for part in parts {
            view.slice(at..at + part.len()).copy_from_slice(part);
            at += part.len();
        }
        Ok(buffer)
    }
}

/// Reads the first `bytes` of a buffer that can be mapped, once the device is done.
pub fn read<T>(
    gpu: &Device,
    buffer: &wgpu::Buffer,
    bytes: u64,
    take: impl FnOnce(&[u8]) -> T,
) -> Result<T, GpuError> {
    let slice = buffer.slice(..bytes);
    let (send, mapped) = std::sync::mpsc::channel();
    slice.map_async(wgpu::MapMode::Read, move |result| {
        // The receiver is gone where the wait failed, which reports its own error.
        send.send(result.is_ok()).ok();
    });
    gpu.wait()?;
    if mapped.try_recv() != Ok(true) {
        return Err(GpuError::Refused("its memory cannot be read".to_owned()));
    }
    let view = slice
        .get_mapped_range()
        .map_err(|error| GpuError::Refused(error.to_string()))?;
    let taken = take(&view);
    drop(view);
    buffer.unmap();
    Ok(taken)
}
