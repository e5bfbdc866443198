//! The solver compared with a plain one in f64: dissipation as a sum of squares, solved by elimination.

mod system;

use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use system::{Basin, Fault};

/// A basin with a surface of steps and slopes, a lid that moves along one wall, and paint in motion.
fn basin(seed: u64) -> Basin {
    let mut random = Pcg32::new(seed, 3);
    let mut number = || f64::from(random.next_u32()) / f64::from(u32::MAX);
    let cells = [6, 5, 6];
    let mut fill = vec![0.0; cells.iter().product()];
    for y in 0..cells[1] {
        for x in 0..cells[0] {
            let height = 2.2 + 2.6 * number();
            for z in 0..cells[2] {
                let filled: f64 = height - z as f64;
                fill[x + cells[0] * (y + cells[1] * z)] = filled.clamp(0.0, 1.0);
            }
        }
    }
    let faces = 3 * (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
    Basin {
        cells,
        fill,
        lid: [0.0, 0.3, -0.2],
        before: (0..faces).map(|_| number() - 0.5).collect(),
        tau: 2.5,
        pull: [0.1, 0.0, -0.4],
    }
}

/// Velocities of the paint by both solvers, face by face, and the pressures.
fn both(basin: &Basin, fault: Option<Fault>) -> [Vec<f64>; 2] {
    let slow = basin.solve(fault);
    let grid = Grid::walled(basin.cells);
    let mut fill = grid.field();
    for (place, filled) in grid.places().zip(&basin.fill) {
        fill[place] = *filled as f32;
    }
    let mut solids = Solids::walls(&grid);
    for axis in 0..3 {
        for place in 0..grid.len() {
            if grid.cell(place)[0] < 0 {
                solids.velocity[axis][place] = basin.lid[axis] as f32;
            }
        }
    }
    let mut flow = Flow::new(&grid);
    flow.relief = 0.0;
    flow.effort = Effort {
        steps: 60,
        projections: 0,
    };
    for (axis, u) in flow.velocity.iter_mut().enumerate() {
        for place in grid.faces(axis) {
            u[place] =
                basin.before[basin.face(axis, grid.cell(place).map(|at| at as usize))] as f32;
        }
    }
    let conditions = Conditions {
        cell_m: 1.0,
        seconds: 1.0,
        paint: Paint::newtonian(basin.tau),
        pull: basin.pull,
    };
    flow.step(&fill, &solids, &conditions);
    let velocity = |(axis, cell): &(usize, [usize; 3])| {
        f64::from(flow.velocity[*axis][grid.at(cell.map(|at| at as isize))])
    };
    let pressure =
        |cell: &[usize; 3]| f64::from(flow.pressure[grid.at(cell.map(|at| at as isize))]);
    let fast = slow
        .faces
        .iter()
        .map(velocity)
        .chain(slow.wet.iter().map(pressure));
    [fast.collect(), slow.values]
}

/// Largest difference relative to the largest value.
fn off([fast, slow]: [Vec<f64>; 2]) -> f64 {
    let most = slow
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let pairs = fast.iter().zip(&slow);
    pairs
        .map(|(fast, slow)| (fast - slow).abs())
        .fold(0.0, f64::max)
        / most
}

#[test]
fn velocities_and_pressures_are_those_of_the_oracle() {
    for seed in [1, 2, 3] {
        let basin = basin(seed);
        let right = off(both(&basin, None));
        println!("basin {seed}: {right:.1e}");
        assert!(right < 1e-4, "{right}");
        for fault in [
            Fault::WithoutCrossTerm,
            Fault::FullWalls,
            Fault::SurfaceSticks,
            Fault::HalfNormal,
        ] {
            let wrong = off(both(&basin, Some(fault)));
            assert!(wrong > 1e-2, "{fault:?} passes: {wrong}");
        }
    }
}
