//! The paint model `stokes` with its flow on the device: windows of any size, whole strokes beside those of the processor, too
//! little memory, a device that is lost.

#[path = "../../../../gpu/tests/steps/easel.rs"]
mod easel;
mod stroke;
#[path = "../../../../gpu/tests/steps/strokes.rs"]
mod strokes;
mod windows;

use maulstick_gpu::{Choice, Device};

/// An adapter: where there is no other, lavapipe.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}
