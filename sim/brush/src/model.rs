//! The brush that follows a stylus: samples in, solved states out.

use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, Solve, solve_flags};
use maulstick_types::haptics::HermiteKnot;
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::stylus::StylusSample;

use crate::desk::{Desk, Obstacle, Plane, aim, ferrule};
use crate::feel::{AT_ONCE_M, Feel, Press, tuned, tuples};
use crate::file::BrushFile;
use crate::held::{HeadSolver, HeldHead, settings_of};
use crate::solver::Settings;
use crate::tuft::Tuft;
use crate::way::{Piece, Sampled, Way};

/// Contacts less than this apart are one stroke, ns.
pub const STROKE_GAP_NS: u64 = 150_000_000;
/// A longer time between samples restarts the solver, ns.
pub const RESTART_NS: u64 = 100_000_000;
/// The handle is held off the surface by at least this share of the head's length.
const LEAST_HEIGHT: f64 = 0.05;
/// A touching brush is solved each time its handle has moved so far, cells: a little less than one,
/// so that the strips, which may overtake it, seldom move more than one.
const SOLVE_CELLS: f64 = 0.7;
/// Solves between two samples at most: a hand is seldom that fast.
const MOST_SOLVES: f64 = 64.0;
/// Times that a piece of the way is halved at most.
const SPLITS: u32 = 2;

/// A brush in the hand.
#[derive(Debug)]
pub struct BrushModel {
    file: BrushFile,
    depth_share: f64,
    tuft: Tuft,
    settings: Settings,
    solver: HeadSolver,
    desk: Option<Desk>,
    follows: Option<Origin>,
    held: Option<Held>,
    strokes: u64,
    last_contact_ns: u64,
    /// Factor on the stiffness of the file.
    tuned: f64,
}

/// The brush after a sample. Lengths are the desk's, axes those of the surface.
#[derive(Clone, Debug)]
struct Held {
    surface: u32,
    /// Its zoom: on a canvas that is larger the brush bends otherwise.
    zoom: f64,
    head: HeldHead,
    newest: Sampled,
    /// The normal force of all contacts there, N.
    force_n: f64,
    /// The sample before the newest one, if the brush touched there and has since.
    before: Option<Sampled>,
    /// Cells from the newest sample back to where the head was solved last.
    left_over: f64,
}

impl BrushModel {
    /// A brush; `depth_share` is the share of its head's length that full pressure presses in.
    #[must_use]
    pub fn new(file: BrushFile, depth_share: f64) -> Self {
        let tuft = file.tuft();
        let settings = settings_of(&file, &tuft);
        Self {
            file,
            depth_share,
            tuft,
            settings,
            solver: HeadSolver::default(),
            desk: None,
            follows: None,
            held: None,
            strokes: 0,
            last_contact_ns: 0,
            tuned: 1.0,
        }
    }

    /// Takes up another brush, as stiff or soft as it was tuned; strokes are counted on.
    pub fn take_up(&mut self, file: BrushFile) {
        self.tuft = file.tuft();
        self.tuft.stiffen(self.tuned);
        self.settings = settings_of(&file, &self.tuft);
        (self.file, self.held) = (file, None);
    }

    /// The brush file.
    #[must_use]
    pub fn file(&self) -> &BrushFile {
        &self.file
    }

    /// Puts the brush over another scene; before the first, samples give no state.
    pub fn set_scene(&mut self, scene: &Scene) {
        self.desk = Some(Desk::of(scene));
    }

    /// Makes the head stiffer than its file says by this factor, or softer; it keeps its shape.
    pub fn tune(&mut self, factor: f64) {
        if factor != self.tuned && factor.is_finite() && factor > 0.0 {
            self.tuned = factor;
            self.tuft = self.file.tuft();
            self.tuft.stiffen(factor);
            self.settings.crowd_n_m = self.tuft.crowd_n_m;
        }
    }

    /// What the hand feels of the head as it is bent now.
    #[must_use]
    pub fn feel(&self) -> Feel {
        let length = self.file.length_m();
        match &self.held {
            Some(held) => Feel::bent(&self.tuft, length, &held.newest.pose, held.force_n),
            None => Feel::at_rest(&self.tuft, length),
        }
    }

    /// The tuples of the Hermite curve of the head as it is tuned.
    #[must_use]
    pub fn tuples(&self) -> Vec<HermiteKnot> {
        tuned(&tuples(&self.file), self.tuned)
    }

