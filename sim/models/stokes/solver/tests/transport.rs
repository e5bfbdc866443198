//! Transport of paint: nothing is lost, and its surface keeps its place.

mod common;

use common::{BETWEEN, PERIODIC, worst};
use maulstick_num::sin_cos;
use maulstick_stokes::body::Rod;
use maulstick_stokes::domain::{Domain, Solids};
use maulstick_stokes::flow::{Conditions, Effort};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use maulstick_stokes::volume::Volume;

/// Quanta of a cell of .25 mm.
const CAPACITY: u32 = 167_772;
const CELL_M: f64 = 2.5e-4;

/// A ball that is carried round once through a periodic window comes back to its place.
#[test]
fn a_ball_that_is_carried_round_keeps_its_shape_and_its_count() {
    let grid = Grid {
        cells: [24; 3],
        ends: [PERIODIC; 3],
    };
    let mut volume = Volume::new(&grid, CAPACITY, 2);
    for place in grid.places() {
        let at = grid.cell(place).map(|at| at as f64 + 0.5);
        let squares = at.map(|at| (at - 12.0) * (at - 12.0));
        let inside = (7.0 - squares.iter().sum::<f64>().sqrt() + 0.5).clamp(0.0, 1.0);
        let count = (inside * f64::from(CAPACITY)) as u32;
        volume.paints[usize::from(at[0] > 12.0)][place] = count;
    }
    let before = volume.counts();
    let start = volume.fill(&vec![1.0; grid.len()]);
    let open = vec![1.0; grid.len()];
    let solids = Solids::walls(&grid);
    let velocity = [1.0, 1.0, 0.5].map(|u| vec![u; grid.len()]);
    // All cells are paint for the velocities.
    let domain = Domain::new(&grid, &open, &solids, 0.1);
    for _ in 0..48 {
        volume.advect(&domain, &open, &velocity, 1.0, 1.0);
    }
    assert_eq!(volume.counts(), before);
    let end = volume.fill(&open);
    let off: f64 = start
        .iter()
        .zip(&end)
        .map(|(a, b)| f64::from((a - b).abs()))
        .sum();
    let all: f64 = start.iter().map(|a| f64::from(*a)).sum();
    println!("L1 error {:.3}", off / all);
    assert!(off / all < 0.25, "{}", off / all);
}

/// A pool with a ball that circles in it for 10,000 steps.
#[test]
fn no_quantum_is_missing_after_ten_thousand_steps() {
    let grid = Grid {
        cells: [8, 8, 6],
        ends: [BETWEEN, BETWEEN, Ends::Sides([Side::NoSlip, Side::Slip])],
    };
    let mut stokes = Stokes::new(&grid, CAPACITY, 3);
    for place in grid.block([0; 3], [8, 8, 3]) {
        let [x, y, _] = grid.cell(place);
        stokes.volume.paints[((x + y) % 3) as usize][place] = CAPACITY;
    }
    let before = stokes.volume.counts();
    stokes.flow.effort = Effort {
        steps: 3,
        projections: 2,
    };
    let conditions = Conditions {
        cell_m: CELL_M,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    let turn = 0.05;
    for step in 0..10_000 {
        let (s, c) = sin_cos(f64::from(step) * turn);
        let middle = [4.0 + 1.5 * c, 4.0 + 1.5 * s, 3.0].map(|at| at as f32);
        let speed = 1.5 * turn * CELL_M / conditions.seconds;
        let ball = Rod {
            ends: [middle; 2],
            radius: 1.4,
            velocity: [[(-speed * s) as f32, (speed * c) as f32, 0.0]; 2],
        };
        stokes.step(&[ball], &conditions);
        if step % 1000 == 0 {
            assert_eq!(stokes.volume.counts(), before, "step {step}");
        }
    }
    assert_eq!(stokes.volume.counts(), before);
    let fill = stokes.volume.fill(&vec![1.0; grid.len()]);
    let fullest = worst(grid.places().map(|place| f64::from(fill[place])));
    assert!(fullest < 1.5, "paint piles up in a cell: {fullest}");
}
