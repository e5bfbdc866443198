//! Checkpoints of a painting for its document.

use std::collections::BTreeMap;

use maulstick_canvas::page::Page;
use maulstick_canvas::tile::Version;
use maulstick_model::brush::load::BrushLoad;

use super::bench::Workbench;
use super::{Named, Painting};
use crate::beginning::{Beginning, RecordChange};
use crate::history::{OpenStep, Step, TilePlace};
use crate::snapshot::{PaintingSnapshot, QuotaSnapshot, RowCounts, SequencerSnapshot};

/// Changes since the previous checkpoint; one moment of the painting, whole.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// The painting besides its tiles.
    pub kept: PaintingSnapshot,
    /// Tiles that changed.
    pub tiles: Vec<(TilePlace, Version)>,
    /// Loads of the brushes, by name.
    pub loads: BTreeMap<String, Page<BrushLoad>>,
    /// Steps that came or changed; those that are not finished are among them.
    pub steps: Vec<Step>,
    /// Numbers of dropped steps.
    pub gone_steps: Vec<u64>,
    /// Versions that came or changed.
    pub named: Vec<Named>,
    /// Names of deleted versions.
    pub gone_named: Vec<String>,
    /// Pages and dry layers without references.
    pub dead: Vec<u64>,
}

impl Painting {
    /// Changes since the last call, where the newest tile version was `since`.
    pub fn checkpoint(&mut self, since: u64) -> Checkpoint {
        self.commit();
        let bench = &mut self.bench;
        let loads = bench.brushes.load_pages(&bench.desk.surfaces.pager);
        let (mut steps, gone_steps) = bench.past.history.take_touched();
        steps.extend(bench.open_steps());
        let (named, gone_named) = bench.past.versions.take_touched();
        let (tiles, all_tiles) = bench.desk.surfaces.changed_since(since);
        let kept = self.snapshot(&loads, all_tiles);
        Checkpoint {
            kept,
            tiles,
            loads,
            steps,
            gone_steps,
            named,
            gone_named,
            dead: self.pager().take_dead(),
        }
    }

    /// The painting besides its tiles, with the number of tiles that were ever painted on.
    fn snapshot(
        &mut self,
        loads: &BTreeMap<String, Page<BrushLoad>>,
        tiles: u64,
    ) -> PaintingSnapshot {
        let Workbench {
            desk,
            brushes,
            accounts,
            past,
            ..
        } = &mut self.bench;
        let (surfaces, history) = (&desk.surfaces, &mut past.history);
        let has_changed_surfaces = history.has_changed_surfaces();
        history.note_changed_surfaces(has_changed_surfaces);
        let (step, undone) = history.position();
        PaintingSnapshot {
            scene: desk.scene.clone(),
            paints: desk.optics.library.text().to_owned(),
            tops: surfaces.tops(),
            brushes: brushes.snapshot(surfaces, loads),
            ledger: accounts.ledger.clone(),
            versions: surfaces.newest_version,
            next_page: surfaces.pager.next_number(),
            step,
            open_steps: history.open().map(OpenStep::snapshot).collect(),
            undone: undone.to_vec(),
            has_changed_surfaces,
            line: past.versions.line.clone(),
            work: accounts.work.clone(),
            quotas: QuotaSnapshot {
                quota: history.quota,
                record_quota: past.record.quota,
            },
            clock: self.clock.clone(),
            rows: Some(RowCounts {
                tiles,
                steps: (history.steps().count() + history.open().count()) as u64,
                versions: past.versions.iter().len() as u64,
            }),
        }
    }

    /// Makes the next checkpoint contain the whole history and all versions, which its document lacks.
    pub fn tell_all_again(&mut self) {
        self.bench.past.touch_all();
    }

    /// Limit of the record, bytes; beyond it the record begins anew at the next checkpoint. 0 keeps none.
    pub fn set_record_quota(&mut self, bytes: u64) {
        self.bench.past.record.quota = bytes;
    }

    /// Limit of the record, bytes.
    #[must_use]
    pub fn record_quota(&self) -> u64 {
        self.bench.past.record.quota
    }

    /// Has the record begin anew at the next checkpoint, as after a change that no accepted message describes.
    pub fn break_record(&mut self) {
        self.bench.past.record.is_broken = true;
    }

    /// Change of the record at a checkpoint that was just made, of this painting and its sequencer, at a time of the
    /// wall clock, ms since 1970.
    pub fn advance_record(
        &mut self,
        checkpoint: &Checkpoint,
        sequencer: &SequencerSnapshot,
        time_ms: u64,
    ) -> RecordChange {
        let is_open = |step: &&Step| {
            let mut open = checkpoint.kept.open_steps.iter();
            open.any(|open| open.step == step.id)
        };
        let Workbench { desk, past, .. } = &mut self.bench;
        let (surfaces, versions) = (&desk.surfaces, &past.versions);
        past.record.advance(|| Beginning {
            time_ms,
            painting: checkpoint.kept.clone(),
            sequencer: sequencer.clone(),
            tiles: surfaces.painted(),
            loads: checkpoint.loads.clone(),
            open: checkpoint.steps.iter().filter(is_open).cloned().collect(),
            named: versions.iter().cloned().collect(),
        })
    }
}