    /// The head as it is pressed now, in the desk frame, and how its force goes with depth: one more
    /// solve, half a millimetre deeper. None in the air.
    #[must_use]
    pub fn press(&mut self) -> Option<Press> {
        let held = self.held.as_ref().filter(|held| held.force_n > 0.0)?;
        let desk = self.desk.as_ref()?;
        let plane = desk.plane(held.surface)?;
        let (here, force_n, mut further) = (held.newest.pose, held.force_n, held.head.clone());
        let mut deeper = here;
        deeper.translation.z -= AT_ONCE_M;
        let obstacles = desk.obstacles(plane, deeper.translation, self.file.length_m());
        let pose = plane.to_desk.after(&here);
        self.raise(&mut deeper);
        let (tuft, settings) = (&self.tuft, &self.settings);
        further.solve(&mut self.solver, tuft, &deeper, &obstacles, settings);
        Some(Press {
            pose,
            force_n,
            stiffness_n_m: ((further.force_n() - force_n) / AT_ONCE_M).max(0.0),
        })
    }

    /// Whether there is a scene.
    #[must_use]
    pub fn has_scene(&self) -> bool {
        self.desk.is_some()
    }

    /// The surface that the brush is over, or the canvas.
    #[must_use]
    pub fn plane(&self) -> Option<&Plane> {
        let surface = self.held.as_ref().map_or(CANVAS, |held| held.surface);
        self.desk.as_ref()?.plane(surface)
    }

    /// The desk, for who needs its planes.
    #[must_use]
    pub fn desk(&self) -> Option<&Desk> {
        self.desk.as_ref()
    }

