//! Steps beside a plain copy of as many bytes: for who plans for a card.

use std::time::{Duration, Instant};

use maulstick_stokes::flow::Conditions;
use wgpu::BufferUsages as Usage;

use super::GpuFlow;
use maulstick_gpu::device::GpuError;

/// Steps that are given to the device before it is waited for.
const TOGETHER: usize = 8;

impl GpuFlow {
    /// Time of so many steps of what is on the device, with what the processor does to give them to it.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn time_steps(
        &mut self,
        conditions: &Conditions,
        count: usize,
    ) -> Result<Duration, GpuError> {
        self.wait()?;
        let begun = Instant::now();
        for number in 0..count {
            self.step_again(conditions)?;
            if (number + 1).is_multiple_of(TOGETHER) {
                self.wait()?;
            }
        }
        self.wait()?;
        Ok(begun.elapsed())
    }

    /// Time of copies that read and write as many bytes together as the stages of so many steps do.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn time_copies(&self, count: usize) -> Result<Duration, GpuError> {
        let gpu = &self.gpu;
        gpu.guarded(|| {
            // What is copied is a whole number of words.
            let piece = self.buffers.fields.size() / 16 * 4;
            let spare = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("stokes copy"),
                size: piece,
                usage: Usage::COPY_DST,
                mapped_at_creation: false,
            });
            gpu.wait()?;
            let begun = Instant::now();
            for _ in 0..count {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let mut left = (self.bytes / 2).next_multiple_of(4);
                while left > 0 {
                    let some = left.min(piece);
                    encoder.copy_buffer_to_buffer(&self.buffers.fields, 0, &spare, 0, some);
                    left -= some;
                }
                gpu.queue.submit([encoder.finish()]);
            }
            gpu.wait()?;
            Ok(begun.elapsed())
        })
    }
}
