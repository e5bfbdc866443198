//! The solver of Stokes Paint alone: steps of windows, and multigrid on the pressure's equation.

#[path = "../../../../sim/models/stokes/solver/tests/common/pools.rs"]
#[allow(unreachable_pub, reason = "a pool is what tests share")]
mod pools;

use std::time::Instant;

use maulstick_num::fork_join::with_threads;
use maulstick_stokes::body::Rod;
use maulstick_stokes::flow::{Conditions, Effort};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::multigrid::Multigrid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use pools::{Pool, pool};

use crate::report::Report;

/// A window: cells, full layers, and number and radius of the rods drawn through it.
type Window = ([usize; 3], usize, (usize, f32));

/// A deep pool, as the dissertation's machine had it, and thin paint on a wide window.
const WINDOWS: [Window; 3] = [
    ([32, 32, 16], 8, (1, 3.0)),
    ([40, 40, 4], 2, (8, 1.2)),
    ([40, 40, 4], 1, (8, 1.2)),
];
/// Quanta of a cell.
const CAPACITY: u32 = 167_772;
/// Steps of a round, and rounds, of which the first warms up.
const STEPS: u32 = 40;
const ROUNDS: usize = 6;
/// Path of a step, cells.
const WAY: f32 = 0.48;
const CONDITIONS: Conditions = Conditions {
    cell_m: 2.5e-4,
    seconds: 0.01,
    paint: Paint::newtonian(1e-2),
    pull: [0.0, 0.0, -9.81],
};

/// Measures and reports, on one core and on two.
pub(crate) fn run(report: &mut Report) {
    for (cells, layers, brush) in WINDOWS {
        let name = cells.map(|cells| cells.to_string()).join("x");
        let name = if layers < 2 {
            format!("hz.{name}.film")
        } else {
            format!("hz.{name}")
        };
        let alone = rates(cells, layers, brush);
        let shared = with_threads(2, || rates(cells, layers, brush));
        let pairs: Vec<(f64, f64)> = shared.into_iter().zip(alone).collect();
        report.paired(&name, "steps/s", "on one core", &pairs);
    }
    for cells in [32, 64, 128] {
        let (grid, stencil, b) = pool(cells, Pool::Rough);
        let mut multigrid = Multigrid::new(&grid, stencil, None);
        let norms = multigrid.solve(&b, &mut grid.field(), 20);
        let needed = norms.iter().position(|norm| *norm < 1e-6 * norms[0]);
        let needed = needed.map_or(f64::NAN, |needed| needed as f64);
        report.row(&format!("mgpcg.iterations.{cells}"), needed, "");
    }
    let (grid, stencil, b) = pool(64, Pool::Box);
    let mut multigrid = Multigrid::new(&grid, stencil, None);
    let b: Vec<f64> = b.into_iter().map(f64::from).collect();
    let times = (0..ROUNDS).map(|_| {
        let begun = Instant::now();
        multigrid.refine(&b, &mut vec![0.0; grid.len()], 1e-8, 20);
        1e3 * begun.elapsed().as_secs_f64()
    });
    let times: Vec<f64> = times.skip(1).collect();
    report.median("poisson64.time", "ms", times);
    plan(report, [128, 128, 64], Effort::default());
}

/// Numbers that the graphics processor would read and write in a step on a large window, and its dispatches, counted
/// from the loops of the solver: each field of a loop once.
fn plan(report: &mut Report, cells: [usize; 3], effort: Effort) {
    let places = cells.iter().product::<usize>() as f64;
    let halvings = cells.iter().max().map_or(0, |most| most.ilog2() - 2);
    let (steps, projections) = (effort.steps as f64, effort.projections as f64);
    // A cycle on a level: two steps at once, the residual, and two steps; then the transfers down and up.
    let (sweeps, transfers) = ([6.0, 8.0, 7.0, 7.0], [1.2, 3.3]);
    let levels: f64 = (0..halvings).map(|level| 0.125f64.powi(level as i32)).sum();
    let cycle = levels * (sweeps.iter().sum::<f64>() + transfers.iter().sum::<f64>());
    let dispatches = f64::from(halvings) * 6.0 + 16.0;
    // Momentum of three components, outflow; orthogonality to the directions before, and the residual.
    let apply = 3.0 * 13.0 + 8.0;
    let memory: f64 = (0..effort.steps)
        .map(|before| 4.0 * (2.0 * before as f64 + 9.0))
        .sum();
    let fields = (4.0 * steps + projections) * cycle
        + (steps + 1.0) * apply
        + memory
        + steps * (8.0 + 4.0)
        + projections * (6.0 + 9.0);
    let count =
        (4.0 * steps + projections) * dispatches + steps * (4.0 + 2.0 + 3.0) + projections * 5.0;
    let name = cells.map(|cells| cells.to_string()).join("x");
    report.row(
        &format!("plan.{name}.bytes"),
        4.0 * places * fields,
        "bytes",
    );
    report.row(&format!("plan.{name}.dispatches"), count, "");
}

/// Steps a second of each round: a brush goes to and fro.
fn rates(cells: [usize; 3], layers: usize, (rods, radius): (usize, f32)) -> Vec<f64> {
    let grid = Grid::walled(cells);
    let mut stokes = Stokes::new(&grid, CAPACITY, 4);
    let [width, height, depth] = cells;
    let filled = [width, height, layers].map(|cells| cells as isize);
    for place in grid.block([0; 3], filled) {
        let paint = 4 * grid.cell(place)[0] as usize / width;
        stokes.volume.paints[paint][place] = CAPACITY;
    }
    let mut x = 6.0;
    let rounds = (0..ROUNDS).map(|round| {
        let way = if round % 2 == 0 { WAY } else { -WAY };
        let speed = f64::from(way) * CONDITIONS.cell_m / CONDITIONS.seconds;
        let begun = Instant::now();
        for _ in 0..STEPS {
            let rod = |number: usize| {
                let y = 0.5 * (height - rods + 1) as f32 + number as f32;
                let lowest = 0.5 * layers as f32;
                Rod {
                    ends: [[x, y, lowest], [x, y, depth as f32]],
                    radius,
                    velocity: [[speed as f32, 0.0, 0.0]; 2],
                }
            };
            let brush: Vec<Rod> = (0..rods).map(rod).collect();
            stokes.step(&brush, &CONDITIONS);
            x += way;
        }
        f64::from(STEPS) / begun.elapsed().as_secs_f64()
    });
    rounds.skip(1).collect()
}
