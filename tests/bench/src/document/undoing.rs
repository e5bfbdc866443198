//! Ten thousand steps taken back.

use maulstick_rig::UserError;

use maulstick_painting::edits::Undo;

use super::fault;
use super::hand::{Easel, Took};
use crate::report::{Report, quantile, sorted};
use crate::thread_cpu::thread_cpu;

const CELLS: u32 = 4096;
const STEPS: usize = 10_000;
/// Length of a dab, m.
const STROKE_M: f64 = 4e-3;

pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let folder = tempfile::tempdir().map_err(fault)?;
    let path = folder.path().join("long.maul");
    let mut easel = Easel::new(&path, CELLS, 512 << 20, u64::MAX)?;
    let mut took = Took::default();
    easel.load()?;
    for step in 0..STEPS {
        if step % 500 == 499 {
            easel.load()?;
        }
        easel.stroke(STROKE_M, &mut took)?;
    }
    let (steps, _) = easel.sequencer.painting().history_depth();
    let mut spent_ms = Vec::new();
    for _ in 0..STEPS {
        let (busy, paged) = (thread_cpu(), easel.autosave.document().page_in_cpu());
        easel.sequencer.edit(Undo { brush: None }).map_err(fault)?;
        let busy = thread_cpu().saturating_sub(busy);
        let paged = easel
            .autosave
            .document()
            .page_in_cpu()
            .saturating_sub(paged);
        spent_ms.push(1e3 * (busy + paged).as_secs_f64());
        easel.keep();
    }
    report.row("document: steps of the history", steps as f64, "");
    let spent_ms = sorted(spent_ms);
    report.row(
        "document: an undo of 10,000, p99",
        quantile(&spent_ms, 0.99),
        "ms",
    );
    report.row(
        "document: an undo of 10,000, median",
        quantile(&spent_ms, 0.5),
        "ms",
    );
    easel.autosave.close(&mut easel.sequencer).map_err(fault)?;
    let bytes = std::fs::metadata(&path).map_or(0, |about| about.len());
    report.row(
        "document: file with 10,000 steps",
        bytes as f64 / f64::from(1 << 20),
        "MiB",
    );
    Ok(())
}
