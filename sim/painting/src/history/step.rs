//! Steps: the changes of one operation of the painter.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_canvas::page::Page;
use maulstick_canvas::store::TileRect;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_model::brush::load::BrushLoad;
use maulstick_types::paint::StepName;
use maulstick_types::scene::{Layer, Scene, Well};
use serde::{Deserialize, Serialize};

use crate::ledger::{Booked, Ledger};
use crate::snapshot::OpenStepSnapshot;

/// A surface's number and a tile of it.
pub type TilePlace = (u32, TileId);

/// A tile; `None` where nothing was painted.
pub type TileRef = Option<Arc<Tile>>;

/// True if both are the same pages.
#[must_use]
pub fn same(one: &TileRef, other: &TileRef) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => one.is(other),
        (one, other) => [one, other]
            .into_iter()
            .flatten()
            .all(|tile| tile.is_bare()),
    }
}

/// Change of a tile by a step.
#[derive(Clone, Debug)]
pub struct Change {
    /// The tile before it.
    pub before: TileRef,
    /// The tile after it.
    pub after: TileRef,
}

impl Change {
    /// The tile before it, 0, or after it, 1.
    #[must_use]
    pub fn end(&self, which: usize) -> &TileRef {
        match which {
            0 => &self.before,
            _ => &self.after,
        }
    }
}

/// Materials of a surface, as far as a step can change them. An unnamed model equals any.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SurfaceMaterial {
    /// The surface.
    pub surface: u32,
    /// Name of its ground.
    pub ground: String,
    /// Name of its tooth.
    pub tooth: String,
    /// Seed of the tooth.
    pub tooth_seed: u64,
    /// Its wells.
    pub wells: Vec<Well>,
    /// Name of the model of its paint; empty in documents from before a surface could have another one: that which it has.
    #[serde(default)]
    pub model: String,
}

impl PartialEq for SurfaceMaterial {
    fn eq(&self, other: &Self) -> bool {
        let is_model = self.model == other.model || self.model.is_empty() || other.model.is_empty();
        is_model
            && self.surface == other.surface
            && self.tooth_seed == other.tooth_seed
            && self.ground == other.ground
            && self.tooth == other.tooth
            && self.wells == other.wells
    }
}

/// Materials of the surfaces of a scene.
pub(crate) fn materials(scene: &Scene) -> Vec<SurfaceMaterial> {
    let surfaces = scene.surfaces.iter();
    surfaces
        .map(|surface| SurfaceMaterial {
            surface: surface.id,
            ground: surface.ground.clone(),
            tooth: surface.tooth.clone(),
            tooth_seed: surface.tooth_seed,
            wells: surface.wells.clone(),
            model: surface.model.clone(),
        })
        .collect()
}

/// Names the models of materials that do not.
pub(crate) fn name_models(materials: &mut [SurfaceMaterial], models: &BTreeMap<u32, &str>) -> bool {
    let mut named = false;
    for material in materials.iter_mut().filter(|own| own.model.is_empty()) {
        if let Some(model) = models.get(&material.surface) {
            (*model).clone_into(&mut material.model);
            named = true;
        }
    }
    named
}

/// State of a painting besides its tiles that a step can change.
#[derive(Clone, Debug, PartialEq)]
pub struct NonTileState {
    /// Loads of the brushes, by name.
    pub loads: BTreeMap<String, Page<BrushLoad>>,
    /// The books.
    pub ledger: Ledger,
    /// The dry layers.
    pub layers: Vec<Layer>,
    /// The surfaces.
    pub materials: Vec<SurfaceMaterial>,
    /// Most quanta that a cell of a surface ever had.
    pub tops: BTreeMap<u32, f32>,
}

/// Changes of a step besides tiles.
#[derive(Clone, Debug, Default)]
pub struct StepEffects {
    /// Loads of the brushes before and after it, where it changed them.
    pub loads: BTreeMap<String, [Page<BrushLoad>; 2]>,
    /// Paint that it booked.
    pub booked: Booked,
    /// The dry layers before and after it, if it changed them.
    pub layers: Option<[Vec<Layer>; 2]>,
    /// The surfaces before and after it, if it changed them.
    pub materials: Option<[Vec<SurfaceMaterial>; 2]>,
    /// Most quanta that a cell of a surface ever had, before and after it.
    pub tops: [BTreeMap<u32, f32>; 2],
}

impl StepEffects {
    /// The changes that lead from one state to another, with the paint booked in between.
    #[must_use]
    pub fn between(before: &NonTileState, after: &NonTileState, booked: Booked) -> Self {
        let changed = after.loads.iter().filter_map(|(name, page)| {
            let was = before.loads.get(name)?;
            (!was.is(page)).then(|| (name.clone(), [was.clone(), page.clone()]))
        });
        Self {
            loads: changed.collect(),
            booked,
            layers: (before.layers != after.layers)
                .then(|| [before.layers.clone(), after.layers.clone()]),
            materials: (before.materials != after.materials)
                .then(|| [before.materials.clone(), after.materials.clone()]),
            tops: [before.tops.clone(), after.tops.clone()],
        }
    }

