//! The height of a brush whose pen is in the air.

use glam::DVec3;
use maulstick_num::geometry::Rigid;

use super::BrushModel;
use crate::desk::{HOVER_M, Plane};

/// Rises of a hovering brush at most: from over a tilted canvas a joint may come over the palette.
const RISES: usize = 4;
/// Surfaces steeper to each other than this cosine are no ground to hover over.
const LEAST_COSINE: f64 = 0.1;

impl BrushModel {
    /// Lifts the brush of a pen in the air until each joint of its head is [`HOVER_M`] above what lies under it: a wide
    /// head that leans reaches lower than its middle, and to the palette beside the canvas.
    pub(super) fn hover(&self, brush: &mut Rigid, plane: &Plane) {
        let Some(desk) = &self.desk else { return };
        let up = plane.normal();
        let lacking = |joint: DVec3| {
            let in_desk = plane.to_desk.point(joint);
            let lacks = |below: &Plane| {
                let below = below.half_space();
                (HOVER_M - below.gap(in_desk)) / below.normal.dot(up).max(LEAST_COSINE)
            };
            desk.below(in_desk).map(lacks).fold(0.0, f64::max)
        };
        for _ in 0..RISES {
            let joints = self.tuft.joints_at_rest(brush).into_iter();
            let rise = joints.map(lacking).fold(0.0, f64::max);
            if rise <= 0.0 {
                break;
            }
            brush.translation.z += rise;
        }
    }
}
