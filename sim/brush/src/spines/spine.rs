//! A spine: segments joined by springs, its shape the unit directions of its segments.
//!
//! Energy and constraints depend on the directions alone: the bending angle of a joint is the angle
//! between two neighbours, and every joint's place is linear in them. The solver therefore works on
//! directions, which have no singular pose; θ and φ (Baxter 2004, eq. 3.10, with R = R_y(φ)·R_x(θ))
//! are how a shape travels in messages.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::shortest_arc;
use maulstick_num::{acos, atan2, sin_cos};

use crate::energy::spring::rest_after;

/// Lengths, stiffness and friction of a spine.
#[derive(Clone, Debug, PartialEq)]
pub struct Spine {
    /// Lengths of the segments, m, from the ferrule to the point.
    pub lengths_m: Vec<f64>,
    /// Stiffness K of the joint at the beginning of each segment, N·m/rad.
    pub stiffness: Vec<f64>,
    /// Inner friction D of each joint (Baxter 2004, eq. 3.4), N·m.
    pub damping: Vec<f64>,
    /// Direction of each segment at rest if the one before goes along −z of the spine's frame, unit vectors; empty for
    /// a spine that is straight at rest.
    pub rest: Vec<DVec3>,
}

impl Spine {
    /// A spine of `joints` equal segments with bending stiffness `ei` (N·m²): K = EI/l, doubled at the clamp, between
    /// which and the first joint there is only half a segment. With the doubling the chain converges to the beam with
    /// second order in its segments; without, with first.
    #[must_use]
    pub fn uniform(length_m: f64, joints: usize, ei: f64) -> Self {
        let segment = length_m / joints as f64;
        let mut stiffness = vec![ei / segment; joints];
        stiffness[0] *= 2.0;
        Self {
            lengths_m: vec![segment; joints],
            damping: vec![0.0; joints],
            stiffness,
            rest: Vec::new(),
        }
    }

    /// This spine with a shape at rest: the direction of each segment in the spine's frame.
    #[must_use]
    pub fn resting(mut self, directions: &[DVec3]) -> Self {
        self.rest.clear();
        let mut before = DVec3::NEG_Z;
        for direction in directions {
            self.rest
                .push(shortest_arc(before, DVec3::NEG_Z) * *direction);
            before = *direction;
        }
        self
    }

    /// This spine with inner friction: `share` of the torque that the spring of a joint has at 1 rad.
    #[must_use]
    pub fn damped(mut self, share: f64) -> Self {
        self.damping = self.stiffness.iter().map(|k| share * k).collect();
        self
    }

    /// Number of joints, equal to that of segments.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.lengths_m.len()
    }

    /// Length of the whole spine, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.lengths_m.iter().sum()
    }

    /// Stiffness of the stiffest joint, N·m/rad.
    #[must_use]
    pub fn stiffest(&self) -> f64 {
        self.stiffness.iter().copied().fold(0.0, f64::max)
    }
}

/// Shape of a spine in space.
#[derive(Clone, Debug, PartialEq)]
pub struct SpineShape {
    /// Position of the root.
    pub root: DVec3,
    /// Orientation of the base frame: an unbent spine points along its −z.
    pub frame: DQuat,
    /// Unit direction of each segment.
    pub directions: Vec<DVec3>,
    /// Unit direction to which the inner friction of its joint draws each segment.
    pub anchors: Vec<DVec3>,
}

/// The spine's base frame is the brush frame turned half around x: its +z is the brush's −z.
const BRUSH_TO_SPINE: DQuat = DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);

impl SpineShape {
    /// A straight spine in a frame of orientation `frame`.
    #[must_use]
    pub fn straight(root: DVec3, frame: DQuat, joints: usize) -> Self {
        let directions = vec![frame * DVec3::NEG_Z; joints];
        Self {
            root,
            frame,
            anchors: directions.clone(),
            directions,
        }
    }

