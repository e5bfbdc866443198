//! Paint of any viscosity, steps of any length and any motion of the brush: all stays finite, and nothing is lost.

use maulstick_num::fork_join::with_threads;
use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Flow, Scheme};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;

const CAPACITY: u32 = 167_772;

/// A brush in each of five steps: in the paint, filling the window, gone, at another place, turning.
fn brushes() -> [Vec<Rod>; 5] {
    let upright = |x: f32, radius: f32, velocity: [[f32; 3]; 2]| {
        vec![Rod {
            ends: [[x, 6.0, 1.5], [x, 6.0, 9.0]],
            radius,
            velocity,
        }]
    };
    [
        upright(4.0, 1.5, [[0.3, 0.0, 0.0]; 2]),
        upright(6.0, 40.0, [[0.1, 0.2, -0.1]; 2]),
        upright(-300.0, 2.0, [[5.0, 0.0, 0.0]; 2]),
        upright(9.0, 2.0, [[-30.0, 10.0, -3.0]; 2]),
        upright(5.0, 1.5, [[0.0, 0.5, 0.0], [0.0, -0.5, 0.0]]),
    ]
}

#[test]
fn whatever_the_brush_does_all_is_finite_and_counted() {
    let grid = Grid::walled([12, 12, 8]);
    for scheme in [Scheme::Unified, Scheme::Split] {
        for viscosity in [1e-6, 1e-2, 1e2] {
            for seconds in [1e-6, 1e-2, 1.0] {
                for yields in [0.0, 1e-2] {
                    let mut stokes = Stokes::new(&grid, CAPACITY, 2);
                    stokes.flow.scheme = scheme;
                    for place in grid.block([0; 3], [12, 12, 4]) {
                        let paint = usize::from(grid.cell(place)[0] > 5);
                        stokes.volume.paints[paint][place] = CAPACITY;
                    }
                    let before = stokes.volume.counts();
                    let paint = Paint {
                        yields,
                        index: 0.7,
                        ..Paint::newtonian(viscosity)
                    };
                    let conditions = Conditions {
                        cell_m: 2.5e-4,
                        seconds,
                        paint,
                        pull: [0.0, 0.0, -9.81],
                    };
                    for (number, brush) in brushes().iter().chain(&brushes()).enumerate() {
                        stokes.step(brush, &conditions);
                        let case =
                            format!("{scheme:?}, {viscosity} m²/s, {seconds} s, step {number}");
                        let all = stokes
                            .flow
                            .velocity
                            .iter()
                            .flatten()
                            .chain(&stokes.flow.pressure);
                        assert!(all.into_iter().all(|value| value.is_finite()), "{case}");
                        assert_eq!(stokes.volume.counts(), before, "{case}");
                    }
                }
            }
        }
    }
}

/// The outflow of a cell equals its inflow, to 1e-5 of the brush's speed.
#[test]
fn the_velocity_is_free_of_divergence() {
    let grid = Grid::walled([24, 16, 12]);
    for viscosity in [1e-6, 1e-2, 1e2] {
        let mut flow = Flow::new(&grid);
        flow.relief = 0.0;
        let fill = |place| (5.3 - grid.cell(place)[2] as f32).clamp(0.0, 1.0);
        let fill: Vec<f32> = (0..grid.len()).map(fill).collect();
        let conditions = Conditions {
            cell_m: 2.5e-4,
            seconds: 0.01,
            paint: Paint::newtonian(viscosity),
            pull: [0.0; 3],
        };
        for step in 0..4u16 {
            let mut solids = Solids::walls(&grid);
            let x = 6.0 + f32::from(step);
            let rod = Rod {
                ends: [[x, 8.0, 3.0], [x, 8.0, 12.0]],
                radius: 2.0,
                velocity: [[0.025, 0.0, 0.0]; 2],
            };
            voxelise(&grid, &mut solids, &[rod]);
            let domain = flow.step(&fill, &solids, &conditions);
            let divergence = flow.divergence(&domain, &solids);
            println!("{viscosity} m²/s: {divergence:.1e}");
            assert!(divergence < 1e-5, "{viscosity}: {divergence:e}");
        }
    }
}

/// The same bytes with one thread and with three.
#[test]
fn threads_change_no_byte() {
    let grid = Grid::walled([16, 16, 8]);
    let paint = || {
        let mut stokes = Stokes::new(&grid, CAPACITY, 1);
        for place in grid.block([0; 3], [16, 16, 4]) {
            stokes.volume.paints[0][place] = CAPACITY;
        }
        let conditions = Conditions {
            cell_m: 2.5e-4,
            seconds: 0.01,
            paint: Paint::newtonian(1e-2),
            pull: [0.0, 0.0, -9.81],
        };
        for brush in brushes() {
            stokes.step(&brush, &conditions);
        }
        (
            stokes.flow.velocity,
            stokes.flow.pressure,
            stokes.volume.paints,
        )
    };
    assert!(paint() == with_threads(3, paint));
}

/// A rod that is drawn through paint: the paint ahead of it rises.
#[test]
fn a_rod_pushes_paint_ahead_of_it() {
    let grid = Grid::walled([24, 16, 12]);
    let mut stokes = Stokes::new(&grid, CAPACITY, 1);
    for place in grid.block([0; 3], [24, 16, 4]) {
        stokes.volume.paints[0][place] = CAPACITY;
    }
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 5e-3,
        paint: Paint::newtonian(1e-2),
        pull: [0.0; 3],
    };
    let before = stokes.volume.counts();
    let mut x = 5.0;
    for _ in 0..30 {
        let rod = Rod {
            ends: [[x, 8.0, 2.0], [x, 8.0, 12.0]],
            radius: 2.0,
            velocity: [[
                (0.3 * conditions.cell_m / conditions.seconds) as f32,
                0.0,
                0.0,
            ]; 2],
        };
        stokes.step(&[rod], &conditions);
        x += 0.3;
    }
    assert_eq!(stokes.volume.counts(), before);
    let above = |from: isize, to: isize| {
        let cells = grid.block([from, 4, 4], [to, 12, 12]);
        cells
            .map(|place| u64::from(stokes.volume.paints[0][place]))
            .sum::<u64>()
    };
    let (ahead, behind) = (above(15, 22), above(2, 9));
    assert!(
        ahead > 4 * behind && ahead > u64::from(CAPACITY),
        "{ahead} {behind}"
    );
}
