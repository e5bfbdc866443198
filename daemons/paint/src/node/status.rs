//! Status of the paint node, as the rig receives it.

use maulstick_bus::BusError;
use maulstick_painting::Painting;
use maulstick_types::paint::{DryingStatus, HistoryStep, PaintStatus};
use maulstick_types::scene::CANVAS;

use super::PaintNode;

/// Steps that a status lists.
const LISTED: usize = 30;
/// Letters of a text in the name of a step.
const LETTERS: usize = 80;

/// The steps around the present one.
fn history(painting: &Painting) -> Vec<HistoryStep> {
    let steps = painting.history().around(LISTED);
    let listed = steps.into_iter().map(|step| HistoryStep {
        id: step.id,
        what: step.what.shortened(LETTERS),
        done: step.done,
    });
    listed.collect()
}

/// Progress of the canvas's drying.
fn drying(painting: &Painting) -> Option<DryingStatus> {
    let mut dryings = painting.clock().dryings.iter();
    let drying = dryings.find(|drying| drying.surface == CANVAS)?;
    Some(DryingStatus {
        share: drying.elapsed as f32 / drying.ticks.max(1) as f32,
        ticks_left: drying.ticks - drying.elapsed,
        layer: drying.name.clone(),
    })
}

impl PaintNode {
    /// Publishes the status where it is due.
    pub(super) fn publish_status(&mut self, now_ns: u64) -> Result<(), BusError> {
        if !self.outputs.is_status_due(now_ns) {
            return Ok(());
        }
        let painting = self.sequencer.painting();
        self.inputs.warn_of_unknown(painting, now_ns);
        let (steps, footprint_cells) = painting.work();
        let (undo, redo) = painting.history_depth();
        let journal = self.sequencer.journal_next();
        let kept = self.files.home_mut().kept(journal, now_ns);
        let baking = self.feed.baking();
        let status = PaintStatus {
            journal,
            steps,
            footprint_cells,
            lag_ns: self.inputs.lag_ns(now_ns),
            longer: painting.longer(),
            memory_bytes: painting.bytes() as u64,
            committed: kept.committed,
            committed_ns: kept.committed_ns,
            all_committed: kept.is_complete,
            path: kept.path,
            blank: painting.is_blank(),
            take: self.sequencer.is_taking(),
            drying: drying(painting),
            export: self.files.export_status(now_ns),
            backend: painting.backend(),
            history: history(painting),
            undo: undo as u32,
            redo: redo as u32,
            merged: painting.history().merged(),
            kept_bytes: painting.pager().counts().held(),
            fault: kept.fault,
            lost: self.inputs.counts().lost,
            baking: baking.all,
            baked: baking.done,
            refused: self.refused(),
        };
        self.outputs.publish_status(status, now_ns)
    }
}
