//! Solver of a head: its spines are bent in turn, among obstacles and each other.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_types::brush::Contact;

use crate::core_spine;
use crate::desk::Obstacle;
use crate::energy::bond::Bond;
use crate::energy::friction::Anisotropy;
use crate::file::BrushFile;
use crate::permanent_set;
use crate::solver::{ContactConstraint, Neighbour, Settings, Solver};
use crate::spine::SpineShape;
use crate::spine_layout::SpineLayout;
use crate::spine_root::SpineRoot;

/// Number of passes over all spines where the head is put down anew: each pass uses the others as they were, and
/// there is no earlier state.
const SETTLING: usize = 3;

/// Distance of the handle from its last pose above which it has moved, m.
const MOVED_M: f64 = 1e-6;

/// A spine with its contacts.
#[derive(Clone, Debug)]
struct SolvedSpine {
    shape: SpineShape,
    /// Constraints of the first obstacle, the surface, one a joint, before those of the others.
    constraints: Vec<ContactConstraint>,
    ends: Vec<DVec3>,
}

/// All spines of a head, in the frame of a surface, m.
#[derive(Clone, Debug)]
pub struct SolvedHead {
    spines: Vec<SolvedSpine>,
    core: SolvedSpine,
    fresh: bool,
}

/// Solver of heads, with reused buffers.
#[derive(Clone, Debug, Default)]
pub struct HeadSolver {
    solver: Solver,
    ends: Vec<Vec<DVec3>>,
    neighbours: Vec<Neighbour>,
    /// Frames of the core's segments.
    frames: Vec<DQuat>,
    bonds: Vec<Bond>,
}

impl SolvedSpine {
    fn at_rest(root: &SpineRoot, brush: &Rigid) -> Self {
        let shape = root.at_rest(brush);
        let joints = root.spine.joints();
        Self {
            constraints: ContactConstraint::on_surface(joints),
            ends: (0..joints).map(|i| shape.joint(&root.spine, i)).collect(),
            shape,
        }
    }
}

impl SolvedHead {
    /// A head at rest at `brush`.
    #[must_use]
    pub fn at_rest(tuft: &SpineLayout, brush: &Rigid) -> Self {
        let at_rest = |root: &SpineRoot| SolvedSpine::at_rest(root, brush);
        Self {
            spines: tuft.roots.iter().map(at_rest).collect(),
            core: at_rest(&tuft.core.root),
            fresh: true,
        }
    }

    /// A head in the air with the bend `set` that its joints hold, as [`set`](Self::set) gives it; at rest where that
    /// does not fit.
    #[must_use]
    pub fn bent(tuft: &SpineLayout, brush: &Rigid, set: &[[f32; 2]]) -> Self {
        let mut head = Self::at_rest(tuft, brush);
        let joints = head.angles().len() + head.core.ends.len();
        if set.len() == 2 * joints {
            let (mut angles, mut anchors) = set.split_at(joints);
            let roots = tuft.roots.iter().chain([&tuft.core.root]);
            for (spine, root) in head.all_mut().zip(roots) {
                let (own, held);
                (own, angles) = angles.split_at(spine.ends.len());
                (held, anchors) = anchors.split_at(spine.ends.len());
                permanent_set::bend(&mut spine.shape, own, held);
                spine.shape.joints(&root.spine, &mut spine.ends);
            }
        }
        head
    }

    /// The bend that its joints hold in the air: θ and φ of all spines and of the core, and then their
    /// [anchors](permanent_set::anchors). Of a tuft without inner friction the angles of the spines alone.
    #[must_use]
    pub fn set(&self, tuft: &SpineLayout) -> Vec<[f32; 2]> {
        let mut set = self.angles();
        if tuft.is_plastic() {
            self.core.shape.angles(&mut set);
            let spines = self.spines.iter().chain([&self.core]);
            set.extend(spines.flat_map(|spine| permanent_set::anchors(&spine.shape)));
        }
        set
    }