    /// The normal force of all contacts now, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.held.as_ref().map_or(0.0, |held| held.force_n)
    }

    /// Follows one sample of the device `origin`: none while there is no scene, else the solves on
    /// the way to it, the last at the sample itself.
    ///
    /// A touching brush is solved each time it has moved by about a cell, counted on across samples,
    /// so that its path does not depend on how often it is sampled; between two of these a sample gives
    /// a glimpse. A pen lands and lifts at its sample. Another device, time that does not advance, a zoom
    /// and a gap of over .1 s restart the solver at the new pose: the solve says so, and nothing is
    /// painted from the one before to it.
    pub fn follow(&mut self, origin: Origin, event_ns: u64, sample: &StylusSample) -> Vec<Solve> {
        if self.follows != Some(origin) {
            self.follows = Some(origin);
            self.held = None;
        }
        let Some(plane) = self.plane_under(sample) else {
            return Vec::new();
        };
        let length = self.file.length_m();
        let in_desk = ferrule(sample, length, self.depth_share, &plane.wall());
        let mut brush = plane.to_desk.inverse().after(&in_desk);
        if !sample.in_range {
            brush.translation.z = brush.translation.z.max(2.0 * length);
        }
        self.raise(&mut brush);
        let here = Sampled {
            pose: brush,
            event_ns,
        };
        let usable = self.held.take().filter(|held| {
            event_ns > held.newest.event_ns
                && event_ns - held.newest.event_ns <= RESTART_NS
                && (held.surface, held.zoom) == (plane.id, plane.zoom)
        });
        let Some(mut held) = usable else {
            let mut held = self.fresh(&plane, here);
            let mut solve = self.solve(&mut held, here, &plane);
            solve.flags |= solve_flags::RESTARTED;
            held.force_n = held.head.force_n();
            self.held = Some(held);
            return vec![solve];
        };
        let solves = if held.head.touches() && !sample.in_air() {
            let solves = self.go(&mut held, here, &plane);
            held.before = Some(held.newest);
            solves
        } else {
            (held.before, held.left_over) = (None, 0.0);
            let solve = self.solve(&mut held, here, &plane);
            held.force_n = held.head.force_n();
            vec![solve]
        };
        held.newest = here;
        self.held = Some(held);
        solves
    }

    /// Holds the ferrule so high that no spine begins below the surface.
    fn raise(&self, brush: &mut Rigid) {
        let least = LEAST_HEIGHT * self.file.length_m();
        brush.translation.z += (least - self.tuft.lowest_root(brush)).max(0.0);
    }

    /// Solves a touching brush at each cell of its way to a sample, and gives a glimpse of it there.
    fn go(&mut self, held: &mut Held, here: Sampled, plane: &Plane) -> Vec<Solve> {
        let start_ns = held.newest.event_ns;
        let way = Way::new(
            held.before.as_ref(),
            &held.newest,
            &here,
            self.file.length_m(),
        );
        let cell_m = plane.cell_m * plane.zoom;
        let motion = way.length_m() / cell_m;
        let part = (motion / MOST_SOLVES).max(SOLVE_CELLS);
        let whole = held.left_over + motion;
        let mut solves = Vec::new();
        let (mut cells, mut at) = (part, 0.0);
        while cells <= whole {
            let s = way.after((cells - held.left_over) * cell_m);
            let piece = Piece {
                way: &way,
                from: at,
                to: s,
                start_ns,
                end_ns: here.event_ns,
            };
            self.walk(held, &piece, plane, SPLITS, &mut solves);
            (cells, at) = (cells + part, s);
        }
        held.left_over = whole - (cells - part);
        let mut seen = held.clone();
        let mut glimpse = self.solve(&mut seen, here, plane);
        held.force_n = seen.head.force_n();
        glimpse.flags |= solve_flags::GLIMPSE;
        solves.push(glimpse);
        solves
    }

    /// Solves the end of a piece of the way, and first its middle where a joint in contact would move
    /// more than a cell.
    fn walk(
        &mut self,
        held: &mut Held,
        piece: &Piece<'_>,
        plane: &Plane,
        splits: u32,
        solves: &mut Vec<Solve>,
    ) {
        let mut tried = held.clone();
        let strokes = (self.strokes, self.last_contact_ns);
        let mut end = piece.end();
        self.raise(&mut end.pose);
        let solve = self.solve(&mut tried, end, plane);
        let moved = tried.head.moved_in_contact(&held.head);
        if splits > 0 && moved > plane.cell_m * plane.zoom {
            (self.strokes, self.last_contact_ns) = strokes;
            let [first, second] = piece.halves();
            self.walk(held, &first, plane, splits - 1, solves);
            self.walk(held, &second, plane, splits - 1, solves);
            return;
        }
        *held = tried;
        solves.push(solve);
    }

    /// The surface that a sample is over; a touching brush stays on the one that it touches.
    fn plane_under(&self, sample: &StylusSample) -> Option<Plane> {
        let desk = self.desk.as_ref()?;
        let touching = self.held.as_ref().filter(|held| held.head.touches());
        let kept = touching.and_then(|held| desk.plane(held.surface));
        kept.or_else(|| desk.under(aim(sample, self.file.length_m())))
            .copied()
    }

    /// Bends all spines of a brush that has moved.
    fn solve(&mut self, held: &mut Held, at: Sampled, plane: &Plane) -> Solve {
        let brush = &at.pose;
        let length = self.file.length_m();
        let obstacles = match &self.desk {
            Some(desk) => desk.obstacles(plane, brush.translation, length),
            None => vec![Obstacle::ground()],
        };
        let converged = held.head.solve(
            &mut self.solver,
            &self.tuft,
            brush,
            &obstacles,
            &self.settings,
        );
        let contacts = held.head.contacts();
        let stroke = if contacts.is_empty() {
            0
        } else {
            self.stroke(at.event_ns)
        };
        let in_surface = Rigid {
            translation: brush.translation / plane.zoom,
            ..*brush
        };
        Solve {
            event_ns: at.event_ns,
            stroke,
            surface: held.surface,
            flags: if converged {
                0
            } else {
                solve_flags::NOT_CONVERGED
            },
            pose: in_surface.to_pose(),
            zoom: plane.zoom,
            angles_rad: held.head.angles(),
            contacts,
        }
    }

    /// As [`follow`](Self::follow), as a whole message.
    pub fn state(
        &mut self,
        origin: Origin,
        device_seq: u64,
        event_ns: u64,
        sample: &StylusSample,
    ) -> Option<BrushState> {
        let solves = self.follow(origin, event_ns, sample);
        (!solves.is_empty()).then_some(BrushState {
            device: origin.source,
            device_epoch: origin.epoch,
            device_seq,
            solves,
        })
    }

    /// The stroke of a contact at `event_ns`.
    fn stroke(&mut self, event_ns: u64) -> u64 {
        let apart = event_ns.abs_diff(self.last_contact_ns) >= STROKE_GAP_NS;
        if self.strokes == 0 || apart {
            self.strokes += 1;
        }
        self.last_contact_ns = event_ns;
        self.strokes
    }

    fn fresh(&self, plane: &Plane, here: Sampled) -> Held {
        Held {
            surface: plane.id,
            zoom: plane.zoom,
            head: HeldHead::at_rest(&self.tuft, &here.pose),
            newest: here,
            force_n: 0.0,
            before: None,
            left_over: 0.0,
        }
    }
}

#[cfg(test)]
mod tests;
