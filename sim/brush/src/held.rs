//! The spines of a brush in the hand: bent one after the other, among walls and each other.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_types::brush::Contact;

use crate::core_spine;
use crate::desk::Obstacle;
use crate::energy::bond::Bond;
use crate::energy::friction::Anisotropy;
use crate::file::BrushFile;
use crate::solver::{Neighbour, Settings, Solver, Stop};
use crate::spine::SpineShape;
use crate::tuft::{Seat, Tuft};

/// Times that all spines are solved where the head is put down anew: each sees the others as they
/// were, and nothing was before.
const SETTLING: usize = 3;

/// The handle has moved where it is farther than this from where it was, m.
const MOVED_M: f64 = 1e-6;

/// A spine and what it touches.
#[derive(Clone, Debug)]
struct HeldSpine {
    shape: SpineShape,
    /// Those of the first obstacle, the surface, come first: one a joint.
    stops: Vec<Stop>,
    ends: Vec<DVec3>,
}

/// All spines of a head, in the frame of a surface, m.
#[derive(Clone, Debug)]
pub struct HeldHead {
    spines: Vec<HeldSpine>,
    core: HeldSpine,
    fresh: bool,
}

/// Solves head after head in the same room.
#[derive(Clone, Debug, Default)]
pub struct HeadSolver {
    solver: Solver,
    ends: Vec<Vec<DVec3>>,
    neighbours: Vec<Neighbour>,
    /// Frames of the core's segments.
    frames: Vec<DQuat>,
    bonds: Vec<Bond>,
}

impl HeldSpine {
    fn at_rest(seat: &Seat, brush: &Rigid) -> Self {
        let shape = seat.at_rest(brush);
        let joints = seat.spine.joints();
        Self {
            stops: Stop::on_surface(joints),
            ends: (0..joints).map(|i| shape.joint(&seat.spine, i)).collect(),
            shape,
        }
    }
}

impl HeldHead {
    /// A head at rest at `brush`.
    #[must_use]
    pub fn at_rest(tuft: &Tuft, brush: &Rigid) -> Self {
        let at_rest = |seat: &Seat| HeldSpine::at_rest(seat, brush);
        Self {
            spines: tuft.seats.iter().map(at_rest).collect(),
            core: at_rest(&tuft.core.seat),
            fresh: true,
        }
    }

    /// Slides a head along the surface to `brush`, bent and touching as it is: nothing is dragged.
    pub fn slide(&mut self, tuft: &Tuft, brush: &Rigid) {
        let to = tuft.core.seat.held(brush).translation;
        let by = (to - self.core.shape.root).with_z(0.0);
        for spine in self.spines.iter_mut().chain([&mut self.core]) {
            spine.shape.root += by;
            spine.ends.iter_mut().for_each(|end| *end += by);
            let anchors = spine.stops.iter_mut().flat_map(|stop| &mut stop.anchor);
            anchors.for_each(|anchor| *anchor += by);
        }
    }

    /// Whether a joint touches the surface.
    #[must_use]
    pub fn touches(&self) -> bool {
        self.on_surface().any(|(_, stop)| stop.touches())
    }

