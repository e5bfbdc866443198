//! The stages of an impasto step on the device compared with the processor's, on seeded scenes; whole strokes; a lost
//! device.

#[path = "../oracle/scene.rs"]
#[allow(
    dead_code,
    reason = "the scenes of the paint's oracle: not all of it is used here"
)]
mod scene;

#[path = "../../../../gpu/tests/steps/crumpled.rs"]
mod crumpled;
#[path = "../../../../gpu/tests/steps/easel.rs"]
mod easel;
mod footprint;
#[path = "../../../../gpu/tests/steps/modes.rs"]
mod modes;
mod probed;
mod stroke;
#[path = "../../../../gpu/tests/steps/strokes.rs"]
mod strokes;
mod transport;
mod within_head;

use maulstick_gpu::{Choice, Device};
use maulstick_impasto::Impasto;

/// An adapter, lavapipe if there is no other.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}

#[test]
fn every_mode_does_what_the_processor_does() {
    let mut gpu = maulstick_impasto::device::model(device()).expect("taken");
    let near = modes::Near {
        quanta: [4.0, 24.0],
        beyond: 0.0,
    };
    modes::agree(&mut gpu, &mut Impasto::default(), near, scene::Scene::new);
}
