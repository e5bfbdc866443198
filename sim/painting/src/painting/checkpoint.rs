//! Checkpoints of a painting for its document, and its restoration from them.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_appearance::Appearance;
use maulstick_appearance::light::studio_settings;
use maulstick_brush::{BrushFile, Head};
use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::store::TileStore;
use maulstick_canvas::tile::{TileId, Version};
use maulstick_model::brush::head::Waypoint;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_model::path::PathStepper;
use maulstick_optics::{PaintLibrary, Studio};
use maulstick_types::scene::{CANVAS, PALETTE};

use super::backend::{BackendFallback, Deferral};
use super::brush_modes::UnderBrush;
use super::lighting::paint_slot;
use super::undo::makes;
use super::{Named, Painting, PaintingBrush, SurfaceState, bare};
use crate::error::paint_error;
use crate::history::{History, NonTileState, Step, TilePlace};
use crate::models::{Models, model_called};
use crate::setup::check_size;
use crate::snapshot::{BrushSnapshot, OpenStepSnapshot, PaintingSnapshot, RowCounts};

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
    /// Steps that went.
    pub gone_steps: Vec<u64>,
    /// Versions that came or changed.
    pub named: Vec<Named>,
    /// Versions that went.
    pub gone_named: Vec<String>,
    /// Pages and dry layers without references.
    pub dead: Vec<u64>,
}

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
}

impl Painting {
    /// Changes since the last call, where the newest tile version was `since`.
    pub fn checkpoint(&mut self, since: u64) -> Checkpoint {
        self.commit();
        let loads = self.rest().loads;
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
        let (mut named, mut gone_named) = (Vec::new(), Vec::new());
        for name in std::mem::take(&mut self.named_touched) {
            match self.named.get(&name) {
                Some(version) => named.push(version.clone()),
                None => gone_named.push(name),
            }
        }
        let (mut tiles, mut all_tiles) = (Vec::new(), 0);
        for sheet in &self.sheets {
            all_tiles += sheet
                .store
                .iter()
                .filter(|(_, version)| version.number > 0)
                .count();
            let changed = sheet
                .store
                .iter()
                .filter(|(_, version)| version.number > since);
            tiles.extend(changed.map(|(id, version)| ((sheet.id, id), version.clone())));
        }
        let (step, undone) = self.history.position();
        let kept = PaintingSnapshot {
            scene: self.scene.clone(),
            paints: self.library.text().to_owned(),
            tops: self
                .sheets
                .iter()
                .map(|sheet| (sheet.id, sheet.top))
                .collect(),
            brushes: self.kept_brushes(&loads),
            ledger: self.ledger.clone(),
            versions: self.versions,
            next_page: self.pager.next_number(),
            step,
            open_steps,
            undone: undone.to_vec(),
            line: self.line.clone(),
            steps: self.steps,
            footprint_cells: self.footprint_cells,
            span_ns: self.span_ns,
            quota: self.quota,
            clock: self.clock.clone(),
            rows: Some(RowCounts {
                tiles: all_tiles as u64,
                steps: (self.history.steps().count() + self.history.open().count()) as u64,
                versions: self.named.len() as u64,
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
            dead: self.pager.take_dead(),
        }
    }

    /// Makes the next checkpoint hold the whole history and all versions: its document has none of them.
    pub fn tell_all_again(&mut self) {
        self.history.touch_all();
        self.named_touched.extend(self.named.keys().cloned());
    }

    fn kept_brushes(
        &self,
        loads: &BTreeMap<String, Page<BrushLoad>>,
    ) -> BTreeMap<String, BrushSnapshot> {
        let brushes = self.brushes.iter().map(|(name, track)| {
            let path = track.path.as_ref().and_then(|(sheet, path)| {
                let surface = self.sheets.get(*sheet)?.id;
                let (at, ahead) = path.places();
                Some((surface, path.scale(), at.into(), ahead.map(Into::into)))
            });
            let kept = BrushSnapshot {
                file: track.file.to_toml().unwrap_or_default(),
                load: loads.get(name).map_or(0, Page::id),
                stroke: track.stroke,
                path,
                loads: track.loads.clone(),
                strokes: track.strokes,
                seed: track.seed,
            };
            (name.clone(), kept)
        });
        brushes.collect()
    }

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
        let mut look = Appearance::new(Studio::new(
            &studio_settings(&scene.light)?,
            library.paints(),
        ));
        for (place, slot) in scene.paints.iter().enumerate() {
            let paint = library.find(&slot.name).map_err(paint_error)?;
            paint_slot(&mut look.studio, paint, slot.file_hash);
            if paint.is_thinner() {
                look.thinner = Some(place);
            }
        }
        look.set_layers(&scene.layers);
        let makers = (&library, &restored.embedded);
        let mut sheets = Vec::new();
        for surface in &scene.surfaces {
            sheets.push(SurfaceState {
                id: surface.id,
                cell_m: surface.cell_m,
                model: model_called(&surface.model)?,
                store: TileStore::paged(surface.cells, &pager),
                bare: Arc::new(bare(surface, &look.studio, makers, None)?),
                top: kept.tops.get(&surface.id).copied().unwrap_or(0.0),
            });
        }
        for ((surface, id), version) in restored.tiles {
            let sheet = sheets.iter_mut().find(|sheet| sheet.id == surface);
            if let Some(sheet) = sheet
                && id.x < sheet.store.grid()[0]
                && id.y < sheet.store.grid()[1]
            {
                sheet.store.replace(id, version);
            }
        }
        let mut brushes = BTreeMap::new();
        for (name, brush) in kept.brushes {
            let load = restored.loads.get(&name).cloned();
            let track = restored_track(&name, brush, load, &sheets)?;
            brushes.insert(name, track);
        }
        let (open, steps) = (restored.steps.into_iter())
            .partition(|step| kept.open_steps.iter().any(|open| open.step == step.id));
        let rest = NonTileState {
            loads: restored.loads,
            ledger: kept.ledger.clone(),
            layers: scene.layers.clone(),
            makes: makes(&scene),
            tops: kept.tops.clone(),
        };
        let open: Vec<Step> = open;
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
        let history = History::restored(kept.step, steps, kept.undone, open);
        let mut painting = Self {
            scene,
            library,
            look: Arc::new(look),
            sheets,
            embedded: restored.embedded,
            brushes,
            models: Models::default(),
            unsettled: None,
            fall: BackendFallback::default(),
            accounted: kept.ledger.clone(),
            ledger: kept.ledger,
            history,
            quota: kept.quota,
            named: restored
                .named
                .into_iter()
                .map(|version| (version.name.clone(), version))
                .collect(),
            named_touched: Default::default(),
            line: kept.line,
            pager,
            versions: kept.versions,
            steps: kept.steps,
            footprint_cells: kept.footprint_cells,
            span_ns: kept.span_ns,
            clock: kept.clock,
        };
        painting.note_look();
        Ok(painting)
    }

    /// Forgets positions and times of the brushes: the next states begin new paths.
    pub fn lift_brushes(&mut self) {
        self.close_windows();
        self.span_ns = None;
        self.brushes
            .values_mut()
            .for_each(|track| track.path = None);
    }

    /// Numbers tile versions from `least` on.
    pub fn skip_versions(&mut self, least: u64) {
        self.versions = self.versions.max(least);
    }

    /// The pages of the painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.pager
    }
}

