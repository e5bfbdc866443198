//! Paint that flows: nothing is lost, and its surface stays where it is.

mod common;

use common::{BETWEEN, PERIODIC, worst};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Flow};
use maulstick_stokes::grid::{Ends, Grid, Side};
use maulstick_stokes::rheology::Paint;
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
    // All is paint, as far as velocities go.
    let domain = maulstick_stokes::domain::Domain::new(&grid, &open, &solids, 0.1);
    for _ in 0..48 {
        volume.advect(&domain, &open, &velocity, 1.0, 1.0);
    }
    assert_eq!(volume.counts(), before);
    let end = volume.fill(&open);
    let off: f64 = start.iter().zip(&end).map(|(a, b)| f64::from((a - b).abs())).sum();
    let all: f64 = start.iter().map(|a| f64::from(*a)).sum();
    println!("L1 error {:.3}", off / all);
    assert!(off / all < 0.25, "{}", off / all);
}

/// A heap on a floor, with a ball that goes round in it for 10,000 steps.
#[test]
fn no_quantum_is_missing_after_ten_thousand_steps() {
    let grid = Grid {
        cells: [16, 16, 10],
        ends: [BETWEEN, BETWEEN, Ends::Sides([Side::NoSlip, Side::Slip])],
    };
    let mut volume = Volume::new(&grid, CAPACITY, 3);
    for place in grid.places() {
        let [x, y, z] = grid.cell(place);
        if z < 4 {
            volume.paints[((x + y) % 3) as usize][place] = CAPACITY;
        }
    }
    let before = volume.counts();
    let mut flow = Flow::new(&grid);
    flow.effort.steps = 4;
    flow.effort.projections = 3;
    let conditions = Conditions {
        cell_m: CELL_M,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    let mut fullest: f32 = 0.0;
    for step in 0..10_000 {
        if std::env::var("SHORT").is_ok() && step > 600 { break; }
        let angle = f64::from(step) * 0.05;
        let [s, c] = [maulstick_num::sin(angle), maulstick_num::cos(angle)];
        let middle = [8.0 + 4.0 * c, 8.0 + 4.0 * s, 4.0];
        let mut solids = Solids::walls(&grid);
        let ball = |corner: [f32; 3]| {
            let squares = [0, 1, 2].map(|i| f64::from(corner[i]) - middle[i]).map(|d| d * d);
            (squares.iter().sum::<f64>().sqrt() - 2.4) as f32
        };
        solids.add(&grid, ball);
        let speed = 4.0 * 0.05 * CELL_M / conditions.seconds;
        for place in 0..grid.len() {
            if ball(grid.cell(place).map(|at| at as f32)) < 2.0 {
                solids.velocity[0][place] = (-speed * s) as f32;
                solids.velocity[1][place] = (speed * c) as f32;
            }
        }
        let open = solids.open(&grid);
        let fill = volume.fill(&open);
        let domain = flow.step(&fill, &solids, &conditions);
        volume.advect(&domain, &open, &flow.velocity, conditions.seconds, CELL_M);
        if step % 100 == 0 {
            assert_eq!(volume.counts(), before, "step {step}");
            let fill = volume.fill(&open);
            let most = grid.places().map(|p| fill[p]).fold(0.0f32, f32::max);
            println!("{step}: fullest {most:.3} fastest {:.3e}", flow.fastest());
            fullest = fullest.max(most);
        }
    }
    assert_eq!(volume.counts(), before);
    println!("fullest {fullest}");
    let _ = worst([0.0].into_iter());
}
