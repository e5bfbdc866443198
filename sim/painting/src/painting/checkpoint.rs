//! Checkpoints of a painting for its document.

use std::collections::BTreeMap;

use maulstick_canvas::page::Page;
use maulstick_canvas::tile::Version;
use maulstick_model::brush::load::BrushLoad;

use super::{Named, Painting};
use crate::history::{Step, TilePlace};
use crate::snapshot::{OpenStepSnapshot, PaintingSnapshot, RowCounts};

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
        let loads = self.brushes.load_pages(&self.surfaces.pager);
        let (mut steps, gone_steps) = self.history.take_touched();
        let open = self.open_steps();
        let open_steps = self.history.open().map(|step| OpenStepSnapshot {
            step: step.id,
            tops: step.before.tops.clone(),
            reached: step
                .reached
                .iter()
                .map(|(surface, id)| [*surface, id.x, id.y])
                .collect(),
        });
        let open_steps = open_steps.collect();
        steps.extend(open);
        let (named, gone_named) = self.versions.take_touched();
        let (mut tiles, mut all_tiles) = (Vec::new(), 0);
        for surface in self.surfaces.iter() {
            for (id, version) in surface.store.iter() {
                all_tiles += u64::from(version.number > 0);
                if version.number > since {
                    tiles.push(((surface.id, id), version.clone()));
                }
            }
        }
        let has_changed = self.history.has_changed_surfaces();
        self.history.note_changed_surfaces(has_changed);
        let (step, undone) = self.history.position();
        let kept = PaintingSnapshot {
            scene: self.scene.clone(),
            paints: self.optics.library.text().to_owned(),
            tops: self.surfaces.tops(),
            brushes: self.brushes.snapshot(&self.surfaces, &loads),
            ledger: self.accounts.ledger.clone(),
            versions: self.surfaces.newest_version,
            next_page: self.surfaces.pager.next_number(),
            step,
            open_steps,
            undone: undone.to_vec(),
            has_changed_surfaces: has_changed,
            line: self.versions.line.clone(),
            steps: self.accounts.steps,
            footprint_cells: self.accounts.footprint_cells,
            span_ns: self.accounts.span_ns,
            quota: self.history.quota,
            record_quota: self.record.quota,
            clock: self.clock.clone(),
            rows: Some(RowCounts {
                tiles: all_tiles,
                steps: (self.history.steps().count() + self.history.open().count()) as u64,
                versions: self.versions.iter().len() as u64,
            }),
        };
        Checkpoint {
            kept,
            tiles,
            loads,
            steps,
            gone_steps,
            named,
            gone_named,
            dead: self.surfaces.pager.take_dead(),
        }
    }

    /// Makes the next checkpoint contain the whole history and all versions, which its document lacks.
    pub fn tell_all_again(&mut self) {
        self.history.touch_all();
        self.versions.touch_all();
        self.break_record();
    }
}
