//! Changes of the light, as undo takes them: a light is no step of the painting, but a painter who has just changed it
//! means it by undo.

use maulstick_types::scene::Light;

use crate::rig::state::RigState;

/// Changes less than this apart are one, as those of a lamp that is dragged, ns.
const ONE_NS: u64 = 1_000_000_000;
/// Longest wait for a light that was asked for, ns.
const WAITED_NS: u64 = 2_000_000_000;
/// So many changes are kept.
const MOST: usize = 64;

/// A change of the light after a step of the painting.
#[derive(Clone, Debug, PartialEq)]
struct Change {
    before: Light,
    after: Light,
    /// The newest step that was done then; 0 for none.
    step: u64,
}

/// Changes of the light of a painting, in their order.
#[derive(Debug, Default)]
pub(crate) struct LampUndo {
    /// Start of the paint node that they are of.
    starts: u64,
    known: Option<Light>,
    changed_ns: u64,
    done: Vec<Change>,
    undone: Vec<Change>,
    /// The light that was asked for, and the time until which it is waited for, ns.
    asked: Option<(Light, u64)>,
}

/// Number of the newest step that is done.
fn newest_step(rig: &RigState) -> u64 {
    let history = rig.live.paint.iter().flat_map(|node| &node.status.history);
    let mut done = history.filter(|step| step.done);
    done.next().map_or(0, |step| step.id)
}

impl LampUndo {
    /// Follows the light of the rig; `in_hand` is true while a control is dragged.
    pub(crate) fn follow(&mut self, rig: &RigState, in_hand: bool) {
        let Some(light) = rig.live.scene.as_ref().map(|scene| &scene.light) else {
            return;
        };
        if self.starts != rig.live.starts {
            *self = Self {
                starts: rig.live.starts,
                ..Self::default()
            };
        }
        if let Some((asked, until_ns)) = &self.asked {
            if asked != light && rig.live.now_ns < *until_ns {
                return;
            }
            self.known = Some(light.clone());
            self.asked = None;
        }
        let step = newest_step(rig);
        // A step that was undone and is followed by another cannot be redone.
        let redo = rig.live.paint.as_ref().map_or(0, |node| node.status.redo);
        if redo == 0 && self.undone.last().is_some_and(|undone| undone.step != step) {
            self.undone.clear();
        }
        let Some(before) = self.known.replace(light.clone()) else {
            return;
        };
        if before == *light {
            return;
        }
        let is_one = in_hand || rig.live.now_ns < self.changed_ns.saturating_add(ONE_NS);
        self.changed_ns = rig.live.now_ns;
        self.undone.clear();
        match self.done.last_mut() {
            Some(last) if is_one && last.step == step && last.after == before => {
                last.after = light.clone();
            }
            _ => self.done.push(Change {
                before,
                after: light.clone(),
                step,
            }),
        }
        let many = self.done.len().saturating_sub(MOST);
        self.done.drain(..many);
    }

    /// The light before its newest change, if nothing else was done since.
    pub(crate) fn undo(&mut self, rig: &RigState) -> Option<Light> {
        let (step, light) = (newest_step(rig), &rig.live.scene.as_ref()?.light);
        let is_newest = |change: &mut Change| change.step == step && change.after == *light;
        let change = self.done.pop_if(is_newest)?;
        let to = change.before.clone();
        self.undone.push(change);
        self.ask(rig, to)
    }

    /// The light as it was before the newest undo, if that was one of the light.
    pub(crate) fn redo(&mut self, rig: &RigState) -> Option<Light> {
        let (step, light) = (newest_step(rig), &rig.live.scene.as_ref()?.light);
        let is_newest = |change: &mut Change| change.step == step && change.before == *light;
        let change = self.undone.pop_if(is_newest)?;
        let to = change.after.clone();
        self.done.push(change);
        self.ask(rig, to)
    }

    fn ask(&mut self, rig: &RigState, light: Light) -> Option<Light> {
        self.asked = Some((light.clone(), rig.live.now_ns.saturating_add(WAITED_NS)));
        Some(light)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::paint::{HistoryStep, StepName};

    use super::*;
    use crate::test_support::panel_bench::rig;

    const SECOND: u64 = 1_000_000_000;

    struct Desk {
        rig: RigState,
        lamps: LampUndo,
    }

    impl Desk {
        fn new() -> Self {
            let mut desk = Self {
                rig: rig(),
                lamps: LampUndo::default(),
            };
            desk.rig.live.now_ns = 100 * SECOND;
            desk.lamps.follow(&desk.rig, false);
            desk
        }

        fn light(&mut self, intensity: f64, after_ns: u64, in_hand: bool) {
            let scene = self.rig.live.scene.as_mut().expect("a scene");
            scene.light.intensity = intensity;
            self.rig.live.now_ns += after_ns;
            self.lamps.follow(&self.rig, in_hand);
        }

        fn steps(&mut self, done: &[u64], undone: u32) {
            let status = &mut self.rig.live.paint.as_mut().expect("a node").status;
            let step = |id: &u64| HistoryStep {
                id: *id,
                what: StepName::Fill,
                done: true,
            };
            status.history = done.iter().rev().map(step).collect();
            status.redo = undone;
            self.lamps.follow(&self.rig, false);
        }

        /// Undoes and lets the rig answer.
        fn undo(&mut self) -> Option<f64> {
            let light = self.lamps.undo(&self.rig)?.intensity;
            self.light(light, SECOND / 10, false);
            Some(light)
        }

        fn redo(&mut self) -> Option<f64> {
            let light = self.lamps.redo(&self.rig)?.intensity;
            self.light(light, SECOND / 10, false);
            Some(light)
        }
    }

    #[test]
    fn a_lamp_that_was_dragged_is_one_change_and_comes_back_before_the_step_before_it() {
        let mut desk = Desk::new();
        desk.steps(&[1, 2], 0);
        for intensity in [1.1, 1.2, 1.3] {
            desk.light(intensity, 2 * SECOND, true);
        }
        desk.light(2.0, 5 * SECOND, false);
        assert_eq!(desk.undo(), Some(1.3));
        assert_eq!(desk.undo(), Some(1.0));
        assert_eq!(desk.undo(), None, "then it is the step's turn");
        assert_eq!(
            (desk.redo(), desk.redo(), desk.redo()),
            (Some(1.3), Some(2.0), None)
        );
    }

    #[test]
    fn a_stroke_after_a_lamp_is_undone_first() {
        let mut desk = Desk::new();
        desk.steps(&[1], 0);
        desk.light(2.0, 5 * SECOND, false);
        desk.steps(&[1, 2], 0);
        assert_eq!(desk.undo(), None, "the stroke is newer");
        desk.steps(&[1], 1);
        assert_eq!(desk.undo(), Some(1.0));
        assert_eq!(desk.redo(), Some(2.0));
        assert_eq!(desk.undo(), Some(1.0));
        desk.steps(&[1, 3], 0);
        desk.steps(&[1], 1);
        assert_eq!(desk.redo(), None, "another stroke came");
    }

    #[test]
    fn another_painting_has_another_light() {
        let mut desk = Desk::new();
        desk.light(2.0, 5 * SECOND, false);
        desk.rig.live.starts += 1;
        desk.light(3.0, SECOND, false);
        assert_eq!(desk.undo(), None);
    }
}
