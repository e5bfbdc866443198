//! Undo and redo: steps as lists of tiles that are swapped.
//!
//! Steps are in order. Undone ones stay until the painter continues painting. Where the history exceeds its quota its
//! two oldest steps are merged, so that it goes back as far as before, in fewer steps; the newest sixteen stay
//! separate.

mod step;
mod walk;

pub use step::{
    Change, NonTileState, Step, StepEffects, SurfaceMaterial, TilePlace, TileRef, same,
};
pub(crate) use step::{OpenStep, materials, name_models};
pub use walk::ListedStep;
pub(crate) use walk::{Direction, placed};

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_canvas::page::Pager;
use maulstick_types::paint::StepName;

pub use crate::ledger::Booked;

/// Greatest size of a history, bytes, unless a painting sets another.
pub const QUOTA: u64 = 2 << 30;
/// The newest steps, which are never merged.
const SEPARATE_STEPS: usize = 16;

/// Steps that can be undone and redone.
#[derive(Debug)]
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
    /// True if any step, including dropped ones, changed more than brush loads, as of the newest checkpoint.
    changed_surfaces: bool,
    /// Most bytes of the pages that it holds.
    pub(crate) quota: u64,
}

impl Default for History {
    fn default() -> Self {
        Self::restored((0, Vec::new()), Vec::new(), Vec::new(), QUOTA)
    }
}

impl History {
    /// A saved history: number of the newest step and the undone steps, the finished steps, the open ones, and its
    /// limit in bytes.
    #[must_use]
    pub(crate) fn restored(
        (next, undone): (u64, Vec<u64>),
        steps: Vec<Step>,
        open: Vec<OpenStep>,
        quota: u64,
    ) -> Self {
        let steps = steps.into_iter().map(|step| (step.id, step));
        Self {
            next,
            open,
            steps: steps.collect(),
            undone,
            touched: BTreeSet::new(),
            part: 0,
            changed_surfaces: false,
            quota,
        }
    }

    /// True if any step has changed more than brush loads.
    #[must_use]
    pub(crate) fn has_changed_surfaces(&self) -> bool {
        let changes = |step: &Step| !step.tiles.is_empty() || step.effects.materials.is_some();
        self.changed_surfaces || !self.open.is_empty() || self.steps.values().any(changes)
    }

    /// Records that permanently: a checkpoint stores it, because a history that begins there has none of the steps.
    pub(crate) fn note_changed_surfaces(&mut self, has_changed: bool) {
        self.changed_surfaces = has_changed;
    }

    /// Begins a step; steps undone by this brush, or by none, are dropped.
    pub fn begin(&mut self, what: StepName, brush: Option<&str>, before: NonTileState) {
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
            what,
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

    /// Stores the tile that a step replaced, the first at each place.
    pub fn replaced(&mut self, brush: Option<&str>, place: TilePlace, tile: TileRef) {
        if let Some(open) = self.open_of(brush) {
            open.tiles.entry(place).or_insert(tile);
        }
    }

    /// Takes the unfinished steps selected by `which`, to be finished by [`push`](Self::push).
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

    /// The newest done step, of a brush or of all.
    #[must_use]
    pub(crate) fn last_done(&self, brush: Option<&str>) -> Option<&Step> {
        let of = |step: &&Step| brush.is_none() || step.brush.as_deref() == brush;
        let mut done = self.steps.values().rev().filter(|step| step.done);
        done.find(of)
    }

    /// The newest done step after another one that changed the same tiles.
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

    /// Marks a step as undone.
    pub fn undone(&mut self, id: u64) {
        if let Some(step) = self.steps.get_mut(&id) {
            step.done = false;
            self.touched.insert(id);
            self.undone.push(id);
        }
    }

    /// Marks a step as redone. It comes after all steps done meanwhile.
    pub fn redone(&mut self, id: u64) {
        self.undone.retain(|other| *other != id);
        let newest = self.last_done(None).map_or(0, |step| step.id);
        if let Some(mut step) = self.steps.remove(&id) {
            step.done = true;
            if id > newest {
                self.insert(step);
            } else {
                self.touched.insert(id);
                self.push(step);
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

    /// Names the models of surfaces in steps that do not: those of a document from before they could change.
    pub(crate) fn name_models(&mut self, models: &BTreeMap<u32, &str>) {
        for (id, step) in &mut self.steps {
            let ends = step.effects.materials.as_ref();
            let mut ends = ends.into_iter().flatten().flatten();
            if ends.any(|material| material.model.is_empty()) {
                let effects = Arc::make_mut(&mut step.effects);
                for materials in effects.materials.iter_mut().flatten() {
                    name_models(materials, models);
                }
                self.touched.insert(*id);
            }
        }
    }

    /// Forgets all steps.
    pub fn forget(&mut self) {
        self.open.clear();
        self.undone.clear();
        self.changed_surfaces = false;
        self.touched
            .extend(std::mem::take(&mut self.steps).into_keys());
    }

    /// Steps up to this one and later ones are never merged with each other; 0 for none.
    pub(crate) fn part_at(&mut self, id: u64) {
        self.part = id;
    }

    /// Merges the oldest steps until the history keeps to its quota, or only the newest are left; `besides` is the
    /// bytes of `pager` outside of the history.
    pub(crate) fn keep_to_quota(&mut self, pager: &Pager, besides: impl FnOnce() -> u64) {
        if pager.counts().held() <= self.quota {
            return;
        }
        let besides = besides();
        while pager.counts().held().saturating_sub(besides) > self.quota && self.merge_oldest() {}
    }

    /// Merges the two oldest neighbouring steps that can be merged; of undone ones the oldest is dropped. False where
    /// only the newest are left, which stay separate.
    pub(crate) fn merge_oldest(&mut self) -> bool {
        let mergeable = self.steps.len().saturating_sub(SEPARATE_STEPS);
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
            what: StepName::Merged { count: operations },
            brush: first
                .brush
                .filter(|brush| second.brush.as_ref() == Some(brush)),
            operations,
            done: true,
            tiles: Arc::new(tiles),
            effects: Arc::new(Arc::unwrap_or_clone(first.effects).and(&second.effects)),
        });
    }

    /// Drops undone steps, and those undone before them that share tiles with them: they could be redone only on top of
    /// them.
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