fn restored_track(
    name: &str,
    brush: BrushSnapshot,
    load: Option<Page<BrushLoad>>,
    sheets: &[SurfaceState],
) -> Result<PaintingBrush, EditError> {
    let file = BrushFile::parse(&brush.file).map_err(|error| {
        EditError::Damaged(format!(
            "the file of brush '{name}' in the document is wrong: {error}"
        ))
    })?;
    let content = load.as_ref().map(Page::get);
    let thinned = match &content {
        Some(load) if load.texels() > 0 => file.thinned_to(load.texels() / TEXELS_PER_STRIP),
        _ => file.thinned(sheets[0].cell_m),
    };
    let tidy = Arc::new(Head::of(&thinned));
    let head = Arc::new(tidy.disordered(brush.seed));
    let path = brush.path.and_then(|(surface, scale, at, ahead)| {
        let sheet = sheets.iter().position(|sheet| sheet.id == surface)?;
        let places = (Waypoint::from(at), ahead.map(Waypoint::from));
        Some((sheet, PathStepper::going_on(&head, places, scale)))
    });
    let strips = head.strips();
    let (load, kept) = match (content, load) {
        (Some(content), Some(page)) if content.texels() == strips * TEXELS_PER_STRIP => {
            (Arc::clone(&content), Some((content, page)))
        }
        (Some(content), _) => (Arc::new(content.onto(strips, &tidy)), None),
        _ => (Arc::new(BrushLoad::clean(strips)), None),
    };
    Ok(PaintingBrush {
        under: UnderBrush::default(),
        file,
        thinned,
        tidy,
        head,
        load,
        kept,
        stroke: brush.stroke,
        path,
        window: None,
        loads: brush.loads,
        strokes: brush.strokes,
        seed: brush.seed,
        deferral: Deferral::default(),
    })
}
