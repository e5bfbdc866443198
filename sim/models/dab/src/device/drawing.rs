//! Drawings of the head in a step ([`each_drawing`]), and their cells.

use maulstick_brush::HeadPose;
use maulstick_model::brush::head::low_bounds;
use maulstick_model::interface::{Step, Sweep};

use crate::stroke::{Stroker, each_drawing};

use maulstick_gpu::steps::record::Grid;

/// A drawing of the head, in the middle of a motion, which is blended at places beside it.
pub(crate) struct Drawing {
    poses: [HeadPose; 2],
    pub(crate) shifts: Vec<[i64; 2]>,
    /// Path of a cell of the head, reference cells: a factor on the motion of its strip, and a summand.
    pub(crate) by_even: [f32; 2],
}

/// The drawings of a step, and the path of its anchor point, cells.
pub(crate) fn drawings(step: &Step<'_>, stroker: Stroker) -> (Vec<Drawing>, f32) {
    let (mut drawings, mut poses) = (Vec::new(), Default::default());
    let length = each_drawing(&step.sweep, stroker, &mut poses, |motion, shifts, way| {
        drawings.push(Drawing {
            poses: [motion.from.clone(), motion.to.clone()],
            shifts: shifts.to_vec(),
            by_even: way.factors(step.traits.cell_per_reference),
        });
    });
    (drawings, length)
}

impl Drawing {
    /// The motion around it.
    pub(crate) fn sweep(&self) -> Sweep<'_> {
        let [from, to] = &self.poses;
        Sweep {
            before: None,
            from,
            to,
        }
    }

    /// The cells of the step's bounds that it can cover, including those beside the window; `None` where there are
    /// none.
    pub(crate) fn grid(&self, step: &Step<'_>) -> Option<Grid> {
        let [_, pose] = &self.poses;
        let (low, high) = low_bounds(step.head, pose, &step.traits, f32::MAX)?;
        let (from, to) = step.bounds;
        let from = [0, 1].map(|i| low[i].max(from[i]));
        let to = [0, 1].map(|i| high[i].min(to[i]));
        (0..2)
            .all(|i| from[i] < to[i])
            .then(|| grid(step, from, to))
    }
}

/// The cells of the surface in a half-open range, all of which may be drawn on.
pub(crate) fn grid(step: &Step<'_>, from: [i64; 2], to: [i64; 2]) -> Grid {
    let origin = step.window.origin();
    let size = [0, 1].map(|i| (to[i] - from[i]) as u32);
    Grid {
        from: [0, 1].map(|i| from[i] - origin[i]),
        size,
        inside: [[0; 2], size],
    }
}
