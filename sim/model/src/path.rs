//! Motion cut into steps of one length.
//!
//! Poses come as the brush is solved; steps are cut from the path between them, each as long as the last, whatever the
//! rate of samples. The rest of a path waits for more of it, or for the end of the contact.

use maulstick_brush::{Head, HeadPose};

use crate::brush::head::{Waypoint, motion};
use crate::brush::scale::Scale;
use crate::interface::Sweep;

/// Motion that counts as rest, cells.
const STILL: f64 = 0.02;
/// Longest motion of a hand, m of the brush; a longer one paints nothing.
const LEAP_M: f64 = 2.0;
/// Motion in step lengths from which it is painted in doubled steps.
const DOUBLED_FROM: f64 = 1.5;
/// Largest excess of a path over the long step across it, cells.
const DETOUR: f64 = 0.25;
/// Greatest number of doublings of a step.
const MOST_DOUBLINGS: u32 = 2;
/// A motion short of a step by less than this share is one.
const ROUNDING: f64 = 1e-6;

/// Cuts the motion of one brush on one surface.
#[derive(Debug)]
pub struct PathStepper {
    /// Its position one step before, and the head there.
    before: Option<(Waypoint, HeadPose)>,
    at: Waypoint,
    stepped: HeadPose,
    /// Its newest position, less than a step ahead.
    ahead: Option<Waypoint>,
    scale: Scale,
    doublings: u32,
}

impl PathStepper {
    /// A path that begins at `at`.
    #[must_use]
    pub fn begin(head: &Head, at: Waypoint, scale: Scale) -> Self {
        let mut stepped = HeadPose::default();
        at.pose(head, scale, &mut stepped);
        Self {
            before: None,
            at,
            stepped,
            ahead: None,
            scale,
            doublings: 0,
        }
    }

