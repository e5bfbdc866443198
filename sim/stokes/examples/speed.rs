//! Time of the solver on this thread's processor, one row a line: `cargo run --release -p maulstick-stokes --example speed`.

#[path = "../tests/common/pools.rs"]
#[allow(unreachable_pub, reason = "a pool is what tests share")]
mod pools;

use std::fs;
use std::time::Instant;

use maulstick_num::fork_join::with_threads;
use maulstick_stokes::body::Rod;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::Grid;
use maulstick_stokes::multigrid::Multigrid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes::step::Stokes;
use pools::{Pool, pool};

/// Seconds that this thread has run.
fn cpu_s() -> f64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let first = text
        .split(' ')
        .next()
        .and_then(|word| word.parse::<f64>().ok());
    first.unwrap_or(f64::NAN) * 1e-9
}

/// Mean of so many times: the kernel counts by ticks that are longer than some of them.
fn mean(count: u32, mut each: impl FnMut()) -> f64 {
    let begun = cpu_s();
    (0..count).for_each(|_| each());
    (cpu_s() - begun) / f64::from(count)
}

fn main() {
    let grid = Grid::walled([32, 32, 16]);
    let mut stokes = Stokes::new(&grid, 167_772, 4);
    for place in grid.block([0; 3], [32, 32, 8]) {
        stokes.volume.paints[(grid.cell(place)[0] / 8) as usize][place] = 167_772;
    }
    let conditions = Conditions {
        cell_m: 2.5e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    };
    let mut x = 6.0;
    let (mut left, mut wet) = (0.0, 0.0);
    let step = mean(40, || {
        let rod = Rod {
            ends: [[x, 16.0, 4.0], [x, 16.0, 16.0]],
            radius: 3.0,
            velocity: [[0.012, 0.0, 0.0]; 2],
        };
        let domain = stokes.step(&[rod], &conditions);
        x += 0.48;
        let norms = &stokes.flow.norms;
        left = norms[norms.len() - 1] / norms[0];
        wet = domain.wet.iter().sum::<f32>();
    });
    println!(
        "hz.32x32x16: {:.1} ({:.2} ms; residual {left:.1e}, {wet} cells)",
        1.0 / step,
        1e3 * step
    );
    let begun = Instant::now();
    with_threads(2, || {
        for _ in 0..40 {
            let rod = Rod {
                ends: [[x, 16.0, 4.0], [x, 16.0, 16.0]],
                radius: 3.0,
                velocity: [[-0.012, 0.0, 0.0]; 2],
            };
            stokes.step(&[rod], &conditions);
            x -= 0.48;
        }
    });
    let two = begun.elapsed().as_secs_f64() / 40.0;
    println!(
        "hz.32x32x16 with two threads, by the clock: {:.1}",
        1.0 / two
    );
    if std::env::args().any(|word| word == "step") {
        return;
    }
    for kind in [Pool::Box, Pool::Rough] {
        for cells in [32, 64, 128] {
            let (grid, stencil, b) = pool(cells, kind);
            let mut multigrid = Multigrid::new(&grid, stencil, None);
            let norms = multigrid.solve(&b, &mut grid.field(), 20);
            let needed = norms.iter().position(|norm| *norm < 1e-6 * norms[0]);
            println!("mgpcg.iterations.{cells} ({kind:?}): {needed:?} to 1e-6");
        }
        let (grid, stencil, b) = pool(64, kind);
        let b: Vec<f64> = b.into_iter().map(f64::from).collect();
        let mut left = 0.0;
        let setup = mean(10, || drop(Multigrid::new(&grid, stencil.clone(), None)));
        let mut multigrid = Multigrid::new(&grid, stencil, None);
        let time = mean(10, || {
            left = multigrid.refine(&b, &mut vec![0.0; grid.len()], 1e-8, 20);
        });
        println!(
            "poisson64.time ({kind:?}): {:.1} ms to {left:.1e}, setup {:.1} ms",
            1e3 * time,
            1e3 * setup
        );
    }
}
