//! Status of the paint node, as the rig receives it.

use maulstick_bus::BusError;
use maulstick_document::Document;
use maulstick_painting::Painting;
use maulstick_types::node::NodeWork;
use maulstick_types::paint::{DryingStatus, HistoryStep, PaintStatus};
use maulstick_types::scene::CANVAS;

use super::{PaintNode, STATUS_PERIOD_NS};
use maulstick_session::Autosave;

/// Time between two statuses that say the same, ns: each one wakes all that listen.
const AT_REST_NS: u64 = 5 * STATUS_PERIOD_NS;
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

impl PaintNode {
    /// Says once of each brush that it moves without a brush file.
    fn tell_unknown(&mut self, now_ns: u64) {
        for next in self.states.heads() {
            let brush = self.topics.middle(&next.key).unwrap_or_default();
            let waits = now_ns.saturating_sub(next.arrived_ns) > STATUS_PERIOD_NS;
            if waits && !self.sequencer.painting().knows_brush(brush) && self.unknown.say(brush) {
                tracing::warn!("{}: its brush file has not come, its states wait", next.key);
            }
        }
    }

    /// What this node has done since its start, and what waits.
    #[must_use]
    pub fn work(&self) -> NodeWork {
        let (painting, topics) = (self.sequencer.painting(), &self.topics);
        let is_known = |key: &str| {
            let brush = topics.middle(key);
            brush.is_some_and(|brush| painting.knows_brush(brush))
        };
        let heads = self.states.heads();
        let (waiting, held): (Vec<_>, Vec<_>) = heads.partition(|next| is_known(&next.key));
        let counts = self.states.counts();
        NodeWork {
            consumed: counts.received,
            produced: self.journal.sent(),
            waiting: waiting.len() as u64,
            held: held.len() as u64,
            refused: self.refused_in_all(),
            lost: counts.lost,
            too_fast: 0,
        }
    }

    /// Messages that it did not obey.
    fn refused_in_all(&self) -> u64 {
        self.refused
            + self.states.counts().refused
            + self.reader.refused()
            + self.sequencer.ignored()
    }

    pub(super) fn publish_status(&mut self, now_ns: u64) -> Result<(), BusError> {
        if now_ns < self.status_ns + STATUS_PERIOD_NS {
            return Ok(());
        }
        self.status_ns = now_ns;
        let (steps, footprint_cells) = self.sequencer.painting().work();
        let counts = self.states.counts();
        self.tell_unknown(now_ns);
        let oldest_ns = self.states.heads().map(|next| next.header.event_ns).min();
        let lag_ns = oldest_ns.map_or(0, |oldest_ns| now_ns.saturating_sub(oldest_ns));
        let baking = self.feed.lock().baking;
        let painting = self.sequencer.painting();
        let document = self.autosave.as_ref().map(Autosave::document);
        let named = document.filter(|_| !self.unnamed);
        let (undo, redo) = painting.history_depth();
        let committed = document.map_or(0, Document::committed);
        if committed > self.committed.0 {
            self.committed = (committed, now_ns);
        }
        let mut dryings = painting.clock().dryings.iter();
        let drying = dryings
            .find(|drying| drying.surface == CANVAS)
            .map(|drying| DryingStatus {
                share: drying.elapsed as f32 / drying.ticks.max(1) as f32,
                ticks_left: drying.ticks - drying.elapsed,
                layer: drying.name.clone(),
            });
        let status = PaintStatus {
            journal: self.sequencer.journal_next(),
            steps,
            footprint_cells,
            lag_ns,
            longer: painting.longer(),
            memory_bytes: painting.bytes() as u64,
            committed,
            committed_ns: self.committed.1,
            all_committed: committed >= self.sequencer.journal_next()
                && named.is_some_and(Document::is_saved),
            path: named.map_or(String::new(), |document| {
                document.path().display().to_string()
            }),
            blank: painting.is_blank(),
            take: self.sequencer.is_taking(),
            drying,
            export: self.exporter.status(now_ns),
            backend: painting.backend(),
            history: history(painting),
            undo: undo as u32,
            redo: redo as u32,
            merged: painting.history().merged(),
            kept_bytes: painting.pager().counts().held(),
            fault: document
                .and_then(Document::fault)
                .map_or(String::new(), |(what, help)| format!("{what}: {help}")),
            lost: counts.lost,
            baking: baking.all,
            baked: baking.done,
            refused: self.refused_in_all(),
        };
        let told = self.told_status.as_ref();
        if told.is_some_and(|(told, told_ns)| *told == status && now_ns < told_ns + AT_REST_NS) {
            return Ok(());
        }
        self.status.send(now_ns, now_ns, &status)?;
        self.told_status = Some((status, now_ns));
        Ok(())
    }
}