    /// A spine as it rests in a frame.
    #[must_use]
    pub fn at_rest(root: DVec3, frame: DQuat, spine: &Spine) -> Self {
        let mut shape = Self::straight(root, frame, spine.joints());
        shape.relax(spine);
        shape.anchors.clone_from(&shape.directions);
        shape
    }

    /// Unbends all joints; their anchors stay.
    pub fn relax(&mut self, spine: &Spine) {
        let base = self.base();
        let mut before = base;
        for (i, direction) in self.directions.iter_mut().enumerate() {
            *direction = match spine.rest.get(i) {
                Some(rest) => rest_after(base, self.frame * *rest, before).normalize(),
                None => base,
            };
            before = *direction;
        }
    }

    /// Unit direction of the unbent spine.
    #[must_use]
    pub fn base(&self) -> DVec3 {
        self.frame * DVec3::NEG_Z
    }

    /// End of segment `i`: the root plus all segments up to it.
    #[must_use]
    pub fn joint(&self, spine: &Spine, i: usize) -> DVec3 {
        let ends = self.directions.iter().zip(&spine.lengths_m).take(i + 1);
        ends.fold(self.root, |p, (direction, length)| p + *direction * *length)
    }

    /// The ends of all segments.
    pub fn joints(&self, spine: &Spine, into: &mut Vec<DVec3>) {
        into.clear();
        let mut p = self.root;
        for (direction, length) in self.directions.iter().zip(&spine.lengths_m) {
            p += *direction * *length;
            into.push(p);
        }
    }

    /// Position of the tip.
    #[must_use]
    pub fn tip(&self, spine: &Spine) -> DVec3 {
        self.joint(spine, spine.joints() - 1)
    }

    /// Moves the shape rigidly to another root and frame.
    pub fn carry(&mut self, root: DVec3, frame: DQuat) {
        let turn = frame * self.frame.conjugate();
        (self.root, self.frame) = (root, frame);
        let directions = self.directions.iter_mut().chain(&mut self.anchors);
        directions.for_each(|d| *d = (turn * *d).normalize());
    }

    /// θ and φ of each joint, rad, in single precision.
    pub fn angles(&self, into: &mut Vec<[f32; 2]>) {
        into.extend(self.exact_angles().map(|angles| angles.map(|v| v as f32)));
    }

    /// θ and φ of each joint, rad.
    pub fn exact_angles(&self) -> impl Iterator<Item = [f64; 2]> {
        let mut frame = self.frame * BRUSH_TO_SPINE;
        self.directions.iter().map(move |direction| {
            let angles = angles_of(frame.conjugate() * *direction);
            frame *= bend(angles);
            angles
        })
    }

    /// The shape of given angles in a frame of orientation `orientation`.
    #[must_use]
    pub fn from_angles(root: DVec3, orientation: DQuat, angles: &[[f32; 2]]) -> Self {
        let exact = angles.iter().map(|angles| angles.map(f64::from));
        Self::from_exact_angles(root, orientation, exact)
    }

    /// The shape of given angles, rad, in a frame of orientation `orientation`.
    #[must_use]
    pub fn from_exact_angles(
        root: DVec3,
        orientation: DQuat,
        angles: impl Iterator<Item = [f64; 2]>,
    ) -> Self {
        let mut frame = orientation * BRUSH_TO_SPINE;
        let directions: Vec<DVec3> = angles
            .map(|angles| {
                frame = (frame * bend(angles)).normalize();
                frame * DVec3::Z
            })
            .collect();
        Self {
            root,
            frame: orientation,
            anchors: directions.clone(),
            directions,
        }
    }
}

/// θ and φ of a direction in the frame of the brush, rad.
pub(super) fn angles_in_brush(direction: DVec3) -> [f64; 2] {
    angles_of(BRUSH_TO_SPINE.conjugate() * direction)
}

