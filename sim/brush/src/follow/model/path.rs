//! A touching brush on its path from one sample to the next.

use maulstick_types::brush::{Solve, solve_flags};

use super::{BrushModel, TrackedBrush};
use crate::desk::Plane;
use crate::handle_path::{HandlePath, PathSegment, Sampled};

/// Motion of the handle between two solves of a touching brush, m. In between it is interpolated.
const SOLVE_M: f64 = 0.175e-3;
/// Motion of a joint in contact above which the step is halved, m: about as finely as paint is stepped.
const FARTHEST_M: f64 = 0.25e-3;
/// Greatest number of solves between two samples less than [`MOST_SOLVES_NS`] apart, unless a pointer leaps.
const MOST_SOLVES: f64 = 64.0;
/// Time for which [`MOST_SOLVES`] suffice, ns.
const MOST_SOLVES_NS: f64 = 1e8;
/// Greatest distance between two solves of a leaping pointer, m of the surface.
const APART_M: f64 = 1.2e-3;
/// Greatest number of solves of one leap.
const MOST_OF_A_LEAP: f64 = 1024.0;
/// Greatest number of times that a piece of the path is halved.
const SPLITS: u32 = 2;

impl BrushModel {
    /// The path of a touching brush to a sample.
    pub(super) fn path(&self, tracked: &TrackedBrush, here: &Sampled) -> HandlePath {
        let (before, newest) = (tracked.before.as_ref(), &tracked.newest);
        HandlePath::new(before, newest, here, self.file.length_m())
    }

    /// The brush after `way_m` up to a sample at `event_ns`; `None` where it is too fast, which is counted.
    pub(super) fn slow_enough(
        &mut self,
        tracked: Option<TrackedBrush>,
        way_m: f64,
        event_ns: u64,
    ) -> Option<TrackedBrush> {
        let tracked = tracked?;
        let passes = self.speed.passes(way_m, event_ns - tracked.newest.event_ns);
        self.too_fast += u64::from(!passes);
        if !passes {
            self.put_down(tracked);
            return None;
        }
        Some(tracked)
    }

    /// Solves a touching brush at each step of its path to a sample, with a preview at the sample.
    pub(super) fn go(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        plane: &Plane,
    ) -> Vec<Solve> {
        let mut solves = self.walk_to(tracked, here, plane);
        solves.push(self.preview(tracked, here, plane));
        solves
    }

    /// Solves a touching brush at each step of its path to a sample. The path is finite and as slow as
    /// [`SpeedLimit`](crate::speed_limit::SpeedLimit) says.
    pub(super) fn walk_to(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        plane: &Plane,
    ) -> Vec<Solve> {
        let start_ns = tracked.newest.event_ns;
        let path = self.path(tracked, &here);
        let motion_m = path.length_m();
        let pause = (here.event_ns - start_ns) as f64 / MOST_SOLVES_NS;
        let many_m = motion_m / (MOST_SOLVES * pause.max(1.0));
        let near_m = (APART_M * plane.zoom).max(motion_m / MOST_OF_A_LEAP);
        let part_m = many_m.min(near_m).max(SOLVE_M);
        let whole_m = tracked.left_over_m + motion_m;
        let mut solves = Vec::new();
        let (mut gone_m, mut at) = (part_m, 0.0);
        while gone_m <= whole_m {
            let s = path.after(gone_m - tracked.left_over_m);
            let segment = PathSegment {
                path: &path,
                from: at,
                to: s,
                start_ns,
                end_ns: here.event_ns,
                length_m: part_m,
            };
            self.walk(tracked, &segment, plane, SPLITS, &mut solves);
            (gone_m, at) = (gone_m + part_m, s);
        }
        tracked.left_over_m = whole_m - (gone_m - part_m);
        solves
    }

    /// Preview of a touching brush at a sample beyond its last step; the stored state stays at that step.
    pub(super) fn preview(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        plane: &Plane,
    ) -> Solve {
        let mut seen = tracked.clone();
        self.stay(&seen, here.event_ns);
        let mut preview = self.solve(&mut seen, here, plane);
        tracked.force_n = seen.head.force_n();
        preview.flags |= solve_flags::PREVIEW;
        preview
    }

    /// Solves the end of a piece of the path; before it the middle, where a joint in contact would otherwise move
    /// more than a cell.
    fn walk(
        &mut self,
        tracked: &mut TrackedBrush,
        segment: &PathSegment<'_>,
        plane: &Plane,
        splits: u32,
        solves: &mut Vec<Solve>,
    ) {
        let mut tried = tracked.clone();
        let strokes = self.strokes;
        let end = segment.end();
        self.stay(&tried, end.event_ns);
        let solve = self.solve(&mut tried, end, plane);
        let moved = tried.head.moved_in_contact(&tracked.head);
        if splits > 0 && moved > FARTHEST_M {
            self.strokes = strokes;
            let [first, second] = segment.halves();
            self.walk(tracked, &first, plane, splits - 1, solves);
            self.walk(tracked, &second, plane, splits - 1, solves);
            return;
        }
        *tracked = tried;
        self.lead(tracked, &end, segment.length_m);
        solves.push(solve);
    }
}
