//! The brush that follows a stylus: samples in, solved states out.

use glam::DVec3;
use maulstick_num::geometry::Rigid;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, Contact, Solve, solve_flags};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::StylusSample;

use crate::desk::{Desk, aim, ferrule};
use crate::file::BrushFile;
use crate::solver::{Settings, Solver, Touch};
use crate::spine::{Spine, SpineShape};

/// Contacts less than this apart are one stroke, ns.
pub const STROKE_GAP_NS: u64 = 150_000_000;
/// A longer time between samples restarts the solver, ns.
pub const RESTART_NS: u64 = 100_000_000;
/// The handle is held off the surface by at least this share of the head's length.
const LEAST_HEIGHT: f64 = 0.05;

/// A brush in the hand.
#[derive(Debug)]
pub struct BrushModel {
    file: BrushFile,
    depth_share: f64,
    spine: Spine,
    settings: Settings,
    solver: Solver,
    desk: Option<Desk>,
    follows: Option<Origin>,
    held: Option<Held>,
    strokes: u64,
    last_contact_ns: u64,
}

/// The brush after a sample.
#[derive(Clone, Debug)]
struct Held {
    event_ns: u64,
    surface: u32,
    brush: Rigid,
    shape: SpineShape,
    touches: Vec<Touch>,
}

impl BrushModel {
    /// A brush; `depth_share` is the share of its head's length that full pressure presses in.
    #[must_use]
    pub fn new(file: BrushFile, depth_share: f64) -> Self {
        let spine = file.spine();
        let settings = Settings {
            friction: file.contact.friction,
            ..Settings::default()
        };
        Self {
            file,
            depth_share,
            spine,
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
            .flat_map(|held| &held.touches)
            .map(|touch| touch.force_n)
            .sum()
    }

    /// Follows one sample of the device `origin`; none while there is no scene.
    ///
    /// Another device, time that does not advance and a gap of over .1 s restart the solver at the
    /// new pose: the solve says so, and nothing is painted from the one before to it.
    pub fn follow(
        &mut self,
        origin: Origin,
        event_ns: u64,
        sample: &StylusSample,
    ) -> Option<Solve> {
        if self.follows != Some(origin) {
            self.follows = Some(origin);
            self.held = None;
        }
        let length = self.file.length_m();
        let desk = self.desk.as_ref()?;
        let touching = self
            .held
            .as_ref()
            .filter(|held| held.touches.iter().any(is_touching));
        let kept = touching.and_then(|held| desk.plane(held.surface));
        let plane = *kept.or_else(|| desk.under(aim(sample, length)))?;
        let in_desk = ferrule(sample, length, self.depth_share, plane.normal());
        let mut brush = plane.to_surface(&in_desk);
        if !sample.in_range {
            brush.translation.z = brush.translation.z.max(2.0 * length);
        }
        let floor = LEAST_HEIGHT * length;
        brush.translation.z = brush.translation.z.max(floor);
        let usable = self.held.take().filter(|held| {
            event_ns > held.event_ns
                && event_ns - held.event_ns <= RESTART_NS
                && held.surface == plane.id
        });
        let restarted = usable.is_none();
        let mut held = usable.unwrap_or_else(|| self.fresh(plane.id, &brush));
        held.event_ns = event_ns;
        held.shape
            .turn(brush.rotation * held.brush.rotation.conjugate());
        held.shape.base = brush.rotation * DVec3::NEG_Z;
        held.shape.root = brush.translation;
        held.brush = brush;
        let solution = self.solver.solve(
            &self.spine,
            &mut held.shape,
            &mut held.touches,
            &self.settings,
        );
        let mut flags = if restarted { solve_flags::RESTARTED } else { 0 };
        if !solution.converged {
            flags |= solve_flags::NOT_CONVERGED;
        }
        let contacts: Vec<Contact> = held
            .touches
            .iter()
            .enumerate()
            .filter(|(_, touch)| is_touching(touch))
            .map(|(i, touch)| Contact {
                spine: 0,
                joint: u16::try_from(i + 1).unwrap_or(u16::MAX),
                force_n: touch.force_n as f32,
            })
            .collect();
        let stroke = if contacts.is_empty() {
            0
        } else {
            self.stroke(event_ns)
        };
        let mut angles_rad = Vec::with_capacity(self.spine.joints());
        held.shape.angles(brush.rotation, &mut angles_rad);
        let pose = brush.to_pose();
        let surface = held.surface;
        self.held = Some(held);
        Some(Solve {
            event_ns,
            stroke,
            surface,
            flags,
            pose,
            angles_rad,
            contacts,
        })
    }

    /// As [`follow`](Self::follow), as a whole message.
    pub fn state(
        &mut self,
        origin: Origin,
        device_seq: u64,
        event_ns: u64,
        sample: &StylusSample,
    ) -> Option<BrushState> {
        let solve = self.follow(origin, event_ns, sample)?;
        Some(BrushState {
            device: origin.source,
            device_epoch: origin.epoch,
            device_seq,
            solves: vec![solve],
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

    fn fresh(&self, surface: u32, brush: &Rigid) -> Held {
        let joints = self.spine.joints();
        Held {
            event_ns: 0,
            surface,
            brush: *brush,
            shape: SpineShape::straight(brush.translation, brush.rotation, joints),
            touches: vec![Touch::default(); joints],
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
            let solve = model
                .follow(DEVICE, ms * MS, &pen(0.0, 0.0, 0.3))
                .expect("a solve");
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
            model
                .follow(DEVICE, ms * MS, &pen(0.0, 0.0, pressure))
                .expect("a solve");
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
                let solve = model.follow(DEVICE, ns, &sample).expect("a solve");
                prop_assert!(solve.pose.is_valid());
                prop_assert!(solve.angles_rad.iter().flatten().all(|angle| angle.is_finite()));
                prop_assert!(solve.flags & solve_flags::NOT_CONVERGED == 0, "{solve:?}");
                if !in_range {
                    prop_assert!(solve.contacts.is_empty());
                }
            }
        }
    }
}
