//! The brush that follows a stylus: samples in, solved states out.

use glam::DVec2;
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::{Solve, solve_flags};
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::stylus::{StylusPose, StylusSample};

use bend::KeptSet;
use height::Reach;
use setting_down::{Begins, Waiting};

use crate::desk::{Desk, Obstacle, Plane, aim, ferrule};
use crate::file::BrushFile;
use crate::follow::stroke_count::StrokeCount;
use crate::handle_path::Sampled;
use crate::head_solver::{HeadSolver, SolvedHead, settings_of};
use crate::lead::Lead;
use crate::mark::{Beside, Mark, point_of};
use crate::solver::Settings;
use crate::speed_limit::SpeedLimit;
use crate::spine_layout::SpineLayout;

/// Longest pause between two samples in contact that is interpolated, ns; a longer one begins a stroke.
pub const BRIDGED_NS: u64 = 300_000_000;
/// Number of trial landings by which a pen finds its mark: an upright head may bend differently with its handle
/// beside the point.
const LANDINGS: usize = 2;

/// A brush in the hand.
#[derive(Debug)]
pub struct BrushModel {
    file: BrushFile,
    depth_share: f64,
    tuft: SpineLayout,
    settings: Settings,
    solver: HeadSolver,
    mark: Mark,
    /// Table of marks, solved when a pen first holds the brush.
    beside: Option<Beside>,
    desk: Option<Desk>,
    follows: Option<Origin>,
    tracked: Option<TrackedBrush>,
    speed: SpeedLimit,
    /// Number of restarts because the handle was too fast.
    too_fast: u64,
    strokes: StrokeCount,
    /// Factor on the stiffness of the file.
    tuned: f64,
    /// Wetness, 0 to 1.
    wetness: f64,
    set: KeptSet,
}

/// State of the brush after a sample. Lengths are the desk's, axes those of the surface.
#[derive(Clone, Debug)]
struct TrackedBrush {
    surface: u32,
    /// Zoom of the surface: on a larger canvas the brush bends differently.
    zoom: f64,
    head: SolvedHead,
    /// Newest sample of the device.
    newest: Sampled,
    /// True for a pen, which is led so that the mark is under its point.
    is_pen: bool,
    /// True for a pen that presses at the newest sample.
    is_pressed: bool,
    /// The stroke of this press; 0 before it touches.
    stroke: u64,
    /// Lead of the handle.
    lead: Lead,
    /// Bend of the head along the surface.
    bent: DVec2,
    /// Normal force of all contacts along that surface's normal, N.
    force_n: f64,
    /// The sample before the newest one, if the brush has touched since.
    before: Option<Sampled>,
    /// Path length from the last solve to the newest sample, m.
    left_over_m: f64,
    /// Samples since the pen was set down, while its direction is unknown.
    waits: Waiting,
    /// Permanent set that the head takes on once it is in the air.
    reshaped: Option<Vec<[f32; 2]>>,
}

impl BrushModel {
    /// A model of the brush `file`; `depth_share` is the depth at full pressure as a share of the head's length.
    #[must_use]
    pub fn new(file: BrushFile, depth_share: f64) -> Self {
        let tuft = SpineLayout::of(&file);
        let settings = settings_of(&file, &tuft);
        let mark = Mark::of(&file);
        Self {
            file,
            depth_share,
            tuft,
            settings,
            solver: HeadSolver::default(),
            mark,
            beside: None,
            desk: None,
            follows: None,
            tracked: None,
            speed: SpeedLimit::default(),
            too_fast: 0,
            strokes: StrokeCount::default(),
            tuned: 1.0,
            wetness: 0.0,
            set: KeptSet::default(),
        }
    }

    /// Takes up another brush, unbent, with the same tuned stiffness; the count of strokes continues.
    pub fn take_up(&mut self, file: BrushFile) {
        self.tuft = SpineLayout::of(&file);
        self.tuft.stiffen(self.tuned);
        self.settings = settings_of(&file, &self.tuft);
        (self.mark, self.beside) = (Mark::of(&file), None);
        self.set.angles.clear();
        (self.file, self.tracked) = (file, None);
        self.soak(self.wetness);
    }

    /// The brush file.
    #[must_use]
    pub fn file(&self) -> &BrushFile {
        &self.file
    }

    /// Puts the brush over another scene; without one, samples give no state.
    pub fn set_scene(&mut self, scene: &Scene) {
        self.desk = Some(Desk::of(scene));
    }

