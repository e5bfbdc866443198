//! Undo and redo.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use maulstick_brush::Head;
use maulstick_canvas::EditError;
use maulstick_canvas::page::Page;
use maulstick_canvas::tile::Version;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_types::edits::{Redo, Undo};
use maulstick_types::scene::{Layer, Scene};

use super::Painting;
use super::backend::Deferral;
use crate::apply::{Applied, Apply};
use crate::history::{
    Change, NonTileState, OpenStep, Step, StepEffects, SurfaceMaterial, TilePlace, TileRef, same,
};

/// Direction of a step: undo or redo.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Back,
    Forth,
}

impl Way {
    /// The end that a step is taken from, and the one that it is taken to.
    fn ends(self) -> [usize; 2] {
        match self {
            Self::Back => [1, 0],
            Self::Forth => [0, 1],
        }
    }

    /// Factor on its bookings.
    fn times(self) -> i64 {
        match self {
            Self::Back => -1,
            Self::Forth => 1,
        }
    }
}

/// Materials of the surfaces of a scene.
pub(super) fn makes(scene: &Scene) -> Vec<SurfaceMaterial> {
    let surfaces = scene.surfaces.iter();
    surfaces
        .map(|surface| SurfaceMaterial {
            surface: surface.id,
            ground: surface.ground.clone(),
            tooth: surface.tooth.clone(),
            tooth_seed: surface.tooth_seed,
        })
        .collect()
}

impl Apply for Undo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.undo(self.brush.as_deref()).map(Applied::Step)
    }
}

impl Apply for Redo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.redo(self.brush.as_deref()).map(Applied::Step)
    }
}

impl Painting {
    pub(super) fn rest(&mut self) -> NonTileState {
        let mut loads = BTreeMap::new();
        for (name, track) in &mut self.brushes {
            let kept = track.kept.as_ref();
            let page = match kept.filter(|(content, _)| Arc::ptr_eq(content, &track.load)) {
                Some((_, page)) => page.clone(),
                None => {
                    let before = kept.map(|(_, page)| page);
                    let page = Page::new(&self.pager, Arc::clone(&track.load), before);
                    track.kept = Some((Arc::clone(&track.load), page.clone()));
                    page
                }
            };
            loads.insert(name.clone(), page);
        }
        NonTileState {
            loads,
            ledger: self.ledger.clone(),
            layers: self.scene.layers.clone(),
            makes: makes(&self.scene),
            tops: self
                .sheets
                .iter()
                .map(|sheet| (sheet.id, sheet.top))
                .collect(),
        }
    }

    /// Begins a step of a brush, or of none: one for all who paint, then.
    pub(super) fn begin_step(&mut self, what: &str, brush: Option<&str>) {
        self.book(brush);
        match brush {
            // A step of nobody's that is open here is a drying's: it is parted by what comes between.
            Some(brush) => {
                self.end_step(|step| step.brush.is_none() || step.brush.as_deref() == Some(brush))
            }
            None => self.end_step(|_| true),
        }
        let rest = self.rest();
        self.history.begin(what, brush, rest);
    }

    /// Ends the open steps of which `which` says so.
    pub(super) fn end_step(&mut self, which: impl Fn(&OpenStep) -> bool) {
        self.close_windows();
        let after = self.rest();
        let ended = self.history.take_open(which);
        let ends = !ended.is_empty();
        for open in ended {
            let step = self.finished(&open, &after);
            self.history.push(step);
        }
        if ends {
            self.keep_to_quota();
        }
    }

    /// Ends the open step that belongs to no brush.
    pub(super) fn end_own_step(&mut self) {
        self.end_step(|step| step.brush.is_none());
    }

    /// Books what was booked since the last call for the step of a brush, or of none.
    pub(super) fn book(&mut self, brush: Option<&str>) {
        let booked = self.ledger.since(&self.accounted);
        self.accounted = self.ledger.clone();
        if let Some(open) = self.history.open_of(brush) {
            open.booked.add(&booked);
        }
    }

    /// A step as it is if it ends now. A brush's step leaves what other brushes carry alone.
    pub(super) fn finished(&self, open: &OpenStep, after: &NonTileState) -> Step {
        let tiles = open.tiles.iter().map(|(place, before)| {
            let change = Change {
                before: before.clone(),
                after: self.held(*place),
            };
            (*place, change)
        });
        let mut effects = StepEffects::between(&open.before, after, open.booked.clone());
        if let Some(brush) = &open.brush {
            effects.loads.retain(|name, _| name == brush);
            (effects.layers, effects.makes) = (None, None);
        }
        Step {
            id: open.id,
            what: open.what.clone(),
            brush: open.brush.clone(),
            operations: 1,
            done: true,
            tiles: Arc::new(tiles.collect()),
            effects: Arc::new(effects),
        }
    }

