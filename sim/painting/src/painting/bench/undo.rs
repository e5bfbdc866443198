//! Undo and redo.

use maulstick_types::paint::StepName;

use super::Workbench;
use crate::clock::Clock;
use crate::error::{EditError, HistoryError};
use crate::history::{Direction, OpenStep, Step, materials, same};

impl Workbench {
    /// Undoes the newest step, of a brush or of all, and returns its name.
    ///
    /// # Errors
    /// [`EditError`] if there is no step, or something was painted over it since: then nothing has changed.
    pub(crate) fn undo(
        &mut self,
        clock: &mut Clock,
        brush: Option<&str>,
    ) -> Result<StepName, EditError> {
        if let Some(brush) = brush {
            self.brushes.at(brush)?;
        }
        self.commit();
        let own = |step: &OpenStep| brush.is_none() || step.brush.as_deref() == brush;
        // Nothing lies over a step that is not finished.
        if !self.past.history.open().any(own) {
            let step = self.past.history.last_done(brush);
            let nothing = || HistoryError::NothingToUndo(brush.map(str::to_owned));
            let step = step.ok_or_else(nothing)?;
            self.check(step, Direction::Undo)?;
        }
        self.end_step(|_| true);
        Ok(match self.past.history.last_done(brush).cloned() {
            Some(step) => self.walk(clock, &step, Direction::Undo),
            None => StepName::Beginning,
        })
    }

    /// The newest step that is done; steps that end later have higher numbers.
    pub(crate) fn newest_step(&mut self) -> u64 {
        self.end_step(|_| true);
        self.past.history.last_done(None).map_or(0, |step| step.id)
    }

    /// Undoes all steps of a brush after the one with this number.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub(crate) fn undo_to(
        &mut self,
        clock: &mut Clock,
        brush: &str,
        step: u64,
    ) -> Result<(), EditError> {
        self.end_step(|_| true);
        let later = |own: &Step| own.id > step;
        while self.past.history.last_done(Some(brush)).is_some_and(later) {
            self.undo(clock, Some(brush))?;
        }
        Ok(())
    }

    /// Does the newest undone step again, of a brush or of all, and says what it was.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub(crate) fn redo(
        &mut self,
        clock: &mut Clock,
        brush: Option<&str>,
    ) -> Result<StepName, EditError> {
        if let Some(brush) = brush {
            self.brushes.at(brush)?;
        }
        self.commit();
        let step = self.past.history.last_undone(brush).cloned();
        let step = step.ok_or(HistoryError::NothingToRedo)?;
        self.check(&step, Direction::Redo)?;
        self.end_step(|_| true);
        Ok(self.walk(clock, &step, Direction::Redo))
    }

    /// Undoes or redoes steps until the one with this number is the newest done one, 0 for none, and returns its name.
    ///
    /// # Errors
    /// [`EditError`] for an unknown step, and where something was painted over one on the way: then nothing has changed.
    pub(crate) fn go_to(&mut self, clock: &mut Clock, step: u64) -> Result<StepName, EditError> {
        let open = self.past.history.open().find(|open| open.id == step);
        if let Some(what) = open.map(|open| open.what.clone()) {
            // Unfinished steps do not count as newer.
            return Ok(what);
        }
        let way = self.past.history.way_to(step).ok_or(HistoryError::NoStep)?;
        let way: Vec<Direction> = way.into_iter().map(|(way, _)| way).collect();
        let way: Vec<Direction> = match way.first() {
            Some(Direction::Redo) => way,
            _ => {
                let open = self.past.history.open().map(|_| Direction::Undo);
                open.chain(way).collect()
            }
        };
        let mut gone = Vec::new();
        for way in way {
            let went = match way {
                Direction::Undo => self.undo(clock, None),
                Direction::Redo => self.redo(clock, None),
            };
            if let Err(error) = went {
                // Back by the way that was just gone, which nothing lies over. No message describes what it leaves: dryings
                // that were stopped, steps that were ended.
                self.past.record.is_broken = true;
                for way in gone.into_iter().rev() {
                    drop(match way {
                        Direction::Undo => self.redo(clock, None),
                        Direction::Redo => self.undo(clock, None),
                    });
                }
                return Err(error);
            }
            gone.push(way);
        }
        if step > 0 {
            self.past.record.go_to(step);
        }
        let newest = self.past.history.last_done(None);
        Ok(newest.map_or(StepName::Beginning, |step| step.what.clone()))
    }

    /// Sees that all is as the step left it, or found it.
    fn check(&self, step: &Step, way: Direction) -> Result<(), HistoryError> {
        let from = way.ends()[0];
        let effects = &step.effects;
        let mut tiles = step.tiles.iter();
        let over =
            tiles.any(|(place, change)| !same(&self.desk.surfaces.tile(*place), change.end(from)));
        let mut loads = effects.loads.iter();
        // A brush that is gone is no hindrance.
        let other_load = loads.any(|(name, pages)| {
            let brush = self.brushes.find(name);
            brush.is_some_and(|brush| !brush.carries(&pages[from]))
        });
        let (layers, made) = (effects.layers.as_ref(), effects.materials.as_ref());
        let other_rest = layers.is_some_and(|ends| ends[from] != self.desk.scene.layers)
            || made.is_some_and(|ends| ends[from] != materials(&self.desk.scene));
        let other_books = !self.accounts.ledger.can_book(&effects.booked, way.times());
        // A later step may have led back to the tiles of this one, like a return to a version.
        let later = match way {
            Direction::Undo => self.past.history.later_on(step),
            Direction::Redo => None,
        };
        if later.is_none() && !over && !other_load && !other_rest && !other_books {
            return Ok(());
        }
        let other = later.or_else(|| self.past.history.last_done(None));
        Err(HistoryError::Covered {
            what: step.what.clone(),
            over: other.map(|step| step.what.clone()),
        })
    }

    /// Takes a step back, or forth; it was checked.
    fn walk(&mut self, clock: &mut Clock, step: &Step, way: Direction) -> StepName {
        let to = way.ends()[1];
        let effects = &step.effects;
        // Time would do again what is taken back.
        clock.stop(None);
        self.past.record.move_to(step);
        for (place, change) in &*step.tiles {
            self.desk.surfaces.put(*place, change.end(to).clone());
        }
        for (name, pages) in &effects.loads {
            if let Some(brush) = self.brushes.find_mut(name) {
                brush.carry(&pages[to], &mut self.desk.scene);
            }
        }
        self.accounts.book(&effects.booked, way.times());
        let (layers, made) = (effects.layers.as_ref(), effects.materials.as_ref());
        let desk = &mut self.desk;
        desk.restore(layers.map(|ends| &ends[to]), made.map(|ends| &ends[to]));
        self.turn_tops(step, way);
        match way {
            Direction::Undo => self.past.history.undone(step.id),
            Direction::Redo => self.past.history.redone(step.id),
        }
        step.what.clone()
    }

    /// Restores the height of the paint where no other paint was added meanwhile, so that the same motion paints the
    /// same again.
    fn turn_tops(&mut self, step: &Step, way: Direction) {
        let newest = self
            .past
            .history
            .last_done(None)
            .map_or(0, |newest| newest.id);
        let [before, after] = &step.effects.tops;
        let (from, to) = match way {
            Direction::Undo if step.id == newest => (after, before),
            Direction::Redo if step.id > newest => (before, after),
            _ => return,
        };
        for surface in self.desk.surfaces.iter_mut() {
            if from.get(&surface.id) == Some(&surface.top)
                && let Some(top) = to.get(&surface.id)
            {
                surface.top = *top;
            }
        }
    }
}