    /// Takes the head to `brush` through the air, with the bend that its joints hold.
    pub(crate) fn leap(&mut self, tuft: &SpineLayout, brush: &Rigid) {
        *self = Self::bent(tuft, brush, &self.set(tuft));
    }

    /// All spines, and the core.
    fn all_mut(&mut self) -> impl Iterator<Item = &mut SolvedSpine> {
        self.spines.iter_mut().chain([&mut self.core])
    }

    /// Heights of all joints' ends, m.
    pub(crate) fn heights(&self) -> impl Iterator<Item = f64> {
        self.spines
            .iter()
            .flat_map(|spine| spine.ends.iter().map(|end| end.z))
    }

    /// Slides a head along the surface to `brush` with its bend and contacts, without dragging.
    pub fn slide(&mut self, tuft: &SpineLayout, brush: &Rigid) {
        let to = tuft.core.root.frame(brush).translation;
        let by = (to - self.core.shape.root).with_z(0.0);
        for spine in self.all_mut() {
            spine.shape.root += by;
            spine.ends.iter_mut().for_each(|end| *end += by);
            let anchors = spine
                .constraints
                .iter_mut()
                .flat_map(|constraint| &mut constraint.anchor);
            anchors.for_each(|anchor| *anchor += by);
        }
    }

    /// True if a joint touches the surface.
    #[must_use]
    pub fn touches(&self) -> bool {
        self.on_surface()
            .any(|(_, constraint)| constraint.touches())
    }