    /// Multiplies the stiffness of the head's file by `factor`; its shape stays.
    pub fn tune(&mut self, factor: f64) {
        if factor != self.tuned && factor.is_finite() && factor > 0.0 {
            self.tuned = factor;
            self.tuft = SpineLayout::of(&self.file);
            self.tuft.stiffen(factor);
            self.settings.repulsion_n_m = self.tuft.repulsion_n_m;
            self.soak(self.wetness);
        }
    }

    /// True if there is a scene.
    #[must_use]
    pub fn has_scene(&self) -> bool {
        self.desk.is_some()
    }

    /// The surface below the brush, or the canvas.
    #[must_use]
    pub fn plane(&self) -> Option<&Plane> {
        let surface = self
            .tracked
            .as_ref()
            .map_or(CANVAS, |tracked| tracked.surface);
        self.desk.as_ref()?.plane(surface)
    }

    /// The planes of the desk.
    #[must_use]
    pub fn desk(&self) -> Option<&Desk> {
        self.desk.as_ref()
    }

    /// Number of samples at which the handle in contact was faster than
    /// [`FASTEST_M_S`](crate::speed_limit::FASTEST_M_S).
    #[must_use]
    pub fn too_fast(&self) -> u64 {
        self.too_fast
    }

    /// Restarts at the next sample, because those in between are unknown. Returns the solves of a pen that was still
    /// waiting to be set down.
    #[must_use]
    pub fn begin_anew(&mut self) -> Vec<Solve> {
        self.give_up()
    }

    /// Solves on the path to one sample of the device `origin`, the last at the sample itself; empty without a scene.
    ///
    /// A touching brush is solved each time it has moved by about a step. Steps are counted across samples, so that
    /// the path does not depend on the sample rate; a sample between two steps gives a preview. A pen lifts at its
    /// sample; one that is set down is shown at once, and [waits](setting_down) for the direction of its stroke. A
    /// pause of up to [`BRIDGED_NS`] in contact is crossed like any path between two samples. A longer one, another
    /// device, time that does not advance, a zoom and a handle that is too fast restart the solver at the new pose;
    /// the solve says so, and nothing is painted up to it. After a pause alone the head keeps its bend.
    pub fn follow(&mut self, origin: Origin, event_ns: u64, sample: &StylusSample) -> Vec<Solve> {
        let mut solves = Vec::new();
        if self.follows != Some(origin) {
            self.follows = Some(origin);
            solves = self.give_up();
        }
        let Some(plane) = self.plane_under(sample) else {
            return solves;
        };
        let length = self.file.length_m();
        let in_desk = ferrule(sample, length, self.depth_share, &plane.half_space());
        let mut brush = plane.to_desk.inverse().after(&in_desk);
        if !sample.in_range {
            brush.translation.z = brush.translation.z.max(2.0 * length);
        }
        let is_pen = matches!(sample.pose, StylusPose::Contact { .. });
        self.reach().hold(&mut brush, sample, &plane);
        let here = Sampled {
            pose: brush,
            event_ns,
        };
        if is_pen && sample.in_range {
            // While it hovers there is time.
            self.solve_table();
        }
        let goes_on = |tracked: &TrackedBrush| {
            event_ns > tracked.newest.event_ns
                && (tracked.surface, tracked.zoom, tracked.is_pen) == (plane.id, plane.zoom, is_pen)
        };
        if !self.tracked.as_ref().is_some_and(goes_on) {
            solves.extend(self.give_up());
        }
        let mut before = self.tracked.take();
        let stays = |tracked: &TrackedBrush| tracked.head.touches() && !sample.in_air();
        let paused = |tracked: &TrackedBrush| event_ns - tracked.newest.event_ns > BRIDGED_NS;
        if let Some(tracked) = before.as_mut().filter(|tracked| !tracked.waits.is_empty()) {
            let goes_on = !sample.in_air() && !paused(tracked);
            let waits = goes_on.then(|| self.wait(tracked, here, &plane)).flatten();
            if let Some(preview) = waits {
                tracked.newest = here;
                self.tracked = before;
                solves.push(preview);
                return solves;
            }
            solves.extend(self.set_down(tracked, goes_on.then_some(&here), &plane));
        }
        let way_m = before
            .as_ref()
            .filter(|tracked| stays(tracked) && !paused(tracked))
            .map_or(0.0, |tracked| self.path(tracked, &here).length_m());
        let before = self.slow_enough(before, way_m, event_ns);
        let mut tracked = match before {
            Some(mut tracked) if stays(&tracked) && !paused(&tracked) => {
                solves.extend(self.go(&mut tracked, here, &plane));
                tracked.before = Some(tracked.newest);
                tracked
            }
            Some(mut tracked) if stays(&tracked) => {
                solves.push(self.resume(&mut tracked, here, &plane));
                tracked
            }
            Some(mut tracked) if !paused(&tracked) => {
                (tracked.before, tracked.left_over_m) = (None, 0.0);
                if !tracked.is_pressed {
                    tracked.stroke = 0;
                }
                if !sample.in_air() {
                    self.stay(&tracked, event_ns);
                }
                let begins =
                    self.begin_to_wait(&mut tracked, (here, Begins::GoesOn), sample, &plane);
                let mut solve = begins
                    .unwrap_or_else(|| self.land(&mut tracked, here, sample.in_air(), &plane));
                if is_pen && sample.in_air() && tracked.head.touches() {
                    // The pen was released too far away to follow a bend there.
                    tracked.head.leap(&self.tuft, &here.pose);
                    solve = self.land(&mut tracked, here, true, &plane);
                }
                solves.push(solve);
                tracked
            }
            lost => {
                let mut tracked = self.fresh(lost, &plane, here, is_pen);
                let begins = self.begin_to_wait(&mut tracked, (here, Begins::Anew), sample, &plane);
                let mut solve = begins
                    .unwrap_or_else(|| self.land(&mut tracked, here, sample.in_air(), &plane));
                solve.flags |= solve_flags::RESTARTED;
                solves.push(solve);
                tracked
            }
        };
        tracked.newest = here;
        tracked.is_pressed = is_pen && !sample.in_air();
        self.keep(tracked);
        solves
    }

