//! Arbitrary windows, paints, steps and brushes.

use maulstick_gpu::GpuError;
use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::device::GpuFlow;

use super::device;
use super::scenes::filled;

/// A brush in the paint, filling the window, absent, leaping, and not finite.
fn brushes() -> [Rod; 5] {
    let upright = |x: f32, radius: f32, velocity: [[f32; 3]; 2]| Rod {
        ends: [[x, 6.0, 1.5], [x, 6.0, 9.0]],
        radius,
        velocity,
    };
    [
        upright(4.0, 1.5, [[0.3, 0.0, 0.0]; 2]),
        upright(6.0, 40.0, [[0.1, 0.2, -0.1]; 2]),
        upright(-300.0, 2.0, [[5.0, 0.0, 0.0]; 2]),
        upright(9.0, 2.0, [[-30.0, 10.0, -3.0]; 2]),
        upright(f32::NAN, 1.5, [[0.0, 0.5, 0.0]; 2]),
    ]
}

#[test]
fn whatever_the_brush_does_all_is_finite() {
    let grid = Grid::walled([12, 12, 8]);
    let fill = filled(&grid, |_, _| 4.2);
    let mut flow = GpuFlow::new(device(), &grid, Effort::default()).expect("made");
    for viscosity in [1e-6, 1e2] {
        for seconds in [1e-6, 1.0] {
            for yields in [0.0, 1e-2] {
                let at_rest: [Vec<f32>; 3] = std::array::from_fn(|_| grid.field());
                flow.write(&at_rest, &grid.field()).expect("written");
                let conditions = Conditions {
                    cell_m: 2.5e-4,
                    seconds,
                    paint: Paint {
                        yields,
                        index: 0.7,
                        ..Paint::newtonian(viscosity)
                    },
                    pull: [0.0, 0.0, -9.81],
                };
                for (number, rod) in brushes().into_iter().enumerate() {
                    let mut solids = Solids::walls(&grid);
                    voxelise(&grid, &mut solids, &[rod]);
                    flow.step(&fill, &solids, &conditions).expect("a step");
                    let state = flow.read().expect("read");
                    let all = state.velocity.iter().flatten().chain(&state.pressure);
                    assert!(
                        all.into_iter().all(|value| value.is_finite()),
                        "{viscosity} m²/s, {seconds} s, yield stress {yields}, brush {number}"
                    );
                }
            }
        }
    }
}

/// A window that no device has memory for, or that no index reaches, is refused, with the memory it needs.
#[test]
fn a_window_that_does_not_fit_is_refused() {
    let gpu = device();
    let limits = gpu.device.limits();
    let most = limits
        .max_buffer_size
        .min(limits.max_storage_buffer_binding_size);
    let sides = [64, 128, 192, 256, 384, 512, 2048];
    let too_large = sides.map(|side| Grid::walled([side; 3])).into_iter();
    let mut too_large = too_large.filter(|grid| {
        GpuFlow::window_bytes(grid, Effort::default()).map_or(true, |bytes| bytes > most)
    });
    let grid = too_large.next().expect("a window that is too large");
    let refusal = GpuFlow::new(gpu.clone(), &grid, Effort::default()).err();
    let Some(GpuError::Window { needs, .. }) = refusal else {
        panic!("{refusal:?}");
    };
    assert!(needs > most);
    // The device is still there for one that fits.
    let grid = Grid::walled([8; 3]);
    let mut flow = GpuFlow::new(gpu, &grid, Effort::default()).expect("made");
    assert_eq!(flow.read().expect("read").velocity[0], grid.field());
}

#[test]
fn a_lost_device_is_an_error_of_the_next_step() {
    let gpu = device();
    let grid = Grid::walled([8; 3]);
    let mut flow = GpuFlow::new(gpu.clone(), &grid, Effort::default()).expect("made");
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    let fill = filled(&grid, |_, _| 4.0);
    let solids = Solids::walls(&grid);
    flow.step(&fill, &solids, &conditions).expect("a step");
    gpu.device.destroy();
    let after = flow
        .step(&fill, &solids, &conditions)
        .and_then(|()| flow.read().map(drop));
    assert!(matches!(after, Err(GpuError::Lost(_))), "{after:?}");
}
