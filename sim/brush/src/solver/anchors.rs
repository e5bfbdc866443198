//! Anchors of the inner friction: where a step finds them, and where it leaves them.

use glam::{DMat3, DVec3};
use maulstick_num::geometry::shortest_arc;

use super::Solver;
use crate::energy::damping::follow;
use crate::energy::spring::OfCosine;
use crate::spine::SpineShape;

/// The inner friction of a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Damper {
    pub(super) energy: OfCosine,
    /// Direction of the anchor: the derivative of the cosine by the segment.
    pub(super) anchor: DVec3,
    /// Derivative of the cosine by the segment before.
    pub(super) by_before: DVec3,
}

impl Solver {
    /// Stores how the anchors lie to the segments before them, for a step.
    pub(super) fn turn_to_anchors(&mut self, shape: &SpineShape) {
        self.turns.clear();
        if self.damped {
            let above = [shape.base()].into_iter();
            let above = above.chain(shape.directions.iter().copied());
            let turns = above.zip(&shape.anchors);
            let turns = turns.map(|(above, anchor)| DMat3::from_quat(shortest_arc(above, *anchor)));
            self.turns.extend(turns);
        }
    }

    /// Moves the anchors of a solved spine along.
    pub(super) fn move_anchors(&self, shape: &mut SpineShape) {
        let mut before = shape.base();
        let segments = shape.directions.iter().zip(&mut shape.anchors);
        for ((d, anchor), turn) in segments.zip(&self.turns) {
            *anchor = follow(*d, *turn * before);
            before = *d;
        }
    }
}
