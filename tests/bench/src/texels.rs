//! dAb's stroking algorithms by themselves (Baxter 2004, table 4.2): texels of footprints blended a second, and cells of
//! them that were touched, along two kinds of path, of which the text says nothing: here a fast straight one and a slow
//! curved one.

use std::time::Instant;

use maulstick_brush::{BrushError, BrushFile, HeadPose};
use maulstick_dab::Dab;
use maulstick_dab::stroke::Stroker;
use maulstick_model::trial::Trial;
use maulstick_rig::UserError;

use crate::report::Report;

/// Cells either way, and their side, m.
const CELLS: (u32, f64) = (1024, 2.5e-4);
/// Width of the brush, mm, and its strips: a footprint about 60 cells wide.
const BRUSH: (f64, usize) = (10.0, 96);
/// Wet paint on the canvas, quanta.
const FILM: f32 = 40_000.0;
/// Rounds, of which the first warms up.
const ROUNDS: usize = 8;

/// A path: its name, the way from state to state in cells, and how much it turns on that way, rad.
const PATHS: [(&str, f64, f64); 2] = [("straight", 20.0, 0.0), ("curved", 3.0, 0.03)];
const STROKERS: [(&str, Stroker); 3] = [
    ("faster", Stroker::Faster),
    ("better", Stroker::Better),
    ("spline", Stroker::Spline),
];

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let fault = |error: BrushError| UserError::failure(error.to_string());
    let mut file = BrushFile::library("round").map_err(fault)?;
    file.strips.count = BRUSH.1;
    let file = file.scaled_to(BRUSH.0).map_err(fault)?;
    let trial = Trial::new(file, CELLS.0, CELLS.1);
    let mut trial = trial.ok_or_else(|| UserError::failure("a surface cannot be leased"))?;
    for (stroker, kind) in STROKERS {
        for (path, way, turn) in PATHS {
            let poses = heads(&trial, (way, turn));
            let rates = rates(&mut trial, Dab::stroking(kind), &poses);
            let (texels, touched) = rates.into_iter().unzip();
            report.median(
                &format!("texels_per_s.{stroker}.{path}"),
                "texels/s",
                texels,
            );
            report.median(
                &format!("touched_per_s.{stroker}.{path}"),
                "cells/s",
                touched,
            );
        }
    }
    Ok(())
}

/// The heads along a path.
fn heads(trial: &Trial, (way, turn): (f64, f64)) -> Vec<HeadPose> {
    let (mut at, mut direction) = ([150.0, 300.0], 0.0f64);
    let mut poses = Vec::new();
    while poses.len() < 200 && at[0] > 60.0 && at[0] < f64::from(CELLS.0) - 60.0 {
        poses.push(trial.pose(at, 0.0));
        let (sine, cosine) = maulstick_num::sin_cos(direction);
        at = [at[0] + way * cosine, at[1] + way * sine];
        direction += turn;
    }
    poses
}

/// Texels of the footprints and cells that were touched, a second, of each round.
fn rates(trial: &mut Trial, mut model: Dab, poses: &[HeadPose]) -> Vec<(f64, f64)> {
    let mut rate = |_| {
        trial.window.plane_mut(0).fill(FILM);
        trial.window.plane_mut(1).fill(0.0);
        let (before, begun) = (model.texels(), Instant::now());
        let sum = trial.stroke(&mut model, poses, 1);
        let seconds = begun.elapsed().as_secs_f64();
        let counts = [model.texels() - before, sum.footprint_cells];
        let [texels, touched] = counts.map(|count| count as f64 / seconds);
        (texels, touched)
    };
    (0..ROUNDS).map(&mut rate).skip(1).collect()
}
