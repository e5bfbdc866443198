//! Speed of dAb on the graphics device along the paths of `maulstick bench paint --model dab` (Baxter 2004, table 4.2),
//! its memory traffic compared with a copy of the same bytes, and the difference of its counts from the processor's:
//! `cargo run --release -p maulstick-bench --example dab_speed [ROUNDS [PART OF A NAME]]`.

use std::time::Instant;

use maulstick_brush::{BrushFile, HeadPose};
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_dab::volume::UNIT;
use maulstick_gpu::steps::model::GpuModel;
use maulstick_gpu::{Choice, Device, GpuError};
use maulstick_impasto::device::measure::Measured;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::PaintModel;
use maulstick_model::trial::{PATHS, Trial};
use maulstick_num::fork_join::with_threads;

/// Cells either way.
const SIDE: u32 = 1024;
/// Copies of the planes of as many cells that are timed together.
const COPIES: usize = 32;
/// Paints on the planes that are copied.
const COPIED: usize = 2;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Bandwidth of a copy, bytes/s, counting reads and writes once each.
fn copied_per_s(gpu: &Device, rounds: usize) -> Result<f64, GpuError> {
    let side = SIDE as usize;
    let mut measured = Measured::new(gpu.clone(), side, COPIED)?;
    let bytes = (2 * 4 * side * side * (1 + COPIED) * COPIES) as f64;
    let mut rates = Vec::new();
    for _ in 0..=rounds {
        rates.push(bytes / measured.copy(COPIES)?.as_secs_f64());
    }
    Ok(median(rates.split_off(1)))
}

/// A stroke on the device.
struct Stroke<'a> {
    trial: &'a mut Trial,
    model: GpuModel,
    poses: Vec<HeadPose>,
}

impl Stroke<'_> {
    /// All steps, with upload and read-back: cells touched, and seconds.
    fn whole(&mut self) -> (u64, f64) {
        self.trial.wet();
        let begun = Instant::now();
        let report = self.trial.stroke(&mut self.model, &self.poses);
        (report.footprint_cells, begun.elapsed().as_secs_f64())
    }

    /// Number of cells touched by the first step, which includes the upload.
    fn first_cells(&mut self) -> u64 {
        self.trial.wet();
        let report = self.trial.stroke(&mut self.model, &self.poses[..2]);
        report.footprint_cells
    }

    /// Seconds of the steps after the first one until the device has done them, read-back not counted.
    fn steps(&mut self) -> Result<f64, GpuError> {
        let Self {
            trial,
            model,
            poses,
        } = self;
        trial.wet();
        let mut load = trial.full();
        trial.steps(model, &mut load, &poses[..2]);
        model.wait(&trial.window, &load)?;
        let begun = Instant::now();
        trial.steps(model, &mut load, &poses[1..]);
        model.wait(&trial.window, &load)?;
        let took = begun.elapsed().as_secs_f64();
        model.settle(&mut trial.window, &mut load);
        Ok(took)
    }
}

/// Counts on the canvas and on the brush after a stroke, and in all.
fn counts(trial: &Trial, load: &BrushLoad) -> (Vec<f32>, u64) {
    let lies = [0, 1].map(|slot| trial.window.plane(slot).unwrap_or_default());
    let lies = lies.concat();
    let sum = lies.iter().map(|count| *count as u64).sum::<u64>();
    (lies, sum + load.total())
}

