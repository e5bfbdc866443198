//! A pen that is set down: its first samples wait until its direction is known.
//!
//! A pressed pen gives a point and a pressure, but not how the hand came there. A head that is lowered straight down
//! spreads, or buckles to any side, and is dragged round as soon as the hand moves: the stroke would begin with an
//! anvil or a hook. So the brush waits for a short path; the head is then laid down, unseen, over a run-up along that
//! direction before the first point. A pen that rests prints where it is.

use glam::DVec2;
use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::stylus::StylusSample;

use super::{BrushModel, TrackedBrush};
use crate::desk::{Desk, Obstacle, Plane};
use crate::handle_path::Sampled;
use crate::head_solver::SolvedHead;
use crate::lead::Lead;
use crate::mark::point_of;

/// Path of the point after which the direction of a stroke is known, m.
const KNOWN_M: f64 = 1e-3;
/// Path that gives a direction once [`TELLS_NS`] have passed, m.
const TELLING_M: f64 = 0.2e-3;
/// Time after which [`TELLING_M`] suffices, ns.
const TELLS_NS: u64 = 50_000_000;
/// Longest wait of a resting pen, ns; then it is a dab.
const RESTS_NS: u64 = 100_000_000;
/// Greatest number of waiting samples: more than a device of 8 kHz gives in [`RESTS_NS`].
const MOST_WAITING: usize = 1024;
/// Length of a run-up: a share of the head's length, plus a multiple of the pressed depth.
const RUN_UP: (f64, f64) = (0.15, 3.0);
/// Share of a run-up in which the head descends.
const COMES_DOWN: f64 = 0.5;
/// Greatest distance between two solves of a run-up, m.
const STRIDE_M: f64 = 0.5e-3;
/// Greatest number of solves of a run-up; see [`STRIDE_M`].
const MOST_STRIDES: f64 = 64.0;

/// Samples of a pen that was set down and whose direction is not yet known.
#[derive(Clone, Debug, Default)]
pub(super) struct Waiting {
    samples: Vec<Sampled>,
    begins: Begins,
}

/// Start of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Begins {
    /// From the air.
    #[default]
    GoesOn,
    /// Anew, without a connection to the pose before.
    Anew,
}

impl Waiting {
    /// True while no sample waits.
    pub(super) fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Direction of a stroke to `here`; `None` while it may still become known, zero for a resting pen.
    fn direction(&self, here: &Sampled) -> Option<DVec2> {
        let first = self.samples.first()?;
        let way = point_of(&here.pose) - point_of(&first.pose);
        let waited_ns = here.event_ns.saturating_sub(first.event_ns);
        if way.length() >= KNOWN_M {
            return Some(self.known(way));
        }
        let tells = way.length() >= TELLING_M && waited_ns >= TELLS_NS;
        let rests = waited_ns >= RESTS_NS || self.samples.len() >= MOST_WAITING;
        if tells || rests {
            Some(self.told(way))
        } else {
            None
        }
    }

    /// Direction of a path that ends before [`KNOWN_M`].
    fn told(&self, way: DVec2) -> DVec2 {
        if way.length() >= TELLING_M {
            way.normalize_or_zero()
        } else {
            DVec2::ZERO
        }
    }

    /// Direction of the point at which the path from the first point to `way` reaches [`KNOWN_M`], whatever the
    /// sample rate.
    fn known(&self, way: DVec2) -> DVec2 {
        let (Some(first), Some(last)) = (self.samples.first(), self.samples.last()) else {
            return DVec2::ZERO;
        };
        let before = point_of(&last.pose) - point_of(&first.pose);
        let piece = way - before;
        // |before + s·piece| = KNOWN_M.
        let (a, b) = (piece.length_squared(), before.dot(piece));
        let c = before.length_squared() - KNOWN_M * KNOWN_M;
        let s = ((b * b - a * c).max(0.0).sqrt() - b) / a.max(f64::MIN_POSITIVE);
        (before + piece * s.clamp(0.0, 1.0)).normalize_or_zero()
    }
}

impl BrushModel {
    /// Sets down a pen that still waits, when no sample will give its direction any more; the brush continues from
    /// there. Empty where none waits.
    #[must_use]
    pub fn finish(&mut self) -> Vec<Solve> {
        let Some(mut tracked) = self.tracked.take() else {
            return Vec::new();
        };
        let plane = |desk: &Desk| desk.plane(tracked.surface).copied();
        let solves = match self.desk.as_ref().and_then(plane) {
            Some(plane) => {
                let zoom = tracked.zoom;
                self.set_down(&mut tracked, None, &Plane { zoom, ..plane })
            }
            None => Vec::new(),
        };
        self.tracked = Some(tracked);
        solves
    }

