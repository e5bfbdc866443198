//! Duration of steps compared with that of copying the same bytes, for comparing graphics cards.

use std::time::{Duration, Instant};

use maulstick_stokes::flow::Conditions;
use wgpu::BufferUsages as Usage;

use maulstick_gpu::device::GpuError;

use super::GpuFlow;

/// Number of steps submitted together.
const TOGETHER: usize = 8;

impl GpuFlow {
    /// Duration of `count` steps on the device, including their submission by the processor.
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

    /// Duration of copies that read and write as many bytes as the stages of `count` steps.
    ///
    /// # Errors
    /// A [`GpuError`] of the device.
    pub fn time_copies(&self, count: usize) -> Result<Duration, GpuError> {
        let gpu = &self.gpu;
        gpu.guarded(|| {
            // Copies have a whole number of words.
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
