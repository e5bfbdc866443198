//! The stages of an impasto step on the device beside those of the processor, on the seeded scenes of
//! these; whole strokes; a device that is lost.

#[path = "../../../impasto/tests/oracle/scene.rs"]
#[allow(
    dead_code,
    reason = "the scenes of the paint's oracle: not all of it is used here"
)]
mod scene;

mod easel;
mod footprint;
mod modes;
mod probed;
mod stroke;
mod transport;
mod within_head;

use maulstick_gpu::{Choice, Device};

/// An adapter: where there is no other, lavapipe.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}
