//! The paint model `stokes` with its flow on the device: windows of any size, whole strokes compared with the
//! processor's, too little memory, a lost device.

#[path = "../../../../gpu/tests/steps/easel.rs"]
mod easel;
mod stroke;
#[path = "../../../../gpu/tests/steps/strokes.rs"]
mod strokes;
mod windows;

use maulstick_gpu::{Choice, Device};

/// An adapter, lavapipe if there is no other.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}