/// The direction in the frame of the brush of given angles.
pub(super) fn direction_in_brush(angles: [f64; 2]) -> DVec3 {
    BRUSH_TO_SPINE * bend(angles) * DVec3::Z
}

/// θ and φ of a direction in a spine's frame.
fn angles_of(local: DVec3) -> [f64; 2] {
    let theta = std::f64::consts::FRAC_PI_2 - acos(-local.y);
    [theta, atan2(local.x, local.z)]
}

/// R_y(φ)·R_x(θ).
fn bend([theta, phi]: [f64; 2]) -> DQuat {
    let ((st, ct), (sp, cp)) = (sin_cos(0.5 * theta), sin_cos(0.5 * phi));
    DQuat::from_xyzw(cp * st, sp * ct, -sp * st, cp * ct)
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry::rotation;
    use proptest::prelude::*;

    use super::*;

    fn angle() -> impl Strategy<Value = f32> {
        -1.3f32..1.3
    }

    proptest! {
        #[test]
        fn angles_and_directions_are_the_same_shape(
            angles in prop::collection::vec([angle(), angle()], 1..8),
            turn in -3.0..3.0f64,
        ) {
            let brush = rotation(DVec3::new(0.6, 0.0, 0.8), turn);
            let shape = SpineShape::from_angles(DVec3::ZERO, brush, &angles);
            let mut back = Vec::new();
            shape.angles(&mut back);
            for (one, two) in angles.iter().zip(&back) {
                prop_assert!((one[0] - two[0]).abs() < 1e-5 && (one[1] - two[1]).abs() < 1e-5);
            }
        }

        #[test]
        fn a_joint_bends_by_acos_of_the_cosines(theta in angle(), phi in angle()) {
            let shape = SpineShape::from_angles(DVec3::ZERO, DQuat::IDENTITY, &[[theta, phi]]);
            let bend = acos(shape.base().dot(shape.directions[0]));
            let [theta, phi] = [f64::from(theta), f64::from(phi)];
            // Baxter 2004, eq. 3.12.
            let expected = acos(maulstick_num::cos(theta) * maulstick_num::cos(phi));
            prop_assert!((bend - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn a_bent_spine_rests_in_its_shape_in_every_frame() {
        let bent =
            [0.1, 0.4, 0.9].map(|a| DVec3::new(maulstick_num::sin(a), 0.0, -maulstick_num::cos(a)));
        let spine = Spine::uniform(0.03, 3, 1e-4).resting(&bent);
        let frame = rotation(DVec3::new(0.0, 0.6, 0.8), 0.7);
        let shape = SpineShape::at_rest(DVec3::ZERO, frame, &spine);
        for (direction, rest) in shape.directions.iter().zip(bent) {
            assert!((*direction - frame * rest).length() < 1e-12);
        }
    }

    #[test]
    fn bristles_go_along_minus_z_of_the_brush() {
        let spine = Spine::uniform(0.03, 3, 1e-4);
        let shape = SpineShape::straight(DVec3::ZERO, DQuat::IDENTITY, 3);
        assert!((shape.tip(&spine) - DVec3::new(0.0, 0.0, -0.03)).length() < 1e-15);
        assert_eq!(spine.stiffness[0], 2.0 * spine.stiffness[1]);
    }

    #[test]
    fn the_rotation_is_that_of_equation_3_10() {
        let (theta, phi) = (0.3, -0.7);
        let ((st, ct), (sp, cp)) = (sin_cos(theta), sin_cos(phi));
        let r = bend([theta, phi]);
        assert!((r * DVec3::X - DVec3::new(cp, 0.0, -sp)).length() < 1e-15);
        assert!((r * DVec3::Y - DVec3::new(sp * st, ct, cp * st)).length() < 1e-15);
        assert!((r * DVec3::Z - DVec3::new(sp * ct, -st, cp * ct)).length() < 1e-15);
    }
}
