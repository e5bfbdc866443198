//! Transport of paint on the device: none is lost, and its places agree with the processor's.

use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use maulstick_stokes_paint::device::{GpuFlow, Paints, Tuning};

use super::device;

const CAPACITY: u32 = 167_772;
const EFFORT: Effort = Effort {
    steps: 16,
    projections: 5,
};

const CONDITIONS: Conditions = Conditions {
    cell_m: 2.5e-4,
    seconds: 0.005,
    paint: Paint::newtonian(1e-2),
    pull: [0.0, 0.0, -9.81],
};

fn rod(step: usize) -> Rod {
    let x = 5.0 + 0.2 * step as f32;
    Rod {
        ends: [[x, 6.0, 2.0], [x, 6.0, 10.0]],
        radius: 1.5,
        velocity: [[0.01, 0.0, 0.0]; 2],
    }
}

/// Gain of quanta over `steps` steps, and the mean difference of the fill from the processor's in cells with paint.
fn carried(steps: usize, fault: Option<(&'static str, f64)>) -> (Vec<i64>, f64) {
    let grid = Grid::walled([16, 12, 8]);
    let mut cpu = Stokes::new(&grid, CAPACITY, 2);
    cpu.flow.effort = EFFORT;
    for place in grid.block([0; 3], [16, 12, 4]) {
        cpu.volume.paints[usize::from(grid.cell(place)[0] > 7)][place] = CAPACITY;
    }
    let tuning = Tuning {
        paints: Paints {
            count: 2,
            capacity: CAPACITY,
            parts: 1,
        },
        fault,
        ..Tuning::default()
    };
    let mut flow = GpuFlow::tuned(device(), &grid, EFFORT, &tuning).expect("made");
    flow.write_paints(&cpu.volume.paints).expect("written");
    let before = cpu.volume.counts();
    for step in 0..steps {
        let mut solids = Solids::walls(&grid);
        voxelise(&grid, &mut solids, &[rod(step)]);
        flow.step(&grid.field(), &solids, &CONDITIONS)
            .expect("a step");
        cpu.step(&[rod(step)], &CONDITIONS);
    }
    let paints = flow.read_paints().expect("read");
    let sum = |paint: &Vec<u32>| {
        grid.places()
            .map(|place| i64::from(paint[place]))
            .sum::<i64>()
    };
    let missing = paints
        .iter()
        .zip(&before)
        .map(|(paint, before)| sum(paint) - *before as i64);
    let (mut off, mut all) = (0.0, 0.0);
    for place in grid.places() {
        for (one, other) in paints.iter().zip(&cpu.volume.paints) {
            off += (f64::from(one[place]) - f64::from(other[place])).abs();
            all += f64::from(other[place]);
        }
    }
    (missing.collect(), off / all)
}

/// Tolerance as a share of all paint, for paint in other cells. Where a cell gives more than half or fills up, rounding
/// decides, and its effects spread, so the steps are few.
const TOLERANCE: f64 = 1e-4;

#[test]
fn paint_is_carried_as_the_processor_does() {
    let (missing, off) = carried(4, None);
    println!("missing {missing:?}, off {off:.1e}");
    assert_eq!(missing, [0, 0]);
    assert!(off < TOLERANCE, "{off:e}");
    let (missing, _) = carried(1, Some(("fault_lost", 1.0)));
    assert!(missing.iter().any(|missing| *missing < 0), "{missing:?}");
    let (_, off) = carried(4, Some(("fault_slope", 1.01)));
    assert!(off > TOLERANCE, "walls that are nearer pass: {off:e}");
}

/// A fast rod that goes to and fro through a pool of three paints, in steps of two parts.
#[test]
fn no_quantum_is_missing_after_many_steps() {
    let grid = Grid::walled([8, 8, 6]);
    let effort = Effort {
        steps: 3,
        projections: 2,
    };
    let tuning = Tuning {
        paints: Paints {
            count: 3,
            capacity: CAPACITY,
            parts: 2,
        },
        ..Tuning::default()
    };
    let mut flow = GpuFlow::tuned(device(), &grid, effort, &tuning).expect("made");
    let mut paints = vec![vec![0; grid.len()]; 3];
    for place in grid.block([0; 3], [8, 8, 3]) {
        let [x, y, _] = grid.cell(place);
        paints[((x + y) % 3) as usize][place] = CAPACITY;
    }
    flow.write_paints(&paints).expect("written");
    let sums = |paints: &[Vec<u32>]| -> Vec<u64> {
        let sum = |paint: &Vec<u32>| grid.places().map(|place| u64::from(paint[place])).sum();
        paints.iter().map(sum).collect()
    };
    let before = sums(&paints);
    for step in 0..80u8 {
        let there = step % 40;
        let (x, speed) = if there < 20 {
            (2.0 + 0.2 * f32::from(there), 0.01)
        } else {
            (10.0 - 0.2 * f32::from(there), -0.01)
        };
        let mut solids = Solids::walls(&grid);
        let rod = Rod {
            ends: [[x, 4.0, 1.0], [x, 4.0, 8.0]],
            radius: 1.2,
            velocity: [[speed, 0.0, 0.0]; 2],
        };
        voxelise(&grid, &mut solids, &[rod]);
        flow.step(&grid.field(), &solids, &CONDITIONS)
            .expect("a step");
    }
    let after = flow.read_paints().expect("read");
    assert_eq!(sums(&after), before);
    assert!(after != paints, "it moves");
}
