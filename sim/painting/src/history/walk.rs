//! Ways through the history: which steps lead from the present one to another.

use maulstick_types::paint::StepName;
use maulstick_types::scene::PALETTE;

use super::{History, OpenStep, Step, TilePlace};

/// Direction of a step: undo or redo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    Undo,
    Redo,
}

impl Direction {
    /// The end that a step is taken from, and the one that it is taken to.
    pub(crate) fn ends(self) -> [usize; 2] {
        match self {
            Self::Undo => [1, 0],
            Self::Redo => [0, 1],
        }
    }

    /// Factor on its bookings.
    pub(crate) fn times(self) -> i64 {
        match self {
            Self::Undo => -1,
            Self::Redo => 1,
        }
    }
}

/// A step in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListedStep {
    /// Its number; one that is not finished gets another when it ends.
    pub id: u64,
    /// Its name.
    pub what: StepName,
    /// True if it is done; false if it was undone.
    pub done: bool,
}

/// Name of a brush's action at these places.
pub(crate) fn placed<'a>(what: &StepName, places: impl Iterator<Item = &'a TilePlace>) -> StepName {
    let mut surfaces = places.map(|place| place.0).peekable();
    let on_palette = surfaces.peek().is_some() && surfaces.all(|surface| surface == PALETTE);
    what.clone().placed(on_palette)
}

impl History {
    /// The steps to undo or to redo, in order, until the one with this number is the newest done one, 0 for none;
    /// `None` if there is no such step. Unfinished steps are left out.
    pub(crate) fn way_to(&self, id: u64) -> Option<Vec<(Direction, &Step)>> {
        let target = match id {
            0 => None,
            id => Some(self.steps.get(&id)?),
        };
        if target.is_none_or(|step| step.done) {
            let later = self.steps.range(id + 1..).rev().map(|(_, step)| step);
            let done = later.filter(|step| step.done);
            return Some(done.map(|step| (Direction::Undo, step)).collect());
        }
        let place = self.undone.iter().position(|other| *other == id)?;
        let undone = self.undone[place..].iter().rev();
        let steps = undone.filter_map(|id| self.steps.get(id));
        Some(steps.map(|step| (Direction::Redo, step)).collect())
    }

    /// Number of undone steps before a step, which depends on them. `None` if there is no such step; 0 is the
    /// beginning.
    #[must_use]
    pub fn undone_before(&self, id: u64) -> Option<u64> {
        let known = id == 0 || self.steps.contains_key(&id) || self.is_open(id);
        let before = self.undone.iter().filter(|undone| **undone < id);
        known.then(|| before.count() as u64)
    }

    /// True for a step that is not finished.
    #[must_use]
    pub fn is_open(&self, id: u64) -> bool {
        self.open.iter().any(|step| step.id == id)
    }

    /// At most `most` steps around the present one, in the order of a list: the newest first, undone ones, unfinished
    /// ones, done ones.
    #[must_use]
    pub fn around(&self, most: usize) -> Vec<ListedStep> {
        let listed = |step: &Step| ListedStep {
            id: step.id,
            what: step.what.clone(),
            done: step.done,
        };
        let unfinished = |step: &OpenStep| ListedStep {
            id: step.id,
            what: match step.brush {
                Some(_) => placed(&step.what, step.reached.iter()),
                None => step.what.clone(),
            },
            done: true,
        };
        let undone = self.undone.len().min(most / 2);
        let next = self.undone[self.undone.len() - undone..].iter();
        let next = next.filter_map(|id| self.steps.get(id));
        let open = self.open.iter().rev().map(unfinished);
        let done = self.steps.values().rev().filter(|step| step.done);
        let all = next.map(listed).chain(open).chain(done.map(listed));
        all.take(most).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn history(steps: &[(u64, bool)], undone: &[u64]) -> History {
        let steps = steps.iter().map(|(id, done)| Step {
            id: *id,
            what: StepName::Fill,
            brush: None,
            operations: 1,
            done: *done,
            tiles: Arc::default(),
            effects: Arc::default(),
        });
        History::restored((9, undone.to_vec()), steps.collect(), Vec::new(), 0)
    }

    #[test]
    fn the_way_leads_over_each_step_between_in_order() {
        let all = [(2, true), (3, true), (5, true), (7, false), (8, false)];
        let history = history(&all, &[8, 7]);
        let way = |id| {
            let way = history.way_to(id)?;
            let step = |(way, step): &(Direction, &Step)| match way {
                Direction::Undo => -(step.id as i64),
                Direction::Redo => step.id as i64,
            };
            Some(way.iter().map(step).collect::<Vec<i64>>())
        };
        for (id, steps) in [
            (5, Some(vec![])),
            (2, Some(vec![-5, -3])),
            (0, Some(vec![-5, -3, -2])),
            (7, Some(vec![7])),
            (8, Some(vec![7, 8])),
            (6, None),
        ] {
            assert_eq!(way(id), steps, "{id}");
        }
        let around = |most| -> Vec<u64> { history.around(most).iter().map(|s| s.id).collect() };
        assert_eq!(around(30), [8, 7, 5, 3, 2]);
        assert_eq!(around(3), [7, 5, 3]);
    }
}