/// Difference from the same stroke on the processor.
fn compare(stroke: &mut Stroke<'_>, stroker: Stroker) {
    let poses = stroke.poses.clone();
    let mut painted = |model: &mut dyn PaintModel| {
        let trial = &mut *stroke.trial;
        trial.wet();
        let mut load = trial.full();
        let before = counts(trial, &load).1;
        let begun = Instant::now();
        let mut report = trial.steps(model, &mut load, &poses);
        report.add(&model.settle(&mut trial.window, &mut load));
        let took = begun.elapsed().as_secs_f64();
        let (lies, after) = counts(trial, &load);
        (
            lies,
            report.footprint_cells,
            after as i64 - before as i64,
            took,
        )
    };
    let (on_cpu, cells, _, took) = painted(&mut Dab::stroking(stroker));
    let (on_gpu, touched, created, _) = painted(&mut stroke.model);
    stroke.trial.wet();
    let (bare, _) = counts(stroke.trial, &stroke.trial.full());
    let changed = on_cpu.iter().zip(&bare).filter(|(is, was)| is != was);
    let apart = on_cpu.iter().zip(&on_gpu).map(|(a, b)| (a - b).abs());
    let most = apart.clone().fold(0.0, f32::max);
    let off = apart.clone().filter(|apart| *apart > 0.0).count();
    let units = apart.filter(|apart| *apart >= UNIT).count();
    let sum: f64 = on_gpu.iter().map(|count| f64::from(*count)).sum();
    let other: f64 = on_cpu.iter().map(|count| f64::from(*count)).sum();
    println!(
        "  beside the processor: of {cells} cells {} more touched; of {} counts changed {off} differ, {units} by a unit of \
         {UNIT} quanta or more, {most} at most; sums by {:.1e}; created {created} quanta; processor {:.1} million cells/s",
        touched as i64 - cells as i64,
        changed.count(),
        (sum / other - 1.0).abs(),
        1e-6 * cells as f64 / took,
    );
}

fn run(rounds: usize, only: &str) -> Result<(), GpuError> {
    let gpu = Device::open(Choice::Forced)?;
    println!("adapter: {}", gpu.name());
    let per_s = copied_per_s(&gpu, rounds)?;
    println!("copy: {:.1} GB/s, read and written", 1e-9 * per_s);
    let mut file = BrushFile::library("round").expect("a brush of the library");
    file.strips.count = 96;
    let file = file.scaled_to(10.0).expect("a size of it");
    let mut trial = Trial::new(file, SIDE, 2.5e-4).expect("a surface");
    for (name, stroker) in [
        ("faster", Stroker::Faster),
        ("better", Stroker::Better),
        ("spline", Stroker::Spline),
    ] {
        for path in PATHS {
            let name = format!("{name}.{}", path.name);
            if !name.contains(only) {
                continue;
            }
            let poses = trial.heads(path);
            let mut stroke = Stroke {
                trial: &mut trial,
                model: maulstick_dab::device::stroking(gpu.clone(), stroker)?,
                poses,
            };
            let (cells, _) = stroke.whole();
            let [steps, dispatches, bytes] = stroke.model.traffic().counts().map(|n| n as f64);
            let later = cells - stroke.first_cells();
            let (mut alone, mut whole) = (Vec::new(), Vec::new());
            for _ in 0..rounds {
                alone.push(later as f64 / stroke.steps()?);
                whole.push(cells as f64 / stroke.whole().1);
            }
            let (alone, whole) = (median(alone), median(whole));
            let step_us = 1e6 * cells as f64 / (steps * alone);
            println!(
                "touched_per_s.{name}: {:.1} million, with upload and read-back {:.1} million; a step: {:.0} cells, {:.1} \
                 dispatches, {:.3} MB at most, {step_us:.0} µs, a copy of as much {:.1} µs",
                1e-6 * alone,
                1e-6 * whole,
                cells as f64 / steps,
                dispatches / steps,
                1e-6 * bytes / steps,
                1e6 * bytes / (steps * per_s),
            );
            compare(&mut stroke, stroker);
        }
    }
    Ok(())
}

fn main() -> Result<(), GpuError> {
    let mut arguments = std::env::args().skip(1);
    let rounds = arguments.next().and_then(|count| count.parse().ok());
    let only = arguments.next().unwrap_or_default();
    with_threads(2, || run(rounds.unwrap_or(9), &only))
}
