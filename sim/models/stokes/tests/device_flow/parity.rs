//! The device compared with the processor.

use maulstick_stokes::flow::Effort;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::device::Tuning;

use super::device;
use super::scenes::{Scene, bristles, channel, differences, pool, thinning};

fn scenes() -> [Scene; 4] {
    [
        channel(),
        pool(Paint::newtonian(1e-2)),
        thinning(),
        bristles(),
    ]
}

/// Tolerance relative to the fastest velocity. The processor leaves out layers of air, so its coarse grids differ: both
/// are solved down to rounding.
const TOLERANCE: f64 = 1e-5;
const EFFORT: Effort = Effort {
    steps: 20,
    projections: 5,
};

fn worst(scene: &Scene, tuning: &Tuning) -> f64 {
    let found = differences(device(), scene, EFFORT, tuning).expect("steps");
    println!("{}, {tuning:?}: {found:?}", scene.name);
    found
        .into_iter()
        .map(|[velocity, _]| velocity)
        .fold(0.0, f64::max)
}

#[test]
fn the_device_has_the_processors_velocities() {
    for scene in scenes() {
        let off = worst(&scene, &Tuning::default());
        assert!(off < TOLERANCE, "{}: {off:e}", scene.name);
    }
}

/// One workgroup does all levels, or the coarsest alone.
#[test]
fn the_share_of_one_workgroup_changes_nothing() {
    let scene = bristles();
    for rest in [u32::MAX, 0] {
        let tuning = Tuning {
            rest,
            ..Tuning::default()
        };
        let off = worst(&scene, &tuning);
        assert!(off < TOLERANCE, "{rest}: {off:e}");
    }
}

/// A seeded fault: a weight in a shader that is wrong by a hundredth.
#[test]
fn a_fault_would_be_found() {
    let faults = ["fault_link", "fault_slope"].into_iter().cycle();
    for (mut scene, fault) in scenes().into_iter().zip(faults) {
        // The first step of thinning paint is that of any.
        scene.steps.truncate(2);
        let tuning = Tuning {
            fault: Some((fault, 1.01)),
            ..Tuning::default()
        };
        let off = worst(&scene, &tuning);
        assert!(off > TOLERANCE, "{}, {fault}: {off:e}", scene.name);
    }
}
