//! Speed of the paint model `stokes` with its flow on the graphics device, beside the processor:
//! `cargo run --release -p maulstick-bench --example stokes_paint_speed [WIDTH_MM...]`.

use std::error::Error;
use std::time::Instant;

use maulstick_brush::{BrushFile, HeadPose};
use maulstick_gpu::{Choice, Device};
use maulstick_model::interface::PaintModel;
use maulstick_model::trial::Trial;
use maulstick_num::fork_join::with_threads;
use maulstick_stokes_paint::StokesPaint;

/// Default widths of the brush, mm.
const WIDTHS_MM: [f64; 3] = [8.0, 24.0, 48.0];
/// Cells either way, and their side, m.
const SIDE: u32 = 512;
const CELL_M: f64 = 2.5e-4;
/// Steps of a cell each that are not measured, and those that are.
const FIRST: usize = 4;
const STEPS: usize = 16;

/// Steps a second of a model, and quanta that are on surface and brush after them.
fn steps(file: &BrushFile, model: &mut dyn PaintModel) -> Option<(f64, u64)> {
    let mut trial = Trial::new(file.clone(), SIDE, CELL_M)?;
    trial.wet();
    let mut load = trial.full();
    let middle = 0.5 * f64::from(SIDE);
    let pose = |step: usize| trial.pose([middle - 20.0 + step as f64, middle], 0.0);
    let poses: Vec<HeadPose> = (0..=FIRST + STEPS).map(pose).collect();
    trial.steps(model, &mut load, &poses[..=FIRST]);
    let begun = Instant::now();
    trial.steps(model, &mut load, &poses[FIRST..]);
    let took = begun.elapsed().as_secs_f64();
    let lies = trial.window.planes().flat_map(|(_, plane)| plane);
    let lies: u64 = lies.map(|count| *count as u64).sum();
    Some((STEPS as f64 / took, lies + load.total()))
}

fn main() -> Result<(), Box<dyn Error>> {
    let widths: Result<Vec<f64>, _> = std::env::args().skip(1).map(|word| word.parse()).collect();
    let mut widths = widths?;
    if widths.is_empty() {
        widths.extend(WIDTHS_MM);
    }
    let gpu = Device::open(Choice::Forced)?;
    let kind = if gpu.is_cpu() { " (emulated)" } else { "" };
    println!("adapter: {}{kind}", gpu.name());
    let make = maulstick_stokes_paint::ENTRY
        .make_on
        .ok_or("no device computes it")?;
    for width in widths {
        let file = BrushFile::library("round")?.scaled_to(width)?;
        let rate = |threads: usize, model: &mut dyn PaintModel| {
            with_threads(threads, || steps(&file, model)).ok_or("too large a surface")
        };
        let mut device = make(gpu.clone(), Choice::Forced)?.model;
        let (alone, quanta) = rate(1, &mut StokesPaint::default())?;
        let (shared, _) = rate(2, &mut StokesPaint::default())?;
        let (on_device, same) = rate(1, device.as_mut())?;
        println!(
            "{width} mm: {on_device:.1} steps/s with {}, {alone:.1} on one core, {shared:.1} on two; {} quanta more or less",
            device.backend(),
            quanta.abs_diff(same)
        );
    }
    Ok(())
}
