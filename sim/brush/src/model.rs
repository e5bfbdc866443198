//! The brush that follows a stylus: samples in, solved states out.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, Contact, Solve, solve_flags};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::StylusSample;

use crate::desk::{Desk, Plane, aim, ferrule};
use crate::file::BrushFile;
use crate::solver::{Settings, Solver, Touch};
use crate::spine::SpineShape;
use crate::tuft::{Seat, Tuft};
use crate::way::{Sampled, Way};

/// Contacts less than this apart are one stroke, ns.
pub const STROKE_GAP_NS: u64 = 150_000_000;
/// A longer time between samples restarts the solver, ns.
pub const RESTART_NS: u64 = 100_000_000;
/// The handle is held off the surface by at least this share of the head's length.
const LEAST_HEIGHT: f64 = 0.05;
/// A touching brush is solved each time its handle has moved so far, cells: a little less than one,
/// so that the strips, which may overtake it, seldom move more than one.
const SOLVE_CELLS: f64 = 0.9;
/// Solves between two samples at most: a hand is seldom that fast.
const MOST_SOLVES: f64 = 64.0;

/// A brush in the hand.
#[derive(Debug)]
pub struct BrushModel {
    file: BrushFile,
    depth_share: f64,
    tuft: Tuft,
    settings: Settings,
    solver: Solver,
    desk: Option<Desk>,
    follows: Option<Origin>,
    held: Option<Held>,
    strokes: u64,
    last_contact_ns: u64,
}

/// A spine and what it touches.
#[derive(Clone, Debug)]
struct HeldSpine {
    shape: SpineShape,
    touches: Vec<Touch>,
}

/// The brush after a sample. Lengths are the desk's, axes those of the surface.
#[derive(Clone, Debug)]
struct Held {
    surface: u32,
    /// Where the spines were solved last.
    brush: Rigid,
    spines: Vec<HeldSpine>,
    newest: Sampled,
    /// The sample before the newest one, if the brush touched there and has since.
    before: Option<Sampled>,
    /// Cells from the newest sample back to `brush`.
    left_over: f64,
}

impl Held {
    fn touches(&self) -> bool {
        let mut touches = self.spines.iter().flat_map(|spine| &spine.touches);
        touches.any(is_touching)
    }
}

impl BrushModel {
    /// A brush; `depth_share` is the share of its head's length that full pressure presses in.
    #[must_use]
    pub fn new(file: BrushFile, depth_share: f64) -> Self {
        let tuft = file.tuft();
        let settings = Settings {
            friction: file.contact.friction,
            ..Settings::default()
        };
        Self {
            file,
            depth_share,
            tuft,
            settings,
            solver: Solver::default(),
            desk: None,
            follows: None,
            held: None,
            strokes: 0,
            last_contact_ns: 0,
        }
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

    /// Whether there is a scene.
    #[must_use]
    pub fn has_scene(&self) -> bool {
        self.desk.is_some()
    }

    /// The desk, for who needs its planes.
    #[must_use]
    pub fn desk(&self) -> Option<&Desk> {
        self.desk.as_ref()
    }

    /// The normal force of all contacts now, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.held
            .iter()
            .flat_map(|held| &held.spines)
            .flat_map(|spine| &spine.touches)
            .map(|touch| touch.force_n)
            .sum()
    }

