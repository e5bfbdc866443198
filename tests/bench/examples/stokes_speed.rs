//! The flow of Stokes Paint on the device: how fast it is, and how far from the processor's.
//! `cargo run --release -p maulstick-bench --example stokes_speed -- [SIZE...]`, sizes such as 128x128x64.

use std::error::Error;
use std::time::{Duration, Instant};

use maulstick_gpu::{Choice, Device};
use maulstick_stokes::body::{Rod, voxelise};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::device::{GpuFlow, Paints, Tuning};

/// Default sizes: the benchmark's, and the plan's for a discrete processor.
const SIZES: [[usize; 3]; 2] = [[32, 32, 16], [128, 128, 64]];
/// Length of a round, rounds, and the time after which there is no other round.
const ROUND: Duration = Duration::from_millis(500);
const ROUNDS: usize = 5;
const ENOUGH: Duration = Duration::from_secs(10);
/// Cells of the largest window that an emulated device is compared on.
const COMPARED: usize = 300_000;

fn conditions() -> Conditions {
    Conditions {
        cell_m: 2.5e-4,
        seconds: 0.01,
        paint: Paint::newtonian(1e-2),
        pull: [0.0, 0.0, -9.81],
    }
}

/// Paint with waves up to half of a window's height, and a rod that is drawn through it.
fn scene(grid: &Grid) -> (Vec<f32>, Solids) {
    let [width, height, depth] = grid.cells.map(|cells| cells as f32);
    let fill = |place: usize| {
        let [x, y, z] = grid.cell(place).map(|at| at as f64 + 0.5);
        let waves = 0.6 * maulstick_num::sin(0.7 * x) * maulstick_num::cos(0.5 * y);
        (0.5 * f64::from(depth) + waves + 0.5 - z).clamp(0.0, 1.0) as f32
    };
    let fill = (0..grid.len()).map(fill).collect();
    let mut solids = Solids::walls(grid);
    let rod = Rod {
        ends: [
            [0.3 * width, 0.5 * height, 0.25 * depth],
            [0.32 * width, 0.52 * height, depth],
        ],
        radius: 0.08 * width,
        velocity: [[0.012, 0.0, 0.0]; 2],
    };
    voxelise(grid, &mut solids, &[rod]);
    (fill, solids)
}

/// Largest difference of a velocity of paint by the fastest one, after each of two steps, and the processor's time of a step.
fn compare(gpu: &Device, grid: &Grid) -> Result<([f64; 2], Duration), Box<dyn Error>> {
    let (fill, solids) = scene(grid);
    let mut cpu = Flow::new(grid);
    let mut device = GpuFlow::new(gpu.clone(), grid, Effort::default())?;
    let mut found = [0.0; 2];
    let mut time = Duration::ZERO;
    for found in &mut found {
        let begun = Instant::now();
        let domain = cpu.step(&fill, &solids, &conditions());
        time = begun.elapsed();
        device.step(&fill, &solids, &conditions())?;
        let state = device.read()?;
        for axis in 0..3 {
            // The processor leaves out layers of air.
            let free = &domain.free[axis];
            for face in (0..free.len()).filter(|face| free[*face] > 0.0) {
                let off = f64::from((cpu.velocity[axis][face] - state.velocity[axis][face]).abs());
                // A number that is none is as far off as can be.
                *found = if off <= *found { *found } else { off };
            }
        }
        *found /= cpu.fastest();
    }
    Ok((found, time))
}

/// Times of a step by rounds, in ms.
struct Times(Vec<f64>);