    /// The normal force of all contacts with the surface, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.on_surface()
            .map(|(_, constraint)| constraint.force_n)
            .sum()
    }

    /// Contacts with the surface.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        self.on_surface()
            .filter(|(_, constraint)| constraint.touches())
            .map(|(spine, constraint)| Contact {
                spine: spine as u16,
                joint: (constraint.joint + 1) as u16,
                force_n: constraint.force_n as f32,
            })
            .collect()
    }

    /// Places of the joints that touch the surface, m.
    pub(crate) fn touching(&self) -> impl Iterator<Item = DVec3> {
        let touching = self
            .on_surface()
            .filter(|(_, constraint)| constraint.touches());
        touching.map(|(spine, constraint)| self.spines[spine].ends[constraint.joint])
    }

    fn on_surface(&self) -> impl Iterator<Item = (usize, &ContactConstraint)> {
        self.spines.iter().enumerate().flat_map(|(number, spine)| {
            let joints = spine.ends.len();
            let constraints = spine.constraints[..joints].iter();
            // Beside a raised palette a joint may lean on its edge.
            let upon = constraints.filter(|constraint| constraint.half_space.normal.z > 0.5);
            upon.map(move |constraint| (number, constraint))
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

    /// Greatest distance, m, that a joint which touches now and in `before` has moved along the surface.
    #[must_use]
    pub fn moved_in_contact(&self, before: &Self) -> f64 {
        let spines = self.spines.iter().zip(&before.spines);
        spines
            .flat_map(|(now, then)| {
                let constraints = now.constraints.iter().zip(&then.constraints);
                let both = constraints.filter(|(a, b)| a.touches() && b.touches());
                both.map(|(constraint, _)| {
                    (now.ends[constraint.joint] - then.ends[constraint.joint]).truncate()
                })
            })
            .map(|way| way.length())
            .fold(0.0, f64::max)
    }

    /// Bends all spines of a head that has moved to `brush` outside all `obstacles`, the first of which is the
    /// surface; true if all converged.
    pub fn solve(
        &mut self,
        room: &mut HeadSolver,
        tuft: &SpineLayout,
        brush: &Rigid,
        obstacles: &[Obstacle],
        settings: &Settings,
    ) -> bool {
        room.ends.resize_with(self.spines.len(), Vec::new);
        let anew = std::mem::take(&mut self.fresh) || !self.touches();
        let mut converged = self.bend_core(room, tuft, brush, obstacles, settings);
        core_spine::frames(&self.core.shape, &mut room.frames);
        for (spine, root) in self.spines.iter_mut().zip(&tuft.roots) {
            let frame = root.frame(brush);
            spine.shape.carry(frame.translation, frame.rotation);
        }
        // Neighbouring spines are where the handle has carried them.
        for ((spine, root), ends) in self.spines.iter().zip(&tuft.roots).zip(&mut room.ends) {
            spine.shape.joints(&root.spine, ends);
        }
        let sweeps = if anew && tuft.repulsion_n_m > 0.0 {
            SETTLING
        } else {
            1
        };
        for _ in 0..sweeps {
            for (number, (spine, root)) in self.spines.iter_mut().zip(&tuft.roots).enumerate() {
                tuft.neighbours(number, &room.ends, &mut room.neighbours);
                let (core, frames) = (&tuft.core, &room.frames);
                core.bonds(number, frames, &root.spine, tuft.bond, &mut room.bonds);
                face(&mut spine.constraints, &spine.ends, obstacles);
                let solution = room.solver.solve_bound(
                    &root.spine,
                    &mut spine.shape,
                    &mut spine.constraints,
                    (&room.neighbours, &room.bonds),
                    settings,
                );
                converged &= solution.converged;
                spine.shape.joints(&root.spine, &mut spine.ends);
                room.ends[number].clone_from(&spine.ends);
            }
        }
        converged
    }

    /// Bends the core of a head that has moved to `brush`. An upright core gives way in the direction from which the
    /// handle comes.
    fn bend_core(
        &mut self,
        room: &mut HeadSolver,
        tuft: &SpineLayout,
        brush: &Rigid,
        obstacles: &[Obstacle],
        settings: &Settings,
    ) -> bool {
        let (core, root) = (&mut self.core, &tuft.core.root);
        let frame = root.frame(brush);
        let way = (frame.translation - core.shape.root).truncate();
        let yields = if way.length() > MOVED_M {
            -way.normalize()
        } else {
            settings.yields
        };
        core.shape.carry(frame.translation, frame.rotation);
        core.shape.joints(&root.spine, &mut core.ends);
        face(&mut core.constraints, &core.ends, obstacles);
        let settings = Settings {
            yields,
            ..*settings
        };
        let (shape, constraints) = (&mut core.shape, &mut core.constraints);
        let solution = room
            .solver
            .solve(&root.spine, shape, constraints, &[], &settings);
        core.shape.joints(&root.spine, &mut core.ends);
        solution.converged
    }
}

/// Sets each joint's constraints to those obstacle faces that it is outside of.
fn face(constraints: &mut Vec<ContactConstraint>, ends: &[DVec3], obstacles: &[Obstacle]) {
    let joints = ends.len();
    constraints.truncate(joints * obstacles.len().max(1));
    for (number, obstacle) in obstacles.iter().enumerate() {
        for (joint, end) in ends.iter().enumerate() {
            let wall = obstacle.face_toward(*end);
            match constraints.get_mut(number * joints + joint) {
                Some(constraint) if constraint.half_space == wall => {}
                Some(constraint) => *constraint = ContactConstraint::new(joint, wall),
                None => constraints.push(ContactConstraint::new(joint, wall)),
            }
        }
    }
}

/// Solver settings for a brush file with this tuft.
#[must_use]
pub fn settings_of(file: &BrushFile, tuft: &SpineLayout) -> Settings {
    let contact = &file.contact;
    Settings {
        friction: contact.friction,
        friction_static: contact.friction_static.unwrap_or(contact.friction),
        anisotropy: Anisotropy {
            share: contact.anisotropy,
            focus: contact.focus,
            ..Anisotropy::default()
        },
        repulsion_n_m: tuft.repulsion_n_m,
        ..Settings::for_length(file.length_m())
    }
}
