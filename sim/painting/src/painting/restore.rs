//! A painting from its document.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::tile::{TileId, Version};
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;
use maulstick_types::scene::{CANVAS, PALETTE};

use super::accounts::Accounts;
use super::brushes::Brushes;
use super::optics::Optics;
use super::record::RecordState;
use super::strokes::backend::Backend;
use super::surfaces::Surfaces;
use super::undo::materials;
use super::undo::versions::Versions;
use super::{Named, Painting};
use crate::beginning::Beginning;
use crate::history::{History, NonTileState, Step, TilePlace};
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

impl Painting {
    /// A painting from its document.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn restore(
        restored: Restored,
        library: PaintLibrary,
        pager: Arc<Pager>,
    ) -> Result<Self, EditError> {
        let kept = restored.kept;
        let scene = kept.scene;
        for surface in &scene.surfaces {
            check_size(surface.cells, surface.cell_m)?;
        }
        let ids: Vec<u32> = scene.surfaces.iter().map(|surface| surface.id).collect();
        if ids != [CANVAS, PALETTE] {
            return Err(EditError::Damaged(
                "the document has no canvas and palette".to_owned(),
            ));
        }
        let optics = Optics::of(&scene, library, restored.embedded)?;
        let mut surfaces = Surfaces::new(&scene, &optics, pager)?;
        surfaces.newest_version = kept.versions;
        for surface in surfaces.iter_mut() {
            surface.top = kept.tops.get(&surface.id).copied().unwrap_or(0.0);
        }
        for ((surface, id), version) in restored.tiles {
            if let Some(surface) = surfaces.find_mut(surface)
                && id.x < surface.store.grid()[0]
                && id.y < surface.store.grid()[1]
            {
                surface.store.replace(id, version);
            }
        }
        let brushes = Brushes::restored(kept.brushes, &restored.loads, &surfaces)?;
        let (open, steps): (Vec<Step>, Vec<Step>) = (restored.steps.into_iter())
            .partition(|step| kept.open_steps.iter().any(|open| open.step == step.id));
        let rest = NonTileState {
            loads: restored.loads,
            ledger: kept.ledger.clone(),
            layers: scene.layers.clone(),
            materials: materials(&scene),
            tops: kept.tops.clone(),
        };
        let reopened = |step: Step| {
            let mut known = kept.open_steps.iter();
            let known = known.find(|open| open.step == step.id);
            let reached = known.into_iter().flat_map(|open| &open.reached);
            let reached = reached.map(|[surface, x, y]| (*surface, TileId { x: *x, y: *y }));
            let reached = reached.collect();
            let mut open = step.reopened(&rest, reached);
            if let Some(tops) = known.map(|open| open.tops.clone()) {
                open.before.tops = tops;
            }
            open
        };
        let open = open.into_iter().map(reopened).collect();
        let position = (kept.step, kept.undone);
        let mut history = History::restored(position, steps, open, kept.quota);
        history.note_changed_surfaces(kept.has_changed_surfaces);
        Ok(Self {
            scene,
            optics,
            surfaces,
            brushes,
            backend: Backend::default(),
            accounts: Accounts::restored(
                kept.ledger,
                [kept.steps, kept.footprint_cells],
                kept.span_ns,
            ),
            history,
            versions: Versions::restored(restored.named, kept.line),
            clock: kept.clock,
            record: RecordState::restored(kept.record_quota, restored.beginning),
        })
    }
}