    /// This and then `later` as one.
    pub(super) fn and(mut self, later: &Self) -> Self {
        for (name, [before, after]) in &later.loads {
            self.loads
                .entry(name.clone())
                .and_modify(|[_, merged]| *merged = after.clone())
                .or_insert_with(|| [before.clone(), after.clone()]);
        }
        self.booked.add(&later.booked);
        self.layers = joined(self.layers, later.layers.as_ref());
        self.materials = joined(self.materials, later.materials.as_ref());
        self.tops[1].clone_from(&later.tops[1]);
        self
    }
}

fn joined<T: Clone>(first: Option<[T; 2]>, second: Option<&[T; 2]>) -> Option<[T; 2]> {
    match (first, second) {
        (Some([before, _]), Some([_, after])) => Some([before, after.clone()]),
        (first, second) => first.or_else(|| second.cloned()),
    }
}

/// One operation of the painter, or several that were merged.
#[derive(Clone, Debug)]
pub struct Step {
    /// Its number; steps that ended later have higher ones.
    pub id: u64,
    /// Its name.
    pub what: StepName,
    /// Name of the brush that made it, if one did.
    pub brush: Option<String>,
    /// Number of operations.
    pub operations: u64,
    /// True if it is done; false if it was undone.
    pub done: bool,
    /// Changes of tiles.
    pub tiles: Arc<BTreeMap<TilePlace, Change>>,
    /// Its other changes.
    pub effects: Arc<StepEffects>,
}

impl Step {
    /// True if it changed anything that the other one changed.
    pub(super) fn lies_on(&self, other: &Self) -> bool {
        let changes = |change: &Change| !same(&change.before, &change.after);
        let (few, many) = if self.tiles.len() < other.tiles.len() {
            (&self.tiles, &other.tiles)
        } else {
            (&other.tiles, &self.tiles)
        };
        let mut tiles = few.iter();
        let mut loads = self.effects.loads.keys();
        tiles.any(|(place, change)| changes(change) && many.get(place).is_some_and(changes))
            || loads.any(|name| other.effects.loads.contains_key(name))
            || self.effects.layers.is_some() && other.effects.layers.is_some()
            || self.effects.materials.is_some() && other.effects.materials.is_some()
    }

    /// The step before it was finished, in a painting that is besides as it is in `rest`; `kept` is what its document
    /// has of it.
    #[must_use]
    pub(crate) fn reopened(self, rest: &NonTileState, kept: Option<&OpenStepSnapshot>) -> OpenStep {
        let mut before = rest.clone();
        for (name, [page, _]) in &self.effects.loads {
            before.loads.insert(name.clone(), page.clone());
        }
        if let Some([layers, _]) = &self.effects.layers {
            before.layers.clone_from(layers);
        }
        if let Some(kept) = kept {
            before.tops.clone_from(&kept.tops);
        }
        let reached = kept.into_iter().flat_map(|open| &open.reached);
        let reached = reached.map(|[surface, x, y]| (*surface, TileId { x: *x, y: *y }));
        let tiles = self.tiles.iter();
        OpenStep {
            id: self.id,
            what: self.what,
            brush: self.brush,
            tiles: tiles
                .map(|(place, change)| (*place, change.before.clone()))
                .collect(),
            before,
            booked: self.effects.booked.clone(),
            reached: reached.collect(),
            last_reach: None,
        }
    }
}

/// A step that is not finished.
#[derive(Clone, Debug)]
pub(crate) struct OpenStep {
    /// As [`Step::id`].
    pub id: u64,
    /// As [`Step::what`].
    pub what: StepName,
    /// As [`Step::brush`].
    pub brush: Option<String>,
    /// The tiles before it.
    pub tiles: BTreeMap<TilePlace, TileRef>,
    /// The rest before it.
    pub before: NonTileState,
    /// Paint booked so far.
    pub booked: Booked,
    /// The tiles that it may have changed.
    pub reached: BTreeSet<TilePlace>,
    /// The tiles that its last motion reached.
    pub last_reach: Option<(u32, TileRect)>,
}

impl OpenStep {
    /// The step as a document saves it.
    pub(crate) fn snapshot(&self) -> OpenStepSnapshot {
        let reached = self.reached.iter();
        OpenStepSnapshot {
            step: self.id,
            tops: self.before.tops.clone(),
            reached: reached
                .map(|(surface, id)| [*surface, id.x, id.y])
                .collect(),
        }
    }
}
