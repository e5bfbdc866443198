//! Scenes for comparing the device's flow with the processor's.

use maulstick_gpu::{Device, GpuError};
use maulstick_num::{cos, sin};
use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::device::{FlowState, GpuFlow, Tuning};

/// A window, its paint, and the solids in it at each step.
pub struct Scene {
    pub name: &'static str,
    pub grid: Grid,
    pub fill: Vec<f32>,
    pub steps: Vec<(Solids, Conditions)>,
}

/// An axis between two walls.
pub const WALLS: Ends = Ends::Sides([Side::NoSlip; 2]);

/// Fill of each cell under a surface.
pub fn filled(grid: &Grid, level: impl Fn(f32, f32) -> f32) -> Vec<f32> {
    let fill = |place: usize| {
        let [x, y, z] = grid.cell(place).map(|at| at as f32);
        (level(x + 0.5, y + 0.5) - z).clamp(0.0, 1.0)
    };
    (0..grid.len()).map(fill).collect()
}

/// Paint pulled along a channel that is periodic along it and in depth.
pub fn channel() -> Scene {
    let grid = Grid {
        cells: [8, 16, 6],
        ends: [Ends::Periodic, WALLS, Ends::Periodic],
    };
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [2.0, 0.0, 0.0],
    };
    Scene {
        name: "channel",
        fill: vec![1.0; grid.len()],
        steps: vec![(Solids::walls(&grid), conditions); 2],
        grid,
    }
}

/// A rod that is drawn through a pool with waves, over a canvas that is no plane of the grid.
pub fn pool(paint: Paint) -> Scene {
    let grid = Grid {
        cells: [20, 16, 10],
        ends: [WALLS, Ends::Sides([Side::NoSlip, Side::Slip]), WALLS],
    };
    let step = |number: usize| {
        let mut solids = Solids::walls(&grid);
        solids.add(&grid, |[x, y, z]| z - 0.6 - 0.1 * (x - y));
        let x = 6.0 + 0.4 * number as f32;
        let rod = Rod {
            ends: [[x, 8.0, 3.0], [x + 1.0, 8.5, 12.0]],
            radius: 1.8,
            velocity: [[0.01, 0.002, 0.0], [0.012, 0.0, 0.001]],
        };
        voxelise(&grid, &mut solids, &[rod]);
        let conditions = Conditions {
            cell_m: 2.5e-4,
            seconds: 0.01,
            // At rest paint with a yield stress is solid, so the first step needs another one to move.
            paint: if number == 0 {
                Paint::newtonian(1e-2)
            } else {
                paint
            },
            pull: [0.0, 0.0, -9.81],
        };
        (solids, conditions)
    };
    Scene {
        name: "pool",
        fill: filled(&grid, |x, y| {
            let [x, y] = [x, y].map(f64::from);
            (6.3 + 0.6 * sin(0.7 * x) * cos(0.5 * y)) as f32
        }),
        steps: (0..3).map(step).collect(),
        grid,
    }
}

/// Shear-thinning paint with a yield stress.
pub fn thinning() -> Scene {
    let paint = Paint {
        viscosity: 1e-2,
        yields: 0.05,
        index: 0.6,
        rate: 10.0,
    };
    Scene {
        name: "shear-thinning pool",
        ..pool(paint)
    }
}

/// Porous bristles that go through a film.
pub fn bristles() -> Scene {
    let grid = Grid {
        cells: [12, 12, 10],
        ends: [Ends::Periodic, Ends::Periodic, WALLS],
    };
    let mut solids = Solids::walls(&grid);
    for place in grid.places() {
        solids.velocity[0][place] = 0.1;
    }
    let resistance = |place: usize| {
        let [x, y, _] = grid.cell(place);
        if (3..9).contains(&x) && (2..10).contains(&y) {
            0.3
        } else {
            0.0
        }
    };
    let resistance: Vec<f32> = (0..grid.len()).map(resistance).collect();
    let conditions = Conditions {
        cell_m: 1e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    solids.resistance = Some(std::array::from_fn(|_| resistance.clone()));
    Scene {
        name: "bristles",
        fill: filled(&grid, |_, _| 7.0),
        steps: vec![(solids, conditions); 2],
        grid,
    }
}

/// Largest difference of a velocity relative to the fastest one, and of a pressure relative to the largest one, after
/// each step.
pub fn differences(
    gpu: Device,
    scene: &Scene,
    effort: Effort,
    tuning: &Tuning,
) -> Result<Vec<[f64; 2]>, GpuError> {
    let mut cpu = Flow::new(&scene.grid);
    cpu.effort = effort;
    let mut device = GpuFlow::tuned(gpu, &scene.grid, effort, tuning)?;
    let mut found = Vec::new();
    for (solids, conditions) in &scene.steps {
        cpu.step(&scene.fill, solids, conditions);
        device.step(&scene.fill, solids, conditions)?;
        let state = device.read()?;
        found.push(off(&cpu, &state));
    }
    Ok(found)
}

/// The differences of one state.
pub fn off(cpu: &Flow, state: &FlowState) -> [f64; 2] {
    let grid = cpu.grid;
    let mut worst = [0.0f64; 2];
    for axis in 0..3 {
        for face in grid.faces(axis) {
            let difference = cpu.velocity[axis][face] - state.velocity[axis][face];
            // A difference that is NaN counts as large.
            let difference = f64::from(difference.abs());
            worst[0] = if difference <= worst[0] {
                worst[0]
            } else {
                difference
            };
        }
    }
    let mut largest = f64::MIN_POSITIVE;
    for place in grid.places() {
        let difference = f64::from((cpu.pressure[place] - state.pressure[place]).abs());
        worst[1] = if difference <= worst[1] {
            worst[1]
        } else {
            difference
        };
        largest = largest.max(f64::from(cpu.pressure[place].abs()));
    }
    [
        worst[0] / cpu.fastest().max(f64::MIN_POSITIVE),
        worst[1] / largest,
    ]
}
