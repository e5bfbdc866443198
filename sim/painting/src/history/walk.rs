//! Ways through the history: which steps lead from the present one to another.

use std::collections::BTreeSet;

use super::{History, OpenStep, Step};

/// Direction of a step: undo or redo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Back,
    Forth,
}

impl Way {
    /// The end that a step is taken from, and the one that it is taken to.
    pub(crate) fn ends(self) -> [usize; 2] {
        match self {
            Self::Back => [1, 0],
            Self::Forth => [0, 1],
        }
    }

    /// Factor on its bookings.
    pub(crate) fn times(self) -> i64 {
        match self {
            Self::Back => -1,
            Self::Forth => 1,
        }
    }
}

/// A step in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListedStep {
    /// Its number; one that is not finished gets another when it ends.
    pub id: u64,
    /// Description in words.
    pub what: String,
    /// True if it is done; false if it was undone.
    pub done: bool,
    /// The surfaces that it changed.
    pub surfaces: BTreeSet<u32>,
}

impl History {
    /// The steps to undo or to redo, in order, until the one of this number is the newest that is done, 0 for none;
    /// `None` if there is no such step. Steps that are not finished are left out.
    pub(crate) fn way_to(&self, id: u64) -> Option<Vec<(Way, &Step)>> {
        let target = match id {
            0 => None,
            id => Some(self.steps.get(&id)?),
        };
        if target.is_none_or(|step| step.done) {
            let later = self.steps.range(id + 1..).rev().map(|(_, step)| step);
            let done = later.filter(|step| step.done);
            return Some(done.map(|step| (Way::Back, step)).collect());
        }
        let place = self.undone.iter().position(|other| *other == id)?;
        let undone = self.undone[place..].iter().rev();
        let steps = undone.filter_map(|id| self.steps.get(id));
        Some(steps.map(|step| (Way::Forth, step)).collect())
    }

    /// True for a step that is not finished.
    #[must_use]
    pub fn is_open(&self, id: u64) -> bool {
        self.open.iter().any(|step| step.id == id)
    }

    /// The steps around the present one, `most` at most, as lists show them: the newest first, those that are undone,
    /// those that are not finished, those that are done.
    #[must_use]
    pub fn around(&self, most: usize) -> Vec<ListedStep> {
        let listed = |step: &Step| ListedStep {
            id: step.id,
            what: step.what.clone(),
            done: step.done,
            surfaces: step.tiles.keys().map(|(surface, _)| *surface).collect(),
        };
        let unfinished = |step: &OpenStep| ListedStep {
            id: step.id,
            what: step.what.clone(),
            done: true,
            surfaces: step.reached.iter().map(|(surface, _)| *surface).collect(),
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
            what: id.to_string(),
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
            let step = |(way, step): &(Way, &Step)| match way {
                Way::Back => -(step.id as i64),
                Way::Forth => step.id as i64,
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
