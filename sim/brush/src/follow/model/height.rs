//! Height at which a pen holds its brush.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::desk::{Desk, HOVER_M, Plane};
use crate::head_solver::SolvedHead;
use crate::spine_layout::SpineLayout;

/// Greatest number of rises of a hovering brush: from over a tilted canvas a joint may come over the palette.
const RISES: usize = 4;
/// Least cosine between two surfaces over which one brush may hover.
const LEAST_COSINE: f64 = 0.1;

/// How far down a head reaches, at rest and with its bend.
pub(super) struct Reach<'a> {
    pub(super) tuft: &'a SpineLayout,
    pub(super) length_m: f64,
    pub(super) desk: Option<&'a Desk>,
    /// Its permanent set.
    pub(super) set: &'a [[f32; 2]],
}

impl Reach<'_> {
    /// Sets the height of a pen's brush from its sample and head; a measured handle stays where it is.
    pub(super) fn hold(&self, brush: &mut Rigid, sample: &StylusSample, plane: &Plane) {
        if !matches!(sample.pose, StylusPose::Contact { .. }) {
            return;
        }
        if sample.in_air() {
            self.hover(brush, plane)
        } else {
            self.lower(brush)
        }
    }

    /// Lowers a pressed brush whose head is shorter below than along its axis: on one side the slanted edge of a chisel
    /// would be in the air.
    fn lower(&self, brush: &mut Rigid) {
        let tip = DVec3::new(0.0, 0.0, -self.length_m);
        // An upright head may end short of its length.
        let short = (self.lowest_at_rest(&Rigid::IDENTITY) - tip.z).max(0.0);
        let upright = (brush.rotation * DVec3::Z).z;
        let lacks = self.lowest_at_rest(brush) - brush.point(tip).z - short * upright;
        brush.translation.z -= lacks.max(0.0);
        // A bent head ends higher than an unbent one: its pen goes down along its axis until it touches as early.
        let raised = self.lowest_bent(brush) - self.lowest_at_rest(brush);
        let axis = brush.rotation * DVec3::Z;
        brush.translation -= axis * (raised.max(0.0) / axis.z.max(LEAST_COSINE));
    }

    /// Height of the lowest joint of the unbent head.
    pub(super) fn lowest_at_rest(&self, brush: &Rigid) -> f64 {
        let joints = self.tuft.joints_at_rest(brush).into_iter();
        joints.map(|joint| joint.z).fold(f64::INFINITY, f64::min)
    }

    /// Lifts the brush of a pen in the air until each joint of its head is [`HOVER_M`] above what lies under it: a
    /// wide leaning head reaches lower than its middle, and onto the palette beside the canvas.
    fn hover(&self, brush: &mut Rigid, plane: &Plane) {
        let Some(desk) = self.desk else { return };
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

    /// Height of the lowest joint of the head in the air.
    fn lowest_bent(&self, brush: &Rigid) -> f64 {
        let head = SolvedHead::bent(self.tuft, brush, self.set);
        head.heights().fold(f64::INFINITY, f64::min)
    }
}
