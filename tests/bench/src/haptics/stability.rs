//! The stability grid of the servo, the same that `./test` asserts, on its own clock.

use maulstick_rig::UserError;
use maulstick_stability_grid::{HANDS, Outcome, Path, Run, Worst, grid};

use super::fault;
use crate::report::Report;

/// Goes through the grid and reports its worst.
pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let worst = Worst::of(&went(&grid(Path::Servo))?);
    report.row("grid.runs", worst.runs as f64, "");
    report.row("grid.fails", worst.fails as f64, "runs");
    report.row("grid.worst_peak_to_peak_mm", worst.wobble_m * 1e3, "mm");
    report.row("grid.worst_energy_uj", worst.net_j * 1e6, "µJ");
    report.row("grid.worst_force_error", worst.force_error, "share");
    let [fingertip, _, _] = HANDS;
    let mut sent = grid(Path::Sent);
    sent.retain(|run| run.hand == fingertip);
    let worst = Worst::of(&went(&sent)?);
    report.row("grid.force_sent_fails", worst.fails as f64, "runs");
    report.row("grid.force_sent_runs", worst.runs as f64, "");
    Ok(())
}

/// Outcomes of the runs, in order, computed by a thread a core.
fn went(runs: &[Run]) -> Result<Vec<(Run, Outcome)>, UserError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let some = |runs: &[Run]| -> Result<Vec<(Run, Outcome)>, &'static str> {
        runs.iter().map(|run| Ok((*run, run.go()?))).collect()
    };
    let found: Vec<_> = std::thread::scope(|scope| {
        let parts = runs.chunks(runs.len().div_ceil(cores).max(1));
        let threads: Vec<_> = parts.map(|part| scope.spawn(move || some(part))).collect();
        threads.into_iter().map(|thread| thread.join()).collect()
    });
    let mut all = Vec::new();
    for part in found {
        let part = part.map_err(|_| fault("a run of the stability grid ended by a fault"))?;
        all.extend(part.map_err(fault)?);
    }
    Ok(all)
}
