//! Undo and redo.

mod steps;
pub(crate) mod versions;

use maulstick_canvas::EditError;
use maulstick_types::paint::StepName;
use maulstick_types::scene::{Layer, Scene};

use super::Painting;
use crate::history::{Direction, History, OpenStep, Step, SurfaceMaterial, same};

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

impl Painting {
    /// Undoes the newest step, of a brush or of all, and returns its name.
    ///
    /// # Errors [`EditError`] if there is no step, or later paint covers it; the painting is then unchanged.
    pub fn undo(&mut self, brush: Option<&str>) -> Result<StepName, EditError> {
        if let Some(brush) = brush {
            self.brushes.at(brush)?;
        }
        self.commit();
        let own = |step: &OpenStep| brush.is_none() || step.brush.as_deref() == brush;
        // Nothing covers an unfinished step.
        if !self.history.open().any(own) {
            let step = self
                .history
                .last_done(brush)
                .ok_or_else(|| EditError::NothingToUndo(brush.map(str::to_owned)))?;
            self.check(step, Direction::Undo)?;
        }
        self.end_step(|_| true);
        Ok(match self.history.last_done(brush).cloned() {
            Some(step) => self.walk(&step, Direction::Undo),
            None => StepName::Beginning,
        })
    }

    /// The newest step that is done; steps that end later have higher numbers.
    pub fn newest_step(&mut self) -> u64 {
        self.end_step(|_| true);
        self.history.last_done(None).map_or(0, |step| step.id)
    }

    /// Undoes all steps of a brush after the one with this number.
    ///
    /// # Errors As [`undo`](Self::undo).
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

    /// Redoes the newest undone step, of a brush or of all, and returns its name.
    ///
    /// # Errors As [`undo`](Self::undo).
    pub fn redo(&mut self, brush: Option<&str>) -> Result<StepName, EditError> {
        if let Some(brush) = brush {
            self.brushes.at(brush)?;
        }
        self.commit();
        let step = self.history.last_undone(brush).cloned();
        let step = step.ok_or(EditError::NothingToRedo)?;
        self.check(&step, Direction::Redo)?;
        self.end_step(|_| true);
        Ok(self.walk(&step, Direction::Redo))
    }

    /// Undoes or redoes steps until the one with this number is the newest done one, 0 for none, and returns its name.
    ///
    /// # Errors [`EditError`] for an unknown step, and where later paint covers one of them; the painting is then
    /// unchanged.
    pub fn go_to(&mut self, step: u64) -> Result<StepName, EditError> {
        let open = self.history.open().find(|open| open.id == step);
        if let Some(what) = open.map(|open| open.what.clone()) {
            // Unfinished steps do not count as newer.
            return Ok(what);
        }
        let way = self.history.way_to(step).ok_or(EditError::NoStep)?;
        let way: Vec<Direction> = way.into_iter().map(|(way, _)| way).collect();
        let way: Vec<Direction> = match way.first() {
            Some(Direction::Redo) => way,
            _ => {
                let open = self.history.open().map(|_| Direction::Undo);
                open.chain(way).collect()
            }
        };
        let mut gone = Vec::new();
        for way in way {
            let went = match way {
                Direction::Undo => self.undo(None),
                Direction::Redo => self.redo(None),
            };
            if let Err(error) = went {
                // Back along the same steps, which nothing covers. No message describes the remaining effects: stopped
                // dryings, ended steps.
                self.break_record();
                for way in gone.into_iter().rev() {
                    drop(match way {
                        Direction::Undo => self.redo(None),
                        Direction::Redo => self.undo(None),
                    });
                }
                return Err(error);
            }
            gone.push(way);
        }
        if step > 0 {
            self.record.go_to(step);
        }
        let newest = self.history.last_done(None);
        Ok(newest.map_or(StepName::Beginning, |step| step.what.clone()))
    }

