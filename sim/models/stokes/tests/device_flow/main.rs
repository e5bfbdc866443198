//! The flow of Stokes Paint on the device compared with the processor's, and with known answers.

#[allow(unreachable_pub, reason = "scenes are what tests share")]
mod scenes;

mod answers;
mod parity;
mod robust;
mod transport;

use maulstick_gpu::{Choice, Device};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng as _;

/// An adapter, lavapipe if there is no other.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}

/// Uniform in 0..1.
fn unit(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}