    /// Follows one sample of the device `origin`: none while there is no scene, else the solves on
    /// the way to it, the last at the sample itself.
    ///
    /// A touching brush is solved each time it has moved by about a cell, counted on across samples,
    /// so that its path does not depend on how often it is sampled; between two of these a sample gives
    /// a glimpse. A pen lands and lifts at its sample. Another device, time that does not advance
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
        let in_desk = ferrule(sample, length, self.depth_share, plane.normal());
        let mut brush = plane.to_desk.inverse().after(&in_desk);
        if !sample.in_range {
            brush.translation.z = brush.translation.z.max(2.0 * length);
        }
        brush.translation.z = brush.translation.z.max(LEAST_HEIGHT * length);
        let here = Sampled {
            pose: brush,
            event_ns,
        };
        let usable = self.held.take().filter(|held| {
            event_ns > held.newest.event_ns
                && event_ns - held.newest.event_ns <= RESTART_NS
                && held.surface == plane.id
        });
        let Some(mut held) = usable else {
            let mut held = self.fresh(plane.id, here);
            let mut solve = self.solve(&mut held, here, plane.zoom);
            solve.flags |= solve_flags::RESTARTED;
            self.held = Some(held);
            return vec![solve];
        };
        let solves = if held.touches() && !sample.in_air() {
            let solves = self.go(&mut held, here, &plane);
            held.before = Some(held.newest);
            solves
        } else {
            (held.before, held.left_over) = (None, 0.0);
            vec![self.solve(&mut held, here, plane.zoom)]
        };
        held.newest = here;
        self.held = Some(held);
        solves
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
        let mut cells = part;
        while cells <= whole {
            let s = way.after((cells - held.left_over) * cell_m);
            let mut pose = way.at(s);
            pose.translation.z = pose.translation.z.max(LEAST_HEIGHT * self.file.length_m());
            let event_ns = start_ns + ((here.event_ns - start_ns) as f64 * s) as u64;
            solves.push(self.solve(held, Sampled { pose, event_ns }, plane.zoom));
            cells += part;
        }
        held.left_over = whole - (cells - part);
        let mut glimpse = self.solve(&mut held.clone(), here, plane.zoom);
        glimpse.flags |= solve_flags::GLIMPSE;
        solves.push(glimpse);
        solves
    }

    /// The surface that a sample is over; a touching brush stays on the one that it touches.
    fn plane_under(&self, sample: &StylusSample) -> Option<Plane> {
        let desk = self.desk.as_ref()?;
        let touching = self.held.as_ref().filter(|held| held.touches());
        let kept = touching.and_then(|held| desk.plane(held.surface));
        kept.or_else(|| desk.under(aim(sample, self.file.length_m())))
            .copied()
    }

    /// Bends all spines of a brush that has moved to `brush`.
    fn solve(&mut self, held: &mut Held, at: Sampled, zoom: f64) -> Solve {
        let (brush, event_ns) = (&at.pose, at.event_ns);
        let turn = brush.rotation * held.brush.rotation.conjugate();
        let mut flags = 0;
        let mut contacts = Vec::new();
        let joints = self.tuft.spine.joints();
        let mut angles_rad = Vec::with_capacity(self.tuft.seats.len() * joints);
        for (number, (spine, seat)) in held.spines.iter_mut().zip(&self.tuft.seats).enumerate() {
            let frame = seat.held(brush);
            spine.shape.turn(turn);
            spine.shape.base = frame.rotation * DVec3::NEG_Z;
            spine.shape.root = frame.translation;
            let solution = self.solver.solve(
                &self.tuft.spine,
                &mut spine.shape,
                &mut spine.touches,
                &self.settings,
            );
            if !solution.converged {
                flags |= solve_flags::NOT_CONVERGED;
            }
            for (i, touch) in spine
                .touches
                .iter()
                .enumerate()
                .filter(|(_, t)| is_touching(t))
            {
                contacts.push(Contact {
                    spine: number as u16,
                    joint: (i + 1) as u16,
                    force_n: touch.force_n as f32,
                });
            }
            spine.shape.angles(frame.rotation, &mut angles_rad);
        }
        held.brush = *brush;
        let stroke = if contacts.is_empty() {
            0
        } else {
            self.stroke(event_ns)
        };
        let surface = held.surface;
        let in_surface = Rigid {
            translation: brush.translation / zoom,
            ..*brush
        };
        Solve {
            event_ns,
            stroke,
            surface,
            flags,
            pose: in_surface.to_pose(),
            angles_rad,
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

    fn fresh(&self, surface: u32, here: Sampled) -> Held {
        let joints = self.tuft.spine.joints();
        let straight = |seat: &Seat| {
            let frame = seat.held(&here.pose);
            HeldSpine {
                shape: SpineShape::straight(frame.translation, frame.rotation, joints),
                touches: vec![Touch::default(); joints],
            }
        };
        Held {
            surface,
            brush: here.pose,
            spines: self.tuft.seats.iter().map(straight).collect(),
            newest: here,
            before: None,
            left_over: 0.0,
        }
    }
}

fn is_touching(touch: &Touch) -> bool {
    touch.force_n > 0.0
}

#[cfg(test)]
mod tests {
    use maulstick_types::Pose;
    use maulstick_types::scene::{Light, Surface};
    use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose};
    use proptest::prelude::*;

    use super::*;

    const DEVICE: Origin = Origin {
        source: 1,
        epoch: 1,
    };
    const MS: u64 = 1_000_000;

    fn scene() -> Scene {
        let canvas = Surface {
            id: 0,
            pose: Pose {
                position_m: [-0.128, -0.128, 0.0],
                ..Pose::IDENTITY
            },
            zoom: 1.0,
            cells: [1024; 2],
            cell_m: 2.5e-4,
            ground: "gesso".into(),
            tooth: "linen".into(),
            tooth_seed: 1,
            wells: Vec::new(),
        };
        let light = Light {
            direction: [0.0, 0.0, 1.0],
            intensity: 1.0,
            illuminant: "D65".into(),
        };
        Scene {
            version: 1,
            surfaces: vec![canvas],
            paints: Vec::new(),
            light,
        }
    }

    fn brush() -> BrushModel {
        let mut model = BrushModel::new(BrushFile::library("round").expect("round"), 0.5);
        model.set_scene(&scene());
        model
    }

    fn pen(x: f64, y: f64, pressure: f64) -> StylusSample {
        let pose = StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        };
        StylusSample {
            pose,
            in_range: true,
            ..StylusSample::away()
        }
    }

    #[test]
    fn strokes_are_numbered_by_the_gap_rule() {
        let mut model = brush();
        let mut stroke = |ms: u64, pressure: f64| {
            model
                .follow(DEVICE, ms * MS, &pen(0.0, 0.0, pressure))
                .last()
                .expect("a solve")
                .stroke
        };
        assert_eq!(stroke(1000, 0.0), 0);
        assert_eq!((stroke(1010, 0.3), stroke(1020, 0.3)), (1, 1));
        assert_eq!(stroke(1090, 0.0), 0);
        assert_eq!(
            stroke(1169, 0.3),
            1,
            "149 ms without contact is the same stroke"
        );
        assert_eq!(stroke(1250, 0.0), 0);
        assert_eq!(stroke(1319, 0.3), 2, "150 ms is a new one");
    }

    #[test]
    fn time_that_stands_still_or_jumps_restarts_the_solver() {
        let mut model = brush();
        let mut restarted = |ms: u64| {
            let solve = model.follow(DEVICE, ms * MS, &pen(0.0, 0.0, 0.3));
            let solve = solve.last().expect("a solve");
            solve.flags & solve_flags::RESTARTED != 0
        };
        assert!(restarted(1000));
        assert!(!restarted(1010) && !restarted(1110));
        assert!(restarted(1110), "no time has passed");
        assert!(restarted(1100), "time runs backward");
        assert!(restarted(1201), "over .1 s has passed");
    }

    #[test]
    fn a_pressed_brush_bends_and_pushes_back() {
        let mut model = brush();
        let mut force = |ms: u64, pressure: f64| {
            model.follow(DEVICE, ms * MS, &pen(0.0, 0.0, pressure));
            model.force_n()
        };
        let (light, full) = (force(1000, 0.1), force(1010, 1.0));
        assert!(
            light > 0.0 && full > light && full < 3.0,
            "{light} N, {full} N"
        );
        assert_eq!(force(1020, 0.0), 0.0);
    }

    proptest! {
        // A leap is solved at up to 64 places for each of seven spines.
        #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases / 16))]

        #[test]
        fn no_sample_breaks_the_brush(
            samples in prop::collection::vec(
                (0u64..200, -0.3..0.3f64, -0.3..0.3f64, 0.0..=1.0f64, -1.4..1.4f64, -1.4..1.4f64, any::<bool>()),
                1..40,
            )
        ) {
            let mut model = brush();
            let mut ns = 1_000_000_000;
            for (dt, x, y, pressure, tilt_x, tilt_y, in_range) in samples {
                ns += dt * MS;
                let pose = StylusPose::Contact {
                    point_m: [x, y, 0.0],
                    tilt_rad: [tilt_x, tilt_y],
                    twist_rad: 0.0,
                    pressure,
                };
                let sample = StylusSample { pose, in_range, ..StylusSample::away() };
                let solves = model.follow(DEVICE, ns, &sample);
                prop_assert!(solves.last().is_some_and(|solve| solve.event_ns == ns));
                for solve in &solves {
                    prop_assert!(solve.pose.is_valid());
                    prop_assert!(solve.angles_rad.iter().flatten().all(|angle| angle.is_finite()));
                    prop_assert!(solve.flags & solve_flags::NOT_CONVERGED == 0, "{solve:?}");
                }
                if !in_range {
                    prop_assert!(solves.last().is_some_and(|solve| solve.contacts.is_empty()));
                }
            }
        }
    }
}