    /// Sees that all is as the step left it, or found it.
    fn check(&self, step: &Step, way: Direction) -> Result<(), EditError> {
        let from = way.ends()[0];
        let effects = &step.effects;
        let mut tiles = step.tiles.iter();
        let over =
            tiles.any(|(place, change)| !same(&self.surfaces.tile(*place), change.end(from)));
        let mut loads = effects.loads.iter();
        // A brush that is gone is no hindrance.
        let other_load = loads.any(|(name, pages)| {
            let brush = self.brushes.find(name);
            brush.is_some_and(|brush| !brush.carries(&pages[from]))
        });
        let (layers, made) = (effects.layers.as_ref(), effects.materials.as_ref());
        let other_rest = layers.is_some_and(|ends| ends[from] != self.scene.layers)
            || made.is_some_and(|ends| ends[from] != materials(&self.scene));
        let other_books = !self.accounts.ledger.can_book(&effects.booked, way.times());
        // A later step may have led back to the tiles of this one, like a return to a version.
        let later = match way {
            Direction::Undo => self.history.later_on(step),
            Direction::Redo => None,
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

    /// Undoes or redoes a checked step.
    fn walk(&mut self, step: &Step, way: Direction) -> StepName {
        let to = way.ends()[1];
        let effects = &step.effects;
        // A drying would undo this.
        self.clock.stop(None);
        self.record.move_to(step);
        for (place, change) in &*step.tiles {
            self.surfaces.put(*place, change.end(to).clone());
        }
        for (name, pages) in &effects.loads {
            if let Some(brush) = self.brushes.find_mut(name) {
                brush.carry(&pages[to]);
            }
        }
        self.accounts.book(&effects.booked, way.times());
        let (layers, made) = (effects.layers.as_ref(), effects.materials.as_ref());
        self.turn_non_tile_state(layers.map(|ends| &ends[to]), made.map(|ends| &ends[to]));
        self.turn_tops(step, way);
        match way {
            Direction::Undo => self.history.undone(step.id),
            Direction::Redo => self.history.redone(step.id),
        }
        step.what.clone()
    }

    /// Restores the height of the paint where no other paint was added meanwhile, so that the same motion paints the
    /// same again.
    fn turn_tops(&mut self, step: &Step, way: Direction) {
        let newest = self.history.last_done(None).map_or(0, |newest| newest.id);
        let [before, after] = &step.effects.tops;
        let (from, to) = match way {
            Direction::Undo if step.id == newest => (after, before),
            Direction::Redo if step.id > newest => (before, after),
            _ => return,
        };
        for surface in self.surfaces.iter_mut() {
            if from.get(&surface.id) == Some(&surface.top)
                && let Some(top) = to.get(&surface.id)
            {
                surface.top = *top;
            }
        }
    }

    /// Replaces layers and surfaces by the given state.
    pub(crate) fn turn_non_tile_state(
        &mut self,
        layers: Option<&Vec<Layer>>,
        materials: Option<&Vec<SurfaceMaterial>>,
    ) {
        if let Some(layers) = layers {
            self.scene.layers.clone_from(layers);
            self.layers_changed();
        }
        if let Some(materials) = materials {
            self.set_materials(materials);
        }
    }

    /// Numbers of steps that can be undone and redone.
    #[must_use]
    pub fn history_depth(&self) -> (usize, usize) {
        self.history.depth()
    }

    /// The steps of the past.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Drops all steps, none of which can be undone any more.
    pub fn forget_history(&mut self) {
        self.end_step(|_| true);
        self.history.forget();
        self.break_record();
    }

    /// Merges the oldest steps until all pages take at most `resident` bytes in memory, or only the newest steps are
    /// left, for a painting without a document for its new pages.
    pub fn merge_history(&mut self, resident: usize) {
        while self.bytes() > resident && self.history.merge_oldest() {}
    }

    /// Limit of the history, bytes; beyond that its oldest steps are merged.
    pub fn set_quota(&mut self, bytes: u64) {
        self.history.quota = bytes;
        self.keep_to_quota();
    }
}
