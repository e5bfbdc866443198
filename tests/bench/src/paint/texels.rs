//! dAb's stroking algorithms alone (Baxter 2004, table 4.2): texels of blended footprints a second, and their touched
//! cells, along paths that the text leaves open: here two fast straight ones and a slow curved one.

use std::time::Instant;

use maulstick_brush::{BrushError, BrushFile, HeadPose};
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_gpu::Device;
use maulstick_model::interface::PaintModel;
use maulstick_model::trial::{PATHS, Trial};
use maulstick_num::fork_join::with_threads;
use maulstick_rig::UserError;

use crate::report::Report;

/// Cells either way, and their side, m.
const CELLS: (u32, f64) = (1024, 2.5e-4);
/// Width of the brush, mm, and its strips: a footprint about 60 cells wide.
const BRUSH: (f64, usize) = (10.0, 96);
/// Rounds, of which the first warms up.
const ROUNDS: usize = 8;

const STROKERS: [(&str, Stroker); 3] = [
    ("faster", Stroker::Faster),
    ("better", Stroker::Better),
    ("spline", Stroker::Spline),
];

/// Measures and reports, on one core and on two; on a device including upload and read-back of each stroke.
pub(crate) fn run(report: &mut Report, gpu: Option<&Device>) -> Result<(), UserError> {
    let fault = |error: BrushError| UserError::failure(error.to_string());
    let mut file = BrushFile::library("round").map_err(fault)?;
    file.strips.count = BRUSH.1;
    let file = file.scaled_to(BRUSH.0).map_err(fault)?;
    let trial = Trial::new(file, CELLS.0, CELLS.1);
    let mut trial = trial.ok_or_else(|| UserError::failure("a surface cannot be leased"))?;
    for (stroker, kind) in STROKERS {
        for path in PATHS {
            let poses = trial.heads(path);
            let texels = texels(&mut trial, kind, &poses);
            let mut model = model(kind, gpu)?;
            let alone = with_threads(1, || rates(&mut trial, &mut *model, &poses));
            let shared = with_threads(2, || rates(&mut trial, &mut *model, &poses));
            let name = format!("{stroker}.{}", path.name);
            let of = |count: fn([u64; 2]) -> u64| -> Vec<(f64, f64)> {
                let rate = |(cells, seconds): &(u64, f64)| count([texels, *cells]) as f64 / seconds;
                let pairs = shared.iter().zip(&alone);
                pairs.map(|(two, one)| (rate(two), rate(one))).collect()
            };
            for (quantity, unit, pairs) in [
                ("texels_per_s", "texels/s", of(|[texels, _]| texels)),
                ("touched_per_s", "cells/s", of(|[_, touched]| touched)),
            ] {
                report.paired(&format!("{quantity}.{name}"), unit, "on one core", &pairs);
            }
        }
    }
    Ok(())
}

/// The algorithm, on a device if there is one.
fn model(stroker: Stroker, gpu: Option<&Device>) -> Result<Box<dyn PaintModel>, UserError> {
    let Some(gpu) = gpu else {
        return Ok(Box::new(Dab::stroking(stroker)));
    };
    let fault = |error| UserError::failure(format!("the graphics device: {error}"));
    let model = maulstick_dab::device::stroking(gpu.clone(), stroker).map_err(fault)?;
    Ok(Box::new(model))
}

/// Texels of the footprints of a stroke.
fn texels(trial: &mut Trial, stroker: Stroker, poses: &[HeadPose]) -> u64 {
    let mut dab = Dab::stroking(stroker);
    trial.wet();
    trial.stroke(&mut dab, poses);
    dab.texels()
}

/// Cells that were touched in each round, and seconds.
fn rates(trial: &mut Trial, model: &mut dyn PaintModel, poses: &[HeadPose]) -> Vec<(u64, f64)> {
    let round = |_| {
        trial.wet();
        let begun = Instant::now();
        let sum = trial.stroke(model, poses);
        (sum.footprint_cells, begun.elapsed().as_secs_f64())
    };
    (0..ROUNDS).map(round).skip(1).collect()
}
