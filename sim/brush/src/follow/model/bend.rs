//! The bend that stays in a head, its permanent set: from stroke to stroke, over pauses, and where its path is lost.
//!
//! It goes when another brush is taken up, when a take begins, when the brush is lifted out of a jar of cleaner, on whose
//! rim it is wiped, and when the painting says so.

use maulstick_num::geometry::Rigid;
use maulstick_types::scene::BrushSet;

use super::{BrushModel, TrackedBrush};
use crate::desk::{Obstacle, Plane};
use crate::head_solver::SolvedHead;

/// Solves of a head that was just lifted: neighbouring spines that were apart come to rest against each other.
const SETTLING: usize = 8;

/// Permanent set of a head when it was last in the air.
#[derive(Debug, Default)]
pub(super) struct KeptSet {
    /// As [`SolvedHead::set`] gives it.
    pub(super) angles: Vec<[f32; 2]>,
    /// Number of the set that was given last; absent before the first scene.
    given: Option<u32>,
}

impl BrushModel {
    /// Sets the wetness of the head: 0 as in its file, 1 soaked, where its hairs stick together most and drag on each
    /// other.
    pub fn soak(&mut self, wetness: f64) {
        let [made, soaked] = self.file.spines.bond;
        self.wetness = wetness.clamp(0.0, 1.0);
        self.tuft.bond = made + (soaked - made) * self.wetness;
        let soaked = self.file.spines.damping_soaked;
        self.settings.damping = 1.0 + (soaked - 1.0) * self.wetness;
    }

    /// Takes on a permanent set that the painting has given the brush, or at its beginning the one that it had: in
    /// contact, as soon as it is lifted.
    pub fn take_set(&mut self, set: Option<&BrushSet>) {
        let given = set.map_or(0, |set| set.given);
        if self.set.given.replace(given) == Some(given) {
            return;
        }
        if let Some(set) = set {
            self.set.angles.clone_from(&set.angles_rad);
            if let Some(tracked) = &mut self.tracked {
                tracked.reshaped = Some(set.angles_rad.clone());
            }
        }
    }

    /// Brings the head into shape for a take, which is the same whatever the brush did before.
    pub fn straighten(&mut self) {
        self.set.angles.clear();
        if let Some(tracked) = &mut self.tracked {
            tracked.reshaped = Some(Vec::new());
        }
    }

    /// Replaces the bend of a head in the air by one that it was given; true if that converged. A head in the cleaner is
    /// given none, for when it is lifted.
    pub(super) fn reshape(
        &mut self,
        tracked: &mut TrackedBrush,
        brush: &Rigid,
        plane: &Plane,
    ) -> bool {
        if tracked.head.touches() {
            let desk = self.desk.as_ref();
            if desk.is_some_and(|desk| tracked.head.touching().any(|p| desk.cleans(plane, p))) {
                tracked.reshaped = Some(Vec::new());
            }
            return true;
        }
        let Some(set) = tracked.reshaped.take() else {
            return true;
        };
        tracked.head = SolvedHead::bent(&self.tuft, brush, &set);
        self.settle(tracked, brush, plane)
    }

    /// Bends the spines of a head in the air until they agree; true if all converged.
    pub(super) fn settle(
        &mut self,
        tracked: &mut TrackedBrush,
        brush: &Rigid,
        plane: &Plane,
    ) -> bool {
        let passes = (0..SETTLING).map(|_| self.bend(tracked, brush, plane));
        passes.last().unwrap_or(true)
    }

    /// Goes on from here at the next sample, and notes the permanent set of a head in the air.
    pub(super) fn keep(&mut self, tracked: TrackedBrush) {
        if !tracked.head.touches() && !tracked.is_pressed {
            self.set.angles = tracked.head.set(&self.tuft);
        }
        self.tracked = Some(tracked);
    }

    /// Lifts a head whose path is lost, and notes its permanent set.
    pub(super) fn put_down(&mut self, mut tracked: TrackedBrush) {
        if let Some(set) = tracked.reshaped {
            self.set.angles = set;
            return;
        }
        if tracked.head.touches() {
            let mut brush = self.placed(&tracked, &tracked.newest);
            brush.translation.z += 2.0 * self.file.length_m();
            let (room, ground) = (&mut self.solver, [Obstacle::ground()]);
            let (tuft, settings) = (&self.tuft, &self.settings);
            for _ in 0..SETTLING {
                tracked.head.solve(room, tuft, &brush, &ground, settings);
            }
        }
        self.set.angles = tracked.head.set(&self.tuft);
    }
}