    /// Forgets the position of the brush, after setting down a pen that still waits.
    pub(super) fn give_up(&mut self) -> Vec<Solve> {
        let solves = self.finish();
        if let Some(tracked) = self.tracked.take() {
            self.put_down(tracked);
        }
        solves
    }

    /// Begins to wait with a pen that comes down at `here`, and previews its landing. `None` where it touches
    /// nothing, or does not come down.
    pub(super) fn begin_to_wait(
        &mut self,
        tracked: &mut TrackedBrush,
        (here, begins): (Sampled, Begins),
        sample: &StylusSample,
        plane: &Plane,
    ) -> Option<Solve> {
        if sample.in_air() || !tracked.is_pen {
            return None;
        }
        let mut landed = tracked.clone();
        let mut solve = self.land(&mut landed, here, false, plane);
        if !landed.head.touches() {
            return None;
        }
        tracked.waits = Waiting {
            samples: vec![here],
            begins,
        };
        (tracked.stroke, tracked.force_n) = (landed.stroke, landed.force_n);
        solve.flags |= solve_flags::PREVIEW;
        Some(solve)
    }

    /// Waits with one more sample, and previews the landing there; `None` where the wait is over.
    pub(super) fn wait(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        plane: &Plane,
    ) -> Option<Solve> {
        if tracked.waits.direction(&here).is_some() {
            return None;
        }
        let mut waits = std::mem::take(&mut tracked.waits);
        waits.samples.push(here);
        let mut landed = tracked.clone();
        tracked.waits = waits;
        self.stay(&landed, here.event_ns);
        let mut solve = self.land(&mut landed, here, false, plane);
        tracked.force_n = landed.force_n;
        solve.flags |= solve_flags::PREVIEW;
        Some(solve)
    }

    /// Sets down a waiting brush, toward `here` if it is still pressed, and follows the samples that waited, with a
    /// preview at the last of them.
    pub(super) fn set_down(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Option<&Sampled>,
        plane: &Plane,
    ) -> Vec<Solve> {
        let waits = std::mem::take(&mut tracked.waits);
        let Some((first, others)) = waits.samples.split_first() else {
            return Vec::new();
        };
        let (first, others) = (*first, others.to_vec());
        let toward = match here.and_then(|here| waits.direction(here)) {
            Some(toward) => toward,
            None => {
                let last = others.last().unwrap_or(&first);
                waits.told(point_of(&last.pose) - point_of(&first.pose))
            }
        };
        let mut landing = if toward == DVec2::ZERO {
            self.land(tracked, first, false, plane)
        } else {
            self.land_along(tracked, first, toward, plane)
        };
        if waits.begins == Begins::Anew {
            landing.flags |= solve_flags::RESTARTED;
        }
        let mut solves = vec![landing];
        (tracked.newest, tracked.before, tracked.left_over_m) = (first, None, 0.0);
        for next in &others {
            solves.extend(self.walk_to(tracked, *next, plane));
            tracked.before = Some(tracked.newest);
            tracked.newest = *next;
        }
        if let Some(last) = others.last() {
            solves.push(self.preview(tracked, *last, plane));
        }
        solves
    }

    /// Solves a brush that comes down at a sample after an approach in the direction `toward`, a unit vector.
    pub(super) fn land_along(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        toward: DVec2,
        plane: &Plane,
    ) -> Solve {
        self.run_up(tracked, here, toward);
        let solve = self.solve(tracked, here, plane);
        tracked.force_n = tracked.head.force_n();
        solve
    }

    /// Bends a head as its approach to a sample would: it comes down on an endless plane and is drawn along.
    fn run_up(&mut self, tracked: &mut TrackedBrush, here: Sampled, toward: DVec2) {
        let (by_length, by_depth) = RUN_UP;
        let depth_m = (-self.reach().lowest_at_rest(&here.pose)).max(0.0);
        let way_m = by_length * self.file.length_m() + by_depth * depth_m;
        let strides = (way_m / STRIDE_M).ceil().clamp(1.0, MOST_STRIDES);
        let ground = [Obstacle::ground()];
        tracked.lead = Lead::default();
        for stride in 0..=strides as u32 {
            let gone = f64::from(stride) / strides;
            let above_m = depth_m * (1.0 - gone / COMES_DOWN).max(0.0);
            let mut at = here;
            at.pose.translation += (toward * way_m * (gone - 1.0)).extend(above_m);
            let brush = self.placed(tracked, &at);
            if stride == 0 {
                tracked.head = SolvedHead::bent(&self.tuft, &brush, &self.set.angles);
            }
            let (room, settings) = (&mut self.solver, &self.settings);
            tracked
                .head
                .solve(room, &self.tuft, &brush, &ground, settings);
            self.lead(tracked, &at, way_m / strides);
        }
    }
}
