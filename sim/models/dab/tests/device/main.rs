//! The stages of a dab step on the device compared with the processor's, on seeded scenes; whole strokes; a lost
//! device.

#[path = "../../../impasto/tests/oracle/scene.rs"]
#[allow(
    dead_code,
    reason = "the scenes of another paint's oracle: not all of it is used here"
)]
mod scene;

#[path = "../../../../gpu/tests/steps/crumpled.rs"]
mod crumpled;
mod drawing;
#[path = "../../../../gpu/tests/steps/easel.rs"]
#[allow(dead_code, reason = "shared with impasto's strokes")]
mod easel;
#[path = "../../../../gpu/tests/steps/modes.rs"]
mod modes;
mod reservoir;
mod stroke;
#[path = "../../../../gpu/tests/steps/strokes.rs"]
mod strokes;
mod transfer;

use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;

use maulstick_gpu::{Choice, Device};

use crate::scene::Scene;

/// An adapter, lavapipe if there is no other.
fn device() -> Device {
    Device::open(Choice::Forced)
        .expect("a Vulkan driver: install mesa-vulkan-drivers, as ./test does")
}

#[test]
fn every_mode_does_what_the_processor_does() {
    for stroker in [Stroker::Faster, Stroker::Better] {
        let mut gpu = maulstick_dab::device::stroking(device(), stroker).expect("taken");
        // Where rounding decides about a cell's bristle, or about a unit, whole units differ.
        let near = modes::Near {
            quanta: [8.0, 24.0],
            beyond: 0.002,
        };
        // One blend, and several drawings with several blends.
        for scene in [Scene::new, |seed| Scene::far(seed, 6.0)] {
            modes::agree(&mut gpu, &mut Dab::stroking(stroker), near, scene);
        }
    }
}
