//! A painting from its document.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::tile::Version;
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;
use maulstick_types::scene::{CANVAS, PALETTE, Scene};

use super::accounts::Accounts;
use super::backend::Backend;
use super::bench::Workbench;
use super::brushes::Brushes;
use super::desk::Desk;
use super::past::Past;
use super::past::record::RecordState;
use super::past::versions::Versions;
use super::{Named, Painting};
use crate::beginning::Beginning;
use crate::error::EditError;
use crate::history::{History, NonTileState, Step, TilePlace, materials};
use crate::setup::check_size;
use crate::snapshot::PaintingSnapshot;

/// A painting as it comes from its document.
#[derive(Debug)]
pub struct Restored {
    /// The painting besides its tiles, with the files of its brushes.
    pub kept: PaintingSnapshot,
    /// Its tiles.
    pub tiles: Vec<(TilePlace, Version)>,
    /// Loads of the brushes, by name.
    pub loads: BTreeMap<String, Page<BrushLoad>>,
    /// The steps of its history.
    pub steps: Vec<Step>,
    /// Its versions.
    pub named: Vec<Named>,
    /// The pictures that its grounds and teeth are made of, those of its history among them.
    pub embedded: Assets,
    /// Beginning of its record, if it has one.
    pub beginning: Option<Arc<Beginning>>,
}

impl Restored {
    /// Its desk, with the tiles.
    fn desk(&mut self, library: PaintLibrary, pager: Arc<Pager>) -> Result<Desk, EditError> {
        let kept = &self.kept;
        check(&kept.scene)?;
        let assets = std::mem::take(&mut self.embedded);
        let mut desk = Desk::new(kept.scene.clone(), library, assets, pager)?;
        let surfaces = &mut desk.surfaces;
        surfaces.newest_version = kept.versions;
        for surface in surfaces.iter_mut() {
            surface.top = kept.tops.get(&surface.id).copied().unwrap_or(0.0);
        }
        for ((surface, id), version) in std::mem::take(&mut self.tiles) {
            if let Some(surface) = surfaces.find_mut(surface)
                && id.x < surface.store.grid()[0]
                && id.y < surface.store.grid()[1]
            {
                surface.store.replace(id, version);
            }
        }
        Ok(desk)
    }

    /// Its past.
    fn past(self) -> Past {
        let kept = self.kept;
        let open_step = |id: u64| kept.open_steps.iter().find(|open| open.step == id);
        let is_open = |step: &Step| open_step(step.id).is_some();
        let (open, steps): (Vec<Step>, Vec<Step>) = self.steps.into_iter().partition(is_open);
        let rest = NonTileState {
            loads: self.loads,
            ledger: kept.ledger,
            materials: materials(&kept.scene),
            layers: kept.scene.layers,
            tops: kept.tops,
        };
        let reopened = |step: Step| {
            let kept = open_step(step.id);
            step.reopened(&rest, kept)
        };
        let open = open.into_iter().map(reopened).collect();
        let position = (kept.step, kept.undone);
        let mut history = History::restored(position, steps, open, kept.quotas.quota);
        history.note_changed_surfaces(kept.has_changed_surfaces);
        Past {
            history,
            versions: Versions::restored(self.named, kept.line),
            record: RecordState::restored(kept.quotas.record_quota, self.beginning),
        }
    }
}

/// Checks the surfaces of a document's scene.
fn check(scene: &Scene) -> Result<(), EditError> {
    for surface in &scene.surfaces {
        check_size(surface.cells, surface.cell_m)?;
    }
    let ids: Vec<u32> = scene.surfaces.iter().map(|surface| surface.id).collect();
    if ids != [CANVAS, PALETTE] {
        return Err(EditError::Damaged(
            "the document has no canvas and palette".to_owned(),
        ));
    }
    Ok(())
}

impl Painting {
    /// A painting from its document.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn restore(
        mut restored: Restored,
        library: PaintLibrary,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        let desk = restored.desk(library, pager)?;
        let kept = &mut restored.kept;
        let brushes = std::mem::take(&mut kept.brushes);
        let brushes = Brushes::restored(brushes, &restored.loads, &desk.surfaces)?;
        let accounts = Accounts::restored(kept.ledger.clone(), kept.work.clone());
        Ok(Self {
            clock: std::mem::take(&mut kept.clock),
            bench: Workbench {
                desk,
                brushes,
                backend: Backend::default(),
                accounts,
                past: restored.past(),
            },
        })
    }
}
