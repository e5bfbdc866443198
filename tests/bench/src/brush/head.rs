//! A brush of the library: one solve of all its spines, and its strips.

use std::time::Instant;

use maulstick_brush::desk::Obstacle;
use maulstick_brush::head_solver::settings_of;
use maulstick_brush::head_solver::{HeadSolver, SolvedHead};
use maulstick_brush::{BrushFile, Head, HeadPose, Hold, SpineLayout};
use maulstick_rig::UserError;

use super::stroke::stroke;
use crate::report::{Report, quantile, sorted};

/// Strips of the strip row.
const STRIPS: usize = 1000;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let fault = |error: maulstick_brush::BrushError| UserError::failure(error.to_string());
    let mut file = BrushFile::library("round").map_err(fault)?;
    file.strips.count = STRIPS;
    let tuft = SpineLayout::of(&file);
    let settings = settings_of(&file, &tuft);
    let poses = stroke(1, file.length_m());
    let (head, walls) = (Head::of(&file), [Obstacle::ground()]);
    let mut held = SolvedHead::at_rest(&tuft, &poses[0]);
    let (mut room, mut into) = (HeadSolver::default(), HeadPose::default());
    let (mut solves, mut skins) = (Vec::new(), Vec::new());
    for brush in &poses {
        let clock = Instant::now();
        if !held.solve(&mut room, &tuft, brush, &walls, &settings) {
            return Err(UserError::failure("a pose of the stroke has no solution"));
        }
        solves.push(clock.elapsed().as_secs_f64() * 1e6);
        let angles = held.angles();
        let hold = Hold {
            brush,
            angles: &angles,
            per_m: 1.0,
            wetness: 0.5,
        };
        let clock = Instant::now();
        head.pose(&hold, &mut into);
        skins.push(clock.elapsed().as_secs_f64() * 1e6);
    }
    let median = |values: Vec<f64>| quantile(&sorted(values), 0.5);
    report.row("head_solve", median(solves), "µs");
    report.row("skin_1000_strips", median(skins), "µs");
    Ok(())
}