    /// Path of a brush that descends to `at` along its handle; `step` is called for its last `steps` steps. So a brush
    /// that is only set down prints, loads and cleans, whatever the pose of its bristles: paint is transferred by the
    /// path along the surface.
    pub fn landing(
        head: &Head,
        (at, steps): (Waypoint, f64),
        scale: Scale,
        mut step: impl FnMut(Sweep<'_>, u32),
    ) -> Self {
        let way_m = steps * scale.step_cells(head.is_fine()) * scale.cell_m * scale.zoom;
        let mut path = Self::begin(head, at.withdrawn(way_m), scale);
        path.advance(head, (at, 0), &mut step);
        path.end(head, step);
        path
    }

    /// A saved path: position of its last step, the position since, and that of the step before.
    #[must_use]
    pub fn going_on(
        head: &Head,
        (at, ahead, before): (Waypoint, Option<Waypoint>, Option<Waypoint>),
        scale: Scale,
    ) -> Self {
        let posed = |place: Waypoint| {
            let mut pose = HeadPose::default();
            place.pose(head, scale, &mut pose);
            (place, pose)
        };
        Self {
            ahead,
            before: before.map(posed),
            ..Self::begin(head, at, scale)
        }
    }

    /// This path with the poses of a head whose bristles have regrouped; its steps stay as long.
    #[must_use]
    pub fn regrouped(self, head: &Head) -> Self {
        let before = self.before.map(|(place, _)| place);
        Self {
            doublings: self.doublings,
            ..Self::going_on(head, (self.at, self.ahead, before), self.scale)
        }
    }

    /// Position of the last step, the position since, and that of the step before.
    #[must_use]
    pub fn places(&self) -> (&Waypoint, Option<&Waypoint>, Option<&Waypoint>) {
        let before = self.before.as_ref().map(|(place, _)| place);
        (&self.at, self.ahead.as_ref(), before)
    }

    /// Scale of the brush's lengths on the surface.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Length of its steps by the brush's own.
    #[must_use]
    pub fn longer(&self) -> u32 {
        1 << self.doublings
    }

    /// Moves to `to` in steps with this number of doublings, none for a blade, and calls `step` for each, with its
    /// doublings: these follow from its length, so that a restored path ends in the same way.
    pub fn advance(
        &mut self,
        head: &Head,
        (to, doublings): (Waypoint, u32),
        mut step: impl FnMut(Sweep<'_>, u32),
    ) {
        self.doublings = if head.is_fine() { 0 } else { doublings };
        let whole = self.scale.step_cells(head.is_fine()) * f64::from(self.longer());
        let mut next = HeadPose::default();
        to.pose(head, self.scale, &mut next);
        if self.doublings > 0 {
            self.step_to_reversal(head, &next, &mut step);
        }
        let motion = motion(&self.stepped, &next);
        if motion > LEAP_M / (self.scale.cell_m * self.scale.zoom) {
            *self = Self::begin(head, to, self.scale);
            return;
        }
        let steps = (motion / whole + ROUNDING).floor() as u64;
        let from = self.at.clone();
        for number in 1..=steps {
            let at = from.toward(&to, number as f64 * whole / motion);
            self.step_to(head, at, &mut step);
        }
        self.ahead = Some(to);
    }

    /// Ends the contact: the remaining path is stepped, with doublings by its length.
    pub fn end(&mut self, head: &Head, mut step: impl FnMut(Sweep<'_>, u32)) {
        if let Some(to) = self.ahead.take() {
            self.step_to(head, to, &mut step);
        }
    }

    /// Steps to the point where the brush turns within a long step: the path there and back would be lost.
    fn step_to_reversal(
        &mut self,
        head: &Head,
        next: &HeadPose,
        step: &mut impl FnMut(Sweep<'_>, u32),
    ) {
        let Some(ahead) = self.ahead.take() else {
            return;
        };
        let mut there = HeadPose::default();
        ahead.pose(head, self.scale, &mut there);
        let by_there = motion(&self.stepped, &there) + motion(&there, next);
        if by_there - motion(&self.stepped, next) > DETOUR {
            self.step_to(head, ahead, step);
        } else {
            self.ahead = Some(ahead);
        }
    }

    fn step_to(&mut self, head: &Head, to: Waypoint, step: &mut impl FnMut(Sweep<'_>, u32)) {
        let mut next = HeadPose::default();
        to.pose(head, self.scale, &mut next);
        let motion = motion(&self.stepped, &next);
        if motion < STILL {
            return;
        }
        let own = self.scale.step_cells(head.is_fine());
        let longer = |doublings: &u32| motion > own * f64::from(1 << doublings) * DOUBLED_FROM;
        let sweep = Sweep {
            before: self.before.as_ref().map(|(_, pose)| pose),
            from: &self.stepped,
            to: &next,
        };
        step(sweep, (0..MOST_DOUBLINGS).take_while(longer).count() as u32);
        let at = std::mem::replace(&mut self.at, to);
        let stepped = std::mem::replace(&mut self.stepped, next);
        self.before = Some((at, stepped));
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;
    use maulstick_types::Pose;
    use maulstick_types::brush::Solve;
    use proptest::prelude::*;

    use super::*;

    const SCALE: Scale = Scale {
        cell_m: 2.5e-4,
        zoom: 1.0,
    };

    fn waypoint(x: f64) -> Waypoint {
        let solve = Solve {
            event_ns: 0,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose {
                position_m: [x, 0.1, 0.01],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            angles_rad: vec![[0.0, 0.4]; 21],
            contacts: Vec::new(),
        };
        Waypoint::of(&solve, SCALE, 1.0)
    }

    proptest! {
        /// However a motion of 10.4 cells is subdivided, its steps are a cell long, except for the last one, and add up
        /// to the whole.
        #[test]
        fn steps_are_of_one_length_and_make_up_the_motion(
            cuts in prop::collection::vec(0.0..1.0f64, 0..30),
        ) {
            let head = Head::of(&BrushFile::library("round").expect("round"));
            let mut cuts = cuts;
            cuts.sort_by(f64::total_cmp);
            cuts.push(1.0);
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            let mut steps = Vec::new();
            let mut note = |sweep: Sweep<'_>, _: u32| steps.push(motion(sweep.from, sweep.to));
            for cut in cuts {
                path.advance(&head, (waypoint(0.1 + cut * 10.4 * 2.5e-4), 0), &mut note);
            }
            path.end(&head, &mut note);
            let last = steps.pop().expect("steps");
            prop_assert_eq!(steps.len(), 10);
            prop_assert!(steps.iter().all(|cells| (cells - 1.0).abs() < 1e-3), "{:?}", steps);
            prop_assert!((last - 0.4).abs() < 1e-3, "{}", last);
        }

        /// A step is as long as its doublings say, the last one too.
        #[test]
        fn doublings_follow_from_the_length(doublings in 0..3u32, cells in 5.0..30.0f64) {
            let head = Head::of(&BrushFile::library("round").expect("round"));
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            let mut steps = Vec::new();
            let mut note = |sweep: Sweep<'_>, doubled: u32| steps.push((motion(sweep.from, sweep.to), doubled));
            path.advance(&head, (waypoint(0.1 + cells * 2.5e-4), doublings), &mut note);
            path.end(&head, &mut note);
            let whole = f64::from(1 << doublings);
            prop_assert!((steps.iter().map(|step| step.0).sum::<f64>() - cells).abs() < STILL + 1e-2);
            let full = steps.iter().filter(|step| (step.0 / whole - 1.0).abs() < 1e-3);
            prop_assert!(full.clone().count() as f64 + 1.01 > cells / whole);
            prop_assert!(full.clone().all(|step| step.1 == doublings));
            prop_assert!(steps.iter().all(|step| step.0 <= f64::from(1 << step.1) * DOUBLED_FROM + 1e-3));
        }

        /// Reversals within a long step: the brush covers the whole path except its unreversed end.
        #[test]
        fn a_long_step_ends_where_the_brush_turns(swings in prop::collection::vec(0.3..3.5f64, 2..9)) {
            let head = Head::of(&BrushFile::library("round").expect("round"));
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            let (mut way, mut stepped) = (0.0, 0.0);
            let mut note = |sweep: Sweep<'_>, _: u32| stepped += motion(sweep.from, sweep.to);
            for cells in swings {
                path.advance(&head, (waypoint(0.1 + cells * 2.5e-4), 2), &mut note);
                path.advance(&head, (waypoint(0.1), 2), &mut note);
                way += 2.0 * cells;
            }
            path.end(&head, &mut note);
            prop_assert!((stepped - way).abs() < 0.01 * way, "{stepped} of {way} cells");
        }

        /// A restored path continues like the original.
        #[test]
        fn a_kept_path_goes_on(first in 0.0..10.0f64, second in 0.0..10.0f64) {
            let head = Head::of(&BrushFile::library("round").expect("round"));
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            path.advance(&head, (waypoint(0.1 + first * 2.5e-4), 0), |_, _| ());
            let (at, ahead, before) = path.places();
            let places = (at.clone(), ahead.cloned(), before.cloned());
            let mut kept = PathStepper::going_on(&head, places, SCALE);
            let rest = |path: &mut PathStepper, goes_on: bool| {
                let mut ends = Vec::new();
                let mut note = |sweep: Sweep<'_>, _: u32| {
                    ends.push((sweep.before.map(|pose| pose.x.clone()), sweep.to.x.clone()));
                };
                if goes_on {
                    path.advance(&head, (waypoint(0.1 + second * 2.5e-4), 0), &mut note);
                }
                path.end(&head, &mut note);
                ends
            };
            let goes_on = second > 5.0;
            prop_assert_eq!(rest(&mut path, goes_on), rest(&mut kept, goes_on));
        }
    }

    #[test]
    fn the_steps_of_a_blade_grow_never() {
        let lengths = |brush: &str| {
            let head = Head::of(&BrushFile::library(brush).expect("in the library"));
            let mut path = PathStepper::begin(&head, waypoint(0.1), SCALE);
            let mut steps = Vec::new();
            path.advance(&head, (waypoint(0.104), 2), |sweep, doublings| {
                steps.push((motion(sweep.from, sweep.to), doublings));
            });
            steps
        };
        let is_short = |(cells, doublings): &(f64, u32)| *cells < 1.01 && *doublings == 0;
        assert!(lengths("knife").iter().all(is_short));
        assert!(!lengths("round").iter().all(is_short), "a fault passes");
    }
}