    /// The steps that are not finished, as they are if they end now.
    pub(super) fn open_steps(&mut self) -> Vec<Step> {
        let after = self.rest();
        let open = self.history.open();
        open.map(|open| self.finished(open, &after)).collect()
    }

    /// Current content of a tile.
    pub(super) fn held(&self, (surface, id): TilePlace) -> TileRef {
        self.sheet(surface)?.store.version(id).tile.clone()
    }

    /// Undoes the newest step, of a brush or of all, and returns its description.
    ///
    /// # Errors
    /// [`EditError`] if there is no step, or something was painted over it since: then nothing has changed.
    pub fn undo(&mut self, brush: Option<&str>) -> Result<String, EditError> {
        if let Some(brush) = brush {
            self.brush(brush)?;
        }
        self.commit();
        let own = |step: &OpenStep| brush.is_none() || step.brush.as_deref() == brush;
        // Nothing lies over a step that is not finished.
        if !self.history.open().any(own) {
            let step = self
                .history
                .last_done(brush)
                .ok_or_else(|| EditError::NothingToUndo(brush.map(str::to_owned)))?;
            self.check(step, Way::Back)?;
        }
        self.end_step(|_| true);
        match self.history.last_done(brush).cloned() {
            Some(step) => Ok(self.walk(&step, Way::Back)),
            None => Ok(String::new()),
        }
    }

    /// The newest step that is done; steps that end later have higher numbers.
    pub fn newest_step(&mut self) -> u64 {
        self.end_step(|_| true);
        self.history.last_done(None).map_or(0, |step| step.id)
    }