impl Times {
    fn median(&self) -> f64 {
        self.0.get(self.0.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// The median, and the shortest and the longest.
    fn text(&mut self) -> String {
        self.0.sort_by(f64::total_cmp);
        let ends = [self.0.first(), self.0.last()].map(|time| time.copied().unwrap_or(f64::NAN));
        format!("{:.3} ms ({:.3} to {:.3})", self.median(), ends[0], ends[1])
    }
}

/// Prints how fast the steps are.
fn time(gpu: &Device, grid: &Grid, tuning: Tuning) -> Result<(), Box<dyn Error>> {
    let effort = Effort::default();
    let (fill, solids) = scene(grid);
    let mut flow = GpuFlow::tuned(gpu.clone(), grid, effort, &tuning)?;
    let [dispatches, moved] = GpuFlow::traffic(grid, effort, &tuning)?;
    let Tuning { rest, paints, .. } = tuning;
    let number = |paint: usize, place: usize| {
        (paint * grid.cells[0] / paints.count) as isize <= grid.cell(place)[0]
    };
    let mut counts = vec![vec![0; grid.len()]; paints.count];
    for place in grid.places() {
        if let Some(paint) = (0..paints.count).rev().find(|paint| number(*paint, place)) {
            counts[paint][place] = (fill[place] * paints.capacity as f32) as u32;
        }
    }
    flow.write_paints(&counts)?;
    flow.step(&fill, &solids, &conditions())?;
    let first = flow.time_steps(&conditions(), 1)?;
    let count = (ROUND.as_secs_f64() / first.as_secs_f64()).clamp(1.0, 256.0) as usize;
    let begun = Instant::now();
    let [mut steps, mut uploads, mut copies] = [(); 3].map(|()| Times(Vec::new()));
    for _ in 0..ROUNDS {
        let each = |time: Duration| 1e3 * time.as_secs_f64() / count as f64;
        steps.0.push(each(flow.time_steps(&conditions(), count)?));
        copies.0.push(each(flow.time_copies(count)?));
        let upload = Instant::now();
        for _ in 0..count {
            flow.step(&fill, &solids, &conditions())?;
            flow.wait()?;
        }
        uploads.0.push(each(upload.elapsed()));
        if begun.elapsed() > ENOUGH {
            break;
        }
    }
    let [step, upload, copy] = [&mut steps, &mut uploads, &mut copies].map(Times::text);
    let [width, height, depth] = grid.cells;
    println!(
        "hz.gpu.{width}x{height}x{depth}: {:.1}, {step} a step of {dispatches} dispatches ({} paints carried, levels of {rest} cells by one workgroup)",
        1e3 / steps.median(),
        paints.count
    );
    println!("  with fill and solids uploaded and waited for: {upload}");
    let gigabytes = |times: &Times| 1e-6 * moved as f64 / times.median();
    println!(
        "  a copy of the same bytes: {copy}; {:.1} and {:.1} GB/s, a step takes {:.2} times as long",
        gigabytes(&copies),
        gigabytes(&steps),
        steps.median() / copies.median()
    );
    Ok(())
}

fn measure(gpu: &Device, grid: &Grid) -> Result<(), Box<dyn Error>> {
    let [width, height, depth] = grid.cells;
    let effort = Effort::default();
    let bytes = GpuFlow::window_bytes(grid, effort)?;
    let [dispatches, moved] = GpuFlow::traffic(grid, effort, &Tuning::default())?;
    println!(
        "{width}x{height}x{depth}: window of {:.1} MB, {dispatches} dispatches and {:.1} MB a step",
        bytes as f64 * 1e-6,
        moved as f64 * 1e-6
    );
    if width * height * depth <= COMPARED || !gpu.is_cpu() {
        let (found, time) = compare(gpu, grid)?;
        println!(
            "largest difference from the processor's velocities, by the fastest: {:.1e}, {:.1e} (a step of the processor: {:.1} ms)",
            found[0],
            found[1],
            1e3 * time.as_secs_f64()
        );
    }
    let rests: &[u32] = if gpu.is_cpu() {
        &[2048]
    } else {
        &[2048, 512, 64, 16_384]
    };
    for rest in rests {
        let tuning = Tuning {
            rest: *rest,
            ..Tuning::default()
        };
        time(gpu, grid, tuning)?;
    }
    let paints = Paints {
        count: 4,
        capacity: 167_772,
        parts: 1,
    };
    let tuning = Tuning {
        paints,
        ..Tuning::default()
    };
    time(gpu, grid, tuning)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut sizes = Vec::new();
    for word in std::env::args().skip(1) {
        let numbers: Result<Vec<usize>, _> = word.split('x').map(str::parse).collect();
        let size = numbers?;
        sizes.push(
            <[usize; 3]>::try_from(size)
                .map_err(|_| format!("{word}: not a size such as 32x32x16"))?,
        );
    }
    if sizes.is_empty() {
        sizes.extend(SIZES);
    }
    let gpu = Device::open(Choice::Forced)?;
    println!(
        "adapter: {}{}",
        gpu.name(),
        if gpu.is_cpu() { " (emulated)" } else { "" }
    );
    for size in sizes {
        if let Err(error) = measure(&gpu, &Grid::walled(size)) {
            println!("{size:?}: {error}");
        }
    }
    Ok(())
}
