//! Undo and redo: steps as lists of tiles that are swapped.
//!
//! Steps stand in their order. Undone ones stay until the painter goes on painting. Where the history
//! takes too much room its oldest two steps become one, so that it goes back as far as before, in
//! fewer steps; the newest sixteen stay apart.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_canvas::page::Page;
use maulstick_canvas::store::TileRect;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_model::brush::load::BrushLoad;
use maulstick_types::scene::Layer;
use serde::{Deserialize, Serialize};

pub use crate::ledger::Booked;
use crate::ledger::Ledger;

/// Bytes of a history at most, unless a painting says otherwise.
pub const QUOTA: u64 = 2 << 30;
/// The newest steps, which are never merged.
const APART: usize = 16;

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

/// Materials of a surface, as far as a step can change them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceMaterial {
    /// The surface.
    pub surface: u32,
    /// Name of its ground.
    pub ground: String,
    /// Name of its tooth.
    pub tooth: String,
    /// Seed of the tooth.
    pub tooth_seed: u64,
}

/// State of a painting besides its tiles, as far as a step can change it.
#[derive(Clone, Debug, PartialEq)]
pub struct NonTileState {
    /// Loads of the brushes, by name.
    pub loads: BTreeMap<String, Page<BrushLoad>>,
    /// The books.
    pub ledger: Ledger,
    /// The dry layers.
    pub layers: Vec<Layer>,
    /// The surfaces.
    pub makes: Vec<SurfaceMaterial>,
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
    pub makes: Option<[Vec<SurfaceMaterial>; 2]>,
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
            makes: (before.makes != after.makes)
                .then(|| [before.makes.clone(), after.makes.clone()]),
            tops: [before.tops.clone(), after.tops.clone()],
        }
    }

    /// This and then `later` as one.
    fn and(mut self, later: &Self) -> Self {
        for (name, [before, after]) in &later.loads {
            self.loads
                .entry(name.clone())
                .and_modify(|[_, merged]| *merged = after.clone())
                .or_insert_with(|| [before.clone(), after.clone()]);
        }
        self.booked.add(&later.booked);
        self.layers = joined(self.layers, later.layers.as_ref());
        self.makes = joined(self.makes, later.makes.as_ref());
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
    /// Description in words.
    pub what: String,
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
    fn lies_on(&self, other: &Self) -> bool {
        let changes = |change: &Change| !same(&change.before, &change.after);
        let (few, many) = match self.tiles.len() < other.tiles.len() {
            true => (&self.tiles, &other.tiles),
            false => (&other.tiles, &self.tiles),
        };
        let mut tiles = few.iter();
        let mut loads = self.effects.loads.keys();
        tiles.any(|(place, change)| changes(change) && many.get(place).is_some_and(changes))
            || loads.any(|name| other.effects.loads.contains_key(name))
            || self.effects.layers.is_some() && other.effects.layers.is_some()
            || self.effects.makes.is_some() && other.effects.makes.is_some()
    }

    /// The step before it was finished, in a painting that is besides as it is in `rest`.
    #[must_use]
    pub(crate) fn reopened(self, rest: &NonTileState, reached: BTreeSet<TilePlace>) -> OpenStep {
        let mut before = rest.clone();
        for (name, [page, _]) in &self.effects.loads {
            before.loads.insert(name.clone(), page.clone());
        }
        if let Some([layers, _]) = &self.effects.layers {
            before.layers.clone_from(layers);
        }
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
            reached,
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
    pub what: String,
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

/// Steps that can be undone and redone.
#[derive(Debug, Default)]
pub struct History {
    next: u64,
    /// Steps that are not finished: each painter's own, none touching a tile of another.
    open: Vec<OpenStep>,
    steps: BTreeMap<u64, Step>,
    /// Steps that were undone, the last one at the end.
    undone: Vec<u64>,
    /// Steps that changed, came or went since the last query.
    touched: BTreeSet<u64>,
    /// See [`part_at`](Self::part_at).
    part: u64,
}

impl History {
    /// A saved history, with the steps still open.
    #[must_use]
    pub(crate) fn restored(
        next: u64,
        steps: Vec<Step>,
        undone: Vec<u64>,
        open: Vec<OpenStep>,
    ) -> Self {
        let steps = steps.into_iter().map(|step| (step.id, step));
        Self {
            next,
            open,
            steps: steps.collect(),
            undone,
            touched: BTreeSet::new(),
            part: 0,
        }
    }

    /// Begins a step; steps undone by this brush, or by none, are dropped.
    pub fn begin(&mut self, what: &str, brush: Option<&str>, before: NonTileState) {
        let own = |step: &Step| match (&step.brush, brush) {
            (Some(one), Some(other)) => one == other,
            _ => true,
        };
        let undone = self.undone.iter().filter_map(|id| self.steps.get(id));
        let gone = undone.filter(|step| own(step)).map(|step| step.id);
        let gone = gone.collect();
        self.drop_undone(gone);
        self.next += 1;
        self.open.push(OpenStep {
            id: self.next,
            what: what.to_owned(),
            brush: brush.map(str::to_owned),
            tiles: BTreeMap::new(),
            before,
            booked: Booked::default(),
            reached: BTreeSet::new(),
            last_reach: None,
        });
    }

    /// The steps that are not finished.
    pub(crate) fn open(&self) -> impl Iterator<Item = &OpenStep> {
        self.open.iter()
    }

    /// The step of a brush, or of none, that is not finished.
    pub(crate) fn open_of(&mut self, brush: Option<&str>) -> Option<&mut OpenStep> {
        let mut open = self.open.iter_mut();
        open.find(|step| step.brush.as_deref() == brush)
    }

    /// Remembers what a step replaced: the first tile of each place.
    pub fn replaced(&mut self, brush: Option<&str>, place: TilePlace, tile: TileRef) {
        if let Some(open) = self.open_of(brush) {
            open.tiles.entry(place).or_insert(tile);
        }
    }

    /// Takes the steps that are not finished and of which `which` says so, to be finished by
    /// [`push`](Self::push).
    pub(crate) fn take_open(&mut self, which: impl Fn(&OpenStep) -> bool) -> Vec<OpenStep> {
        let (taken, left) = std::mem::take(&mut self.open).into_iter().partition(which);
        self.open = left;
        taken
    }

    /// Adds a step that has just ended. It comes after all that ended before it, whenever it began: it may overlap them
    /// from above, they never it.
    pub fn push(&mut self, mut step: Step) {
        self.touched.insert(step.id);
        self.next += 1;
        step.id = self.next;
        self.insert(step);
    }

    fn insert(&mut self, step: Step) {
        self.touched.insert(step.id);
        self.steps.insert(step.id, step);
    }

    /// The newest step that is done, of a brush or of all.
    #[must_use]
    pub(crate) fn last_done(&self, brush: Option<&str>) -> Option<&Step> {
        let of = |step: &&Step| brush.is_none() || step.brush.as_deref() == brush;
        let mut done = self.steps.values().rev().filter(|step| step.done);
        done.find(of)
    }

    /// The newest step that is done and came after another one, on what that changed.
    #[must_use]
    pub(crate) fn later_on(&self, step: &Step) -> Option<&Step> {
        let later = self
            .steps
            .range(step.id + 1..)
            .rev()
            .map(|(_, later)| later);
        let mut done = later.filter(|later| later.done);
        done.find(|later| later.lies_on(step))
    }

    /// The step that was undone last, of a brush or of all.
    #[must_use]
    pub(crate) fn last_undone(&self, brush: Option<&str>) -> Option<&Step> {
        let of = |step: &&Step| brush.is_none() || step.brush.as_deref() == brush;
        let undone = self.undone.iter().rev();
        undone.filter_map(|id| self.steps.get(id)).find(of)
    }

    /// Notes that a step was undone.
    pub fn undone(&mut self, id: u64) {
        if let Some(step) = self.steps.get_mut(&id) {
            step.done = false;
            self.touched.insert(id);
            self.undone.push(id);
        }
    }

    /// Notes that a step was done again. It comes after all that was done meanwhile.
    pub fn redone(&mut self, id: u64) {
        self.undone.retain(|other| *other != id);
        let newest = self.last_done(None).map_or(0, |step| step.id);
        if let Some(mut step) = self.steps.remove(&id) {
            step.done = true;
            match id > newest {
                true => self.insert(step),
                false => {
                    self.touched.insert(id);
                    self.push(step);
                }
            }
        }
    }

    /// Numbers of steps that can be undone and redone.
    #[must_use]
    pub fn depth(&self) -> (usize, usize) {
        let done = self.steps.len() - self.undone.len();
        (done + self.open.len(), self.undone.len())
    }

    /// Operations that the oldest step holds: more than one where steps were merged.
    #[must_use]
    pub fn merged(&self) -> u64 {
        self.steps.values().next().map_or(0, |step| step.operations)
    }

    /// The steps, the oldest first.
    pub fn steps(&self) -> impl Iterator<Item = &Step> {
        self.steps.values()
    }

    /// Number of the newest step, and the steps that were undone, the last one at the end.
    #[must_use]
    pub fn position(&self) -> (u64, &[u64]) {
        (self.next, &self.undone)
    }

    /// The steps that changed or came since the last call, and those that went.
    pub(crate) fn take_touched(&mut self) -> (Vec<Step>, Vec<u64>) {
        let (mut there, mut gone) = (Vec::new(), Vec::new());
        for id in std::mem::take(&mut self.touched) {
            match self.steps.get(&id) {
                Some(step) => there.push(step.clone()),
                None => gone.push(id),
            }
        }
        (there, gone)
    }

    /// Counts all steps as changed.
    pub(crate) fn touch_all(&mut self) {
        self.touched.extend(self.steps.keys());
    }

    /// Forgets all steps.
    pub fn forget(&mut self) {
        self.open.clear();
        self.undone.clear();
        self.touched
            .extend(std::mem::take(&mut self.steps).into_keys());
    }

    /// Steps up to this one and later ones are never merged with each other; 0 for none.
    pub(crate) fn part_at(&mut self, id: u64) {
        self.part = id;
    }

    /// Makes one step of the two oldest neighbours that may become one; of undone ones the oldest goes.
    /// False where only the newest are left, which stay apart.
    pub(crate) fn merge_oldest(&mut self) -> bool {
        let mergeable = self.steps.len().saturating_sub(APART);
        let ids: Vec<u64> = self.steps.keys().take(mergeable + 1).copied().collect();
        let parts = |one: u64, other: u64| one <= self.part && self.part < other;
        let pair = ids.windows(2).find(|pair| !parts(pair[0], pair[1]));
        let Some(&[first, second]) = pair.filter(|_| mergeable > 0) else {
            return false;
        };
        let undone = [first, second]
            .into_iter()
            .find(|id| self.steps.get(id).is_some_and(|step| !step.done));
        match undone {
            Some(id) => self.drop_undone(BTreeSet::from([id])),
            None => self.merge(first, second),
        }
        true
    }

    fn merge(&mut self, gone: u64, id: u64) {
        let (Some(first), Some(second)) = (self.steps.remove(&gone), self.steps.remove(&id)) else {
            return;
        };
        let operations = first.operations + second.operations;
        let mut tiles = Arc::unwrap_or_clone(first.tiles);
        for (place, change) in &*second.tiles {
            tiles
                .entry(*place)
                .and_modify(|merged| merged.after.clone_from(&change.after))
                .or_insert_with(|| change.clone());
        }
        self.touched.insert(gone);
        self.insert(Step {
            id,
            what: format!("{operations} steps"),
            brush: first
                .brush
                .filter(|brush| second.brush.as_ref() == Some(brush)),
            operations,
            done: true,
            tiles: Arc::new(tiles),
            effects: Arc::new(Arc::unwrap_or_clone(first.effects).and(&second.effects)),
        });
    }

    /// Drops undone steps, and those that were undone before them and share tiles with them: they could be redone only
    /// on top of them.
    fn drop_undone(&mut self, mut gone: BTreeSet<u64>) {
        let mut lost: BTreeSet<TilePlace> = BTreeSet::new();
        for id in self.undone.iter().rev() {
            let Some(step) = self.steps.get(id) else {
                continue;
            };
            let rests = step.tiles.keys().any(|place| lost.contains(place));
            if rests || gone.contains(id) {
                gone.insert(*id);
                lost.extend(step.tiles.keys());
            }
        }
        self.undone.retain(|id| !gone.contains(id));
        self.steps.retain(|id, _| !gone.contains(id));
        self.touched.extend(gone);
    }
}