    /// Takes back all steps of a brush that came after the one with this number.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn undo_to(&mut self, brush: &str, step: u64) -> Result<(), EditError> {
        self.end_step(|_| true);
        let later = |own: &Step| own.id > step;
        while self.history.last_done(Some(brush)).is_some_and(later) {
            self.undo(Some(brush))?;
        }
        Ok(())
    }

    /// Steps up to this one and later ones are never merged with each other.
    pub fn part_history(&mut self, step: u64) {
        self.history.part_at(step);
    }

    /// Does the newest undone step again, of a brush or of all, and says what it was.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn redo(&mut self, brush: Option<&str>) -> Result<String, EditError> {
        if let Some(brush) = brush {
            self.brush(brush)?;
        }
        self.commit();
        let step = self.history.last_undone(brush).cloned();
        let step = step.ok_or(EditError::NothingToRedo)?;
        self.check(&step, Way::Forth)?;
        self.end_step(|_| true);
        Ok(self.walk(&step, Way::Forth))
    }

    /// Sees that all is as the step left it, or found it.
    fn check(&self, step: &Step, way: Way) -> Result<(), EditError> {
        let from = way.ends()[0];
        let effects = &step.effects;
        let mut tiles = step.tiles.iter();
        let over = tiles.any(|(place, change)| !same(&self.held(*place), change.end(from)));
        let mut loads = effects.loads.iter();
        let other_load = loads.any(|(name, pages)| !self.carries(name, &pages[from]));
        let (layers, made) = (effects.layers.as_ref(), effects.makes.as_ref());
        let other_rest = layers.is_some_and(|ends| ends[from] != self.scene.layers)
            || made.is_some_and(|ends| ends[from] != makes(&self.scene));
        let other_books = !self.ledger.can_book(&effects.booked, way.times());
        // A later step may have led back to what this one left, as a return to a version does.
        let later = match way {
            Way::Back => self.history.later_on(step),
            Way::Forth => None,
        };
        if later.is_none() && !over && !other_load && !other_rest && !other_books {
            return Ok(());
        }
        let other = later.or_else(|| self.history.last_done(None));
        Err(EditError::Covered {
            what: step.what.clone(),
            over: other.map(|step| step.what.clone()),
        })
    }

    /// Takes a step back, or forth; it was checked.
    fn walk(&mut self, step: &Step, way: Way) -> String {
        let to = way.ends()[1];
        let effects = &step.effects;
        // Time would do again what is taken back.
        self.let_stay_wet(None);
        for (place, change) in &*step.tiles {
            self.put(*place, change.end(to).clone());
        }
        for (name, pages) in &effects.loads {
            self.carry(name, &pages[to]);
        }
        self.ledger.book(&effects.booked, way.times());
        self.accounted = self.ledger.clone();
        let (layers, made) = (effects.layers.as_ref(), effects.makes.as_ref());
        self.turn_rest(layers.map(|ends| &ends[to]), made.map(|ends| &ends[to]));
        self.turn_tops(step, way);
        match way {
            Way::Back => self.history.undone(step.id),
            Way::Forth => self.history.redone(step.id),
        }
        step.what.clone()
    }

    /// Restores the height of the paint where nothing else was painted meanwhile: then the same motion paints the same
    /// again.
    fn turn_tops(&mut self, step: &Step, way: Way) {
        let newest = self.history.last_done(None).map_or(0, |newest| newest.id);
        let [before, after] = &step.effects.tops;
        let (from, to) = match way {
            Way::Back if step.id == newest => (after, before),
            Way::Forth if step.id > newest => (before, after),
            _ => return,
        };
        for sheet in &mut self.sheets {
            if from.get(&sheet.id) == Some(&sheet.top)
                && let Some(top) = to.get(&sheet.id)
            {
                sheet.top = *top;
            }
        }
    }

    /// True if a brush carries the load of a page; always true for a brush that is gone.
    fn carries(&self, name: &str, page: &Page<BrushLoad>) -> bool {
        self.brushes.get(name).is_none_or(|track| {
            let kept = track.kept.as_ref();
            kept.is_some_and(|(load, kept)| kept.is(page) && Arc::ptr_eq(load, &track.load))
                || track.load.counts() == page.get().counts()
        })
    }

    /// Has a brush carry what is on a page.
    pub(super) fn carry(&mut self, name: &str, page: &Page<BrushLoad>) {
        let Some(track) = self.brushes.get_mut(name) else {
            return;
        };
        let load = page.get();
        track.path = None;
        track.deferral = Deferral::default();
        if load.texels() == track.load.texels() {
            track.load = Arc::clone(&load);
            track.kept = Some((load, page.clone()));
        } else {
            let thinned = track.file.thinned_to(load.texels() / TEXELS_PER_STRIP);
            let head = Head::of(&thinned);
            if head.strips() * TEXELS_PER_STRIP == load.texels() {
                (track.thinned, track.tidy) = (thinned, Arc::new(head));
                track.head = track.disordered();
                track.load = Arc::clone(&load);
                track.kept = Some((load, page.clone()));
            } else {
                track.load = Arc::new(load.onto(track.tidy.strips(), &track.tidy));
                track.kept = None;
            }
        }
    }

    /// Puts a tile in the place of another.
    pub(super) fn put(&mut self, (surface, id): TilePlace, tile: TileRef) -> TileRef {
        self.versions += 1;
        let number = self.versions;
        let sheet = self.sheets.iter_mut().find(|sheet| sheet.id == surface)?;
        sheet.store.replace(id, Version { number, tile }).tile
    }

    /// Makes layers and surfaces what they are to be.
    pub(super) fn turn_rest(
        &mut self,
        layers: Option<&Vec<Layer>>,
        makes: Option<&Vec<SurfaceMaterial>>,
    ) {
        if let Some(layers) = layers {
            self.scene.layers.clone_from(layers);
            self.layers_changed();
        }
        if let Some(makes) = makes {
            self.remake(makes);
        }
    }

    /// Numbers of steps that can be undone and redone.
    #[must_use]
    pub fn history_depth(&self) -> (usize, usize) {
        self.history.depth()
    }

    /// The steps of the past.
    #[must_use]
    pub fn history(&self) -> &crate::history::History {
        &self.history
    }

    /// Forgets all steps: nothing of before can be undone.
    pub fn forget_history(&mut self) {
        self.end_step(|_| true);
        self.history.forget();
    }

    /// Limit of the history, bytes; beyond that its oldest steps are merged.
    pub fn set_quota(&mut self, bytes: u64) {
        self.quota = bytes;
        self.keep_to_quota();
    }

    /// Merges the oldest steps until the history keeps to its quota, or only the newest are apart.
    fn keep_to_quota(&mut self) {
        if self.pager.counts().held() <= self.quota {
            return;
        }
        let other = self.held_besides_history();
        while self.pager.counts().held().saturating_sub(other) > self.quota
            && self.history.merge_oldest()
        {}
    }

    /// Bytes of the tiles that are shown, and of versions.
    fn held_besides_history(&self) -> u64 {
        let shown = self.sheets.iter().flat_map(|sheet| sheet.store.iter());
        let shown = shown.filter_map(|(_, version)| version.tile.as_ref());
        let named = self.named.values().flat_map(|named| named.tiles.values());
        let mut counted = HashSet::new();
        let pages = shown.chain(named.flatten()).flat_map(|tile| tile.pages());
        let once = pages.filter(|page| counted.insert(page.id()));
        once.map(|page| page.held_bytes() as u64).sum()
    }
}