    /// Begins another stroke with the bend from before a pause in contact: a head that landed anew would be dragged
    /// round to that bend, and leave a notch.
    fn resume(&mut self, tracked: &mut TrackedBrush, here: Sampled, plane: &Plane) -> Solve {
        (tracked.before, tracked.left_over_m) = (None, 0.0);
        let brush = self.placed(tracked, &here);
        tracked.head.slide(&self.tuft, &brush);
        let mut solve = self.solve(tracked, here, plane);
        tracked.force_n = tracked.head.force_n();
        solve.flags |= solve_flags::RESTARTED;
        solve
    }

    /// Solves a brush that was in the air at the previous sample. A pen is posed so that its mark is at its point.
    fn land(
        &mut self,
        tracked: &mut TrackedBrush,
        here: Sampled,
        in_air: bool,
        plane: &Plane,
    ) -> Solve {
        tracked.lead = Lead::default();
        if tracked.is_pen && !in_air {
            for _ in 0..LANDINGS {
                let mut tried = tracked.clone();
                let brush = self.placed(&tried, &here);
                self.bend(&mut tried, &brush, plane);
                let Some(middle) = self.mark.middle(&brush, &tried.head.angles()) else {
                    break;
                };
                tracked.bent = middle - point_of(&here.pose) - tracked.lead.shift;
                tracked.lead = Lead::landed(tracked.bent, self.tabled(tracked, &here));
            }
        }
        let solve = self.solve(tracked, here, plane);
        tracked.force_n = tracked.head.force_n();
        solve
    }

    /// Pose of a brush at a sample.
    fn placed(&self, tracked: &TrackedBrush, at: &Sampled) -> Rigid {
        let mut brush = at.pose;
        brush.translation += tracked.lead.shift.extend(0.0);
        self.tuft.raise(&mut brush, self.file.length_m());
        brush
    }

    /// Updates the lead of a pen after a path, so that the mark comes to its point.
    fn lead(&mut self, tracked: &mut TrackedBrush, end: &Sampled, way_m: f64) {
        if !tracked.is_pen {
            return;
        }
        let brush = self.placed(tracked, end);
        if let Some(middle) = self.mark.middle(&brush, &tracked.head.angles()) {
            let beside = middle - point_of(&end.pose);
            tracked.bent = beside - tracked.lead.shift;
            let tabled = self.tabled(tracked, end);
            tracked.lead.go(beside, tabled, way_m, self.file.length_m());
        }
    }

    /// Offset of the mark from the point of a pen that is set down in the current pose, from the table, m.
    fn tabled(&self, tracked: &TrackedBrush, at: &Sampled) -> DVec2 {
        let of = |table: &Beside| table.at(&at.pose, tracked.bent, self.file.length_m());
        self.beside.as_ref().map_or(DVec2::ZERO, of)
    }

    /// Solves the table of marks if it is absent.
    fn solve_table(&mut self) {
        if self.beside.is_none() {
            let (layout, length) = (self.file.spines.layout, self.file.length_m());
            let (mark, tuft, settings) = (&mut self.mark, &self.tuft, &self.settings);
            self.beside = Some(Beside::of(mark, layout, tuft, settings, length));
        }
    }