    /// The normal force of all contacts with the surface, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.on_surface().map(|(_, stop)| stop.force_n).sum()
    }

    /// What touches the surface.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        self.on_surface()
            .filter(|(_, stop)| stop.touches())
            .map(|(spine, stop)| Contact {
                spine: spine as u16,
                joint: (stop.joint + 1) as u16,
                force_n: stop.force_n as f32,
            })
            .collect()
    }

    fn on_surface(&self) -> impl Iterator<Item = (usize, &Stop)> {
        self.spines.iter().enumerate().flat_map(|(number, spine)| {
            let joints = spine.ends.len();
            let stops = spine.stops[..joints].iter();
            // Beside a raised palette a joint may lean on its edge.
            let upon = stops.filter(|stop| stop.wall.normal.z > 0.5);
            upon.map(move |stop| (number, stop))
        })
    }

    /// θ and φ of all joints, spine after spine.
    #[must_use]
    pub fn angles(&self) -> Vec<[f32; 2]> {
        let joints = self.spines.iter().map(|spine| spine.ends.len()).sum();
        let mut angles = Vec::with_capacity(joints);
        self.spines
            .iter()
            .for_each(|spine| spine.shape.angles(&mut angles));
        angles
    }

    /// The farthest that a joint moved along the surface from where it was in `before` while it
    /// touched in both, m.
    #[must_use]
    pub fn moved_in_contact(&self, before: &Self) -> f64 {
        let spines = self.spines.iter().zip(&before.spines);
        spines
            .flat_map(|(now, then)| {
                let stops = now.stops.iter().zip(&then.stops);
                let both = stops.filter(|(a, b)| a.touches() && b.touches());
                both.map(|(stop, _)| (now.ends[stop.joint] - then.ends[stop.joint]).truncate())
            })
            .map(|way| way.length())
            .fold(0.0, f64::max)
    }

    /// Bends all spines of a head that has moved to `brush` outside all `obstacles`, of which the
    /// first is the surface; whether all of them converged.
    pub fn solve(
        &mut self,
        room: &mut HeadSolver,
        tuft: &Tuft,
        brush: &Rigid,
        obstacles: &[Obstacle],
        settings: &Settings,
    ) -> bool {
        room.ends.resize_with(self.spines.len(), Vec::new);
        let anew = std::mem::take(&mut self.fresh) || !self.touches();
        let mut converged = self.bend_core(room, tuft, brush, obstacles, settings);
        core_spine::frames(&self.core.shape, &mut room.frames);
        for (spine, seat) in self.spines.iter_mut().zip(&tuft.seats) {
            let held = seat.held(brush);
            spine.shape.carry(held.translation, held.rotation);
        }
        // The spines beside one are where the handle has carried them.
        for ((spine, seat), ends) in self.spines.iter().zip(&tuft.seats).zip(&mut room.ends) {
            spine.shape.joints(&seat.spine, ends);
        }
        let sweeps = match anew && tuft.crowd_n_m > 0.0 {
            true => SETTLING,
            false => 1,
        };
        for _ in 0..sweeps {
            for (number, (spine, seat)) in self.spines.iter_mut().zip(&tuft.seats).enumerate() {
                tuft.neighbours(number, &room.ends, &mut room.neighbours);
                let (core, frames) = (&tuft.core, &room.frames);
                core.bonds(number, frames, &seat.spine, tuft.bond, &mut room.bonds);
                face(&mut spine.stops, &spine.ends, obstacles);
                let solution = room.solver.solve_bound(
                    &seat.spine,
                    &mut spine.shape,
                    &mut spine.stops,
                    (&room.neighbours, &room.bonds),
                    settings,
                );
                converged &= solution.converged;
                spine.shape.joints(&seat.spine, &mut spine.ends);
                room.ends[number].clone_from(&spine.ends);
            }
        }
        converged
    }

    /// Bends the core of a head that has moved to `brush`. An upright one gives way to where the handle
    /// comes from.
    fn bend_core(
        &mut self,
        room: &mut HeadSolver,
        tuft: &Tuft,
        brush: &Rigid,
        obstacles: &[Obstacle],
        settings: &Settings,
    ) -> bool {
        let (core, seat) = (&mut self.core, &tuft.core.seat);
        let held = seat.held(brush);
        let way = (held.translation - core.shape.root).truncate();
        let yields = match way.length() > MOVED_M {
            true => -way.normalize(),
            false => settings.yields,
        };
        core.shape.carry(held.translation, held.rotation);
        core.shape.joints(&seat.spine, &mut core.ends);
        face(&mut core.stops, &core.ends, obstacles);
        let settings = Settings {
            yields,
            ..*settings
        };
        let (shape, stops) = (&mut core.shape, &mut core.stops);
        let solution = room.solver.solve(&seat.spine, shape, stops, &[], &settings);
        core.shape.joints(&seat.spine, &mut core.ends);
        solution.converged
    }
}

/// Turns each joint's stops to the faces of the obstacles that it is outside of.
fn face(stops: &mut Vec<Stop>, ends: &[DVec3], obstacles: &[Obstacle]) {
    let joints = ends.len();
    stops.truncate(joints * obstacles.len().max(1));
    for (number, obstacle) in obstacles.iter().enumerate() {
        for (joint, end) in ends.iter().enumerate() {
            let wall = obstacle.face_toward(*end);
            match stops.get_mut(number * joints + joint) {
                Some(stop) if stop.wall == wall => {}
                Some(stop) => *stop = Stop::new(joint, wall),
                None => stops.push(Stop::new(joint, wall)),
            }
        }
    }
}

/// What the solver is asked for by a brush file with this tuft.
#[must_use]
pub fn settings_of(file: &BrushFile, tuft: &Tuft) -> Settings {
    let contact = &file.contact;
    Settings {
        friction: contact.friction,
        friction_static: contact.friction_static.unwrap_or(contact.friction),
        anisotropy: Anisotropy {
            share: contact.anisotropy,
            focus: contact.focus,
            ..Anisotropy::default()
        },
        crowd_n_m: tuft.crowd_n_m,
        ..Settings::for_length(file.length_m())
    }
}
