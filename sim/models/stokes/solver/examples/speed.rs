//! Time of the solver on this thread's processor, one row a line: `cargo run --release -p maulstick-stokes --example speed`.
//! With `step` windows alone, with a number that one alone.

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

/// A window, how deep it is filled, and the brush that is drawn through it.
struct Case {
    cells: [usize; 3],
    /// Rows of columns that are filled, and layers.
    filled: [usize; 2],
    /// Upright rods, their radius, and where they end.
    rods: usize,
    radius: f32,
    lowest: f32,
}

const CASES: [Case; 4] = [
    Case {
        cells: [32, 32, 16],
        filled: [32, 8],
        rods: 1,
        radius: 3.0,
        lowest: 4.0,
    },
    Case {
        cells: [40, 40, 4],
        filled: [40, 2],
        rods: 8,
        radius: 1.2,
        lowest: 0.5,
    },
    Case {
        cells: [40, 40, 4],
        filled: [40, 1],
        rods: 8,
        radius: 1.2,
        lowest: 0.5,
    },
    Case {
        cells: [64, 64, 8],
        filled: [12, 2],
        rods: 8,
        radius: 1.2,
        lowest: 0.5,
    },
];
/// Steps that are measured.
const STEPS: u32 = 40;
/// Way of a step, cells.
const WAY: f32 = 0.48;

const CONDITIONS: Conditions = Conditions {
    cell_m: 2.5e-4,
    seconds: 0.01,
    paint: Paint::newtonian(1e-2),
    pull: [0.0, 0.0, -9.81],
};

impl Case {
    fn stokes(&self) -> Stokes {
        let [width, height, _] = self.cells.map(|cells| cells as isize);
        let [rows, layers] = self.filled.map(|cells| cells as isize);
        let grid = Grid::walled(self.cells);
        let mut stokes = Stokes::new(&grid, 167_772, 4);
        let low = (height - rows) / 2;
        for place in grid.block([0, low, 0], [width, low + rows, layers]) {
            let column = grid.cell(place)[0];
            stokes.volume.paints[(4 * column / width) as usize][place] = 167_772;
        }
        stokes
    }

    /// The brush at a place, in motion.
    fn brush(&self, x: f32, way: f32) -> Vec<Rod> {
        let middle = 0.5 * self.cells[1] as f32;
        let rod = |number: usize| {
            let y = middle + (number as f32 - 0.5 * (self.rods - 1) as f32);
            let speed = f64::from(way) * CONDITIONS.cell_m / CONDITIONS.seconds;
            Rod {
                ends: [[x, y, self.lowest], [x, y, self.cells[2] as f32]],
                radius: self.radius,
                velocity: [[speed as f32, 0.0, 0.0]; 2],
            }
        };
        (0..self.rods).map(rod).collect()
    }

    fn measure(&self) {
        let mut stokes = self.stokes();
        let mut x = 6.0;
        let (mut left, mut wet) = (0.0, 0.0);
        let step = mean(STEPS, || {
            let domain = stokes.step(&self.brush(x, WAY), &CONDITIONS);
            x += WAY;
            let norms = &stokes.flow.norms;
            left = norms[norms.len() - 1] / norms[0];
            wet = domain.wet.iter().sum::<f32>();
        });
        let [width, height, depth] = self.cells;
        let [rows, layers] = self.filled;
        let name = format!("{width}x{height}x{depth}, {rows} rows of {layers} layers");
        let rate = 1.0 / step;
        println!(
            "hz.{name}: {rate:.1} ({:.2} ms; residual {left:.1e}, {wet} cells)",
            1e3 * step
        );
        let two = with_threads(2, || {
            let begun = Instant::now();
            for _ in 0..STEPS {
                stokes.step(&self.brush(x, -WAY), &CONDITIONS);
                x -= WAY;
            }
            begun.elapsed().as_secs_f64() / f64::from(STEPS)
        });
        println!("hz.{name}, two threads, by the clock: {:.1}", 1.0 / two);
    }
}

fn main() {
    let number = std::env::args().find_map(|word| word.parse::<usize>().ok());
    let wanted = CASES
        .iter()
        .enumerate()
        .filter(|(each, _)| number.is_none_or(|number| number == *each));
    wanted.for_each(|(_, case)| case.measure());
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