    /// How far down the head reaches.
    fn reach(&self) -> Reach<'_> {
        Reach {
            tuft: &self.tuft,
            length_m: self.file.length_m(),
            desk: self.desk.as_ref(),
            set: &self.set.angles,
        }
    }

    /// Surface below a sample. A stroke stays on the surface where it began, even beyond its edge.
    fn plane_under(&self, sample: &StylusSample) -> Option<Plane> {
        let desk = self.desk.as_ref()?;
        let in_stroke = |tracked: &&TrackedBrush| tracked.is_pressed || tracked.head.touches();
        let stroke = self.tracked.as_ref().filter(in_stroke);
        let kept = stroke.and_then(|tracked| desk.plane(tracked.surface));
        kept.or_else(|| desk.under(aim(sample, self.file.length_m())))
            .copied()
    }

    /// Bends all spines of a brush that has moved.
    fn solve(&mut self, tracked: &mut TrackedBrush, at: Sampled, plane: &Plane) -> Solve {
        let brush = self.placed(tracked, &at);
        let touched = tracked.head.touches();
        let mut converged = self.bend(tracked, &brush, plane);
        let loses = tracked.is_pressed && (touched || !converged) && !tracked.head.touches();
        if loses && self.reach().lowest_at_rest(&brush) < 0.0 {
            // The head is bent away from a surface that it would reach unbent; kept so, it would leave a gap in the
            // stroke.
            tracked.head.leap(&self.tuft, &brush);
            converged = self.bend(tracked, &brush, plane);
        }
        converged &= self.reshape(tracked, &brush, plane);
        if touched && !tracked.head.touches() {
            converged = self.settle(tracked, &brush, plane);
        }
        let contacts = tracked.head.contacts();
        let stroke = if contacts.is_empty() {
            0
        } else {
            self.strokes.touch(at.event_ns)
        };
        tracked.stroke = tracked.stroke.max(stroke);
        let angles_rad = if contacts.is_empty() {
            tracked.head.set(&self.tuft)
        } else {
            tracked.head.angles()
        };
        let in_surface = Rigid {
            translation: brush.translation / plane.zoom,
            ..brush
        };
        Solve {
            event_ns: at.event_ns,
            stroke,
            surface: tracked.surface,
            flags: if converged {
                0
            } else {
                solve_flags::NOT_CONVERGED
            },
            pose: in_surface.to_pose(),
            zoom: plane.zoom,
            angles_rad,
            contacts,
        }
    }

    /// Bends all spines of a brush at pose `brush`; true if all of them converged.
    fn bend(&mut self, tracked: &mut TrackedBrush, brush: &Rigid, plane: &Plane) -> bool {
        let length = self.file.length_m();
        let obstacles = match &self.desk {
            Some(desk) => desk.obstacles(plane, brush.translation, length),
            None => vec![Obstacle::ground()],
        };
        let (room, settings) = (&mut self.solver, &self.settings);
        tracked
            .head
            .solve(room, &self.tuft, brush, &obstacles, settings)
    }

    /// Extends the stroke to the next solve, however long the pause between samples, while the brush touches or its
    /// pen is pressed, even beyond an edge.
    fn stay(&mut self, tracked: &TrackedBrush, until_ns: u64) {
        let presses_on = tracked.is_pressed && tracked.stroke == self.strokes.number();
        if tracked.head.touches() || presses_on && tracked.stroke > 0 {
            self.strokes.extend(until_ns);
        }
    }

    fn fresh(
        &mut self,
        lost: Option<TrackedBrush>,
        plane: &Plane,
        here: Sampled,
        is_pen: bool,
    ) -> TrackedBrush {
        lost.into_iter().for_each(|lost| self.put_down(lost));
        let mut brush = here.pose;
        self.tuft.raise(&mut brush, self.file.length_m());
        TrackedBrush {
            surface: plane.id,
            zoom: plane.zoom,
            head: SolvedHead::bent(&self.tuft, &brush, &self.set.angles),
            newest: here,
            is_pen,
            is_pressed: false,
            stroke: 0,
            lead: Lead::default(),
            bent: DVec2::ZERO,
            force_n: 0.0,
            before: None,
            left_over_m: 0.0,
            waits: Waiting::default(),
            reshaped: None,
        }
    }
}

mod bend;
mod force;
mod height;
mod messages;
mod path;
mod setting_down;
#[cfg(test)]
mod stroke_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod waiting_tests;
