//! Guide of the hand: a spring to a piece of path, across it and within the plane of the canvas (virtual fixtures:
//! Rosenberg 1993; the hand of a master, Baxter 2004, § 9.2).
//!
//! The spring is anchored at the nearest point of the path, not at a moving one: a hand at rest is not dragged along.
//! In the plane of the canvas, at a distance d from the path, the force toward it is
//!
//! ```text
//! f(d) = min(K·d, F)·min(1, max(0, 2 − d/R))
//! ```
//!
//! so a hand beyond 2·R is released. As f depends on d alone it has a potential, and a path returns at most the energy
//! that was put in. The nearest point is tracked along the path: where a bend has two of them, the hand changes from
//! one to the other where the first ends, and loses energy by it.

use glam::DVec3;
use maulstick_types::haptics::GuideModel;
use maulstick_types::limits::FARTHEST_M;

use crate::contact::HandleState;

/// Greatest number of points of a path.
const POINTS_MAX: usize = GuideModel::POINTS_MOST;
/// Least length of a piece within the plane, m; shorter ones are dropped.
const SHORTEST_M: f64 = 1e-4;

/// Bounds of a guide, set by the servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideBounds {
    /// Largest stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Largest damping, N·s/m.
    pub damping_n_s_m: f64,
    /// Largest force, N.
    pub force_n: f64,
    /// Distance from the path at which the force begins to fall, m; it is zero at twice that.
    pub reach_m: f64,
}

/// A guide in the form that the servo evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Points within the plane through the origin.
    points: [DVec3; POINTS_MAX],
    count: usize,
    normal: DVec3,
    head_length: f64,
    stiffness: f64,
    damping: f64,
    most: f64,
    /// Age after which it fades, s.
    pub time_to_live_s: f64,
}

/// Point on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Index of its piece.
    piece: usize,
    /// Parameter along the piece, 0 to 1; the first and the last piece continue beyond their ends.
    along: f64,
}

/// Pull of a guide on the hand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pull {
    /// Part that depends on position alone, N.
    pub conservative: DVec3,
    /// Damping, N.
    pub damping: DVec3,
    /// Distance to the left of the path, seen from the painter's side, m.
    pub left_m: f64,
}

impl Guide {
    /// Converts a guide.
    ///
    /// # Errors
    /// The fault: a number that is not finite or out of range, a path of too few or too many points or without
    /// length in the plane, a time to live of more than a second.
    pub fn new(model: &GuideModel) -> Result<Self, &'static str> {
        let normal = DVec3::from_array(model.normal);
        let scalars = [
            model.head_length_m,
            model.stiffness_n_m,
            model.damping_n_s_m,
            model.max_force_n,
        ];
        let near = |metres: &f64| metres.abs() <= FARTHEST_M;
        if !model.points_m.iter().flatten().all(near) {
            return Err("a point is not finite or more than 10 m away");
        }
        if !(2..=POINTS_MAX).contains(&model.points_m.len()) {
            return Err("a path has 2 to 16 points");
        }
        if !normal.is_finite() || (normal.length() - 1.0).abs() > 1e-6 {
            return Err("the normal is not a unit vector");
        }
        let is_scalar = |value: &f64| value.is_finite() && *value >= 0.0;
        if !scalars.iter().all(is_scalar) || model.head_length_m > FARTHEST_M {
            return Err("head length, stiffness, damping or largest force is out of range");
        }
        if model.time_to_live_ns > GuideModel::TIME_TO_LIVE_MOST_NS {
            return Err("the time to live is longer than a second");
        }
        let mut guide = Self {
            points: [DVec3::ZERO; POINTS_MAX],
            count: 0,
            normal,
            head_length: model.head_length_m,
            stiffness: model.stiffness_n_m,
            damping: model.damping_n_s_m,
            most: model.max_force_n,
            time_to_live_s: model.time_to_live_ns as f64 * 1e-9,
        };
        for point in &model.points_m {
            let point = guide.in_plane(DVec3::from_array(*point));
            let before = guide.count.checked_sub(1).map(|last| guide.points[last]);
            if before.is_none_or(|before| (point - before).length() >= SHORTEST_M) {
                guide.points[guide.count] = point;
                guide.count += 1;
            }
        }
        match guide.count {
            0 | 1 => Err("the path has no length within the canvas"),
            _ => Ok(guide),
        }
    }

    fn in_plane(&self, v: DVec3) -> DVec3 {
        v - self.normal * v.dot(self.normal)
    }

    /// The undeformed tip within the plane, m.
    fn place(&self, handle: &HandleState) -> DVec3 {
        self.in_plane(handle.position + handle.orientation * DVec3::NEG_Z * self.head_length)
    }

    /// Start and vector of a piece, m.
    fn piece(&self, piece: usize) -> (DVec3, DVec3) {
        let from = self.points[piece];
        (from, self.points[piece + 1] - from)
    }

    fn last_piece(&self) -> usize {
        self.count - 2
    }

    /// Nearest point of a piece.
    fn foot(&self, piece: usize, place: DVec3) -> Foot {
        let (from, way) = self.piece(piece);
        let mut along = (place - from).dot(way) / way.length_squared();
        if piece > 0 {
            along = along.max(0.0);
        }
        if piece < self.last_piece() {
            along = along.min(1.0);
        }
        Foot { piece, along }
    }

    /// Place of a point of the path within the plane, m.
    #[must_use]
    pub fn point(&self, foot: Foot) -> DVec3 {
        let (from, way) = self.piece(foot.piece.min(self.last_piece()));
        from + way * foot.along
    }

    /// Point of the path that is nearest to a place.
    #[must_use]
    pub fn nearest(&self, place: DVec3) -> Foot {
        let place = self.in_plane(place);
        let mut best = self.foot(0, place);
        for piece in 1..=self.last_piece() {
            let foot = self.foot(piece, place);
            if (place - self.point(foot)).length() < (place - self.point(best)).length() {
                best = foot;
            }
        }
        best
    }

    /// Nearest point of the path for a hand without an earlier one.
    #[must_use]
    pub fn first(&self, handle: &HandleState) -> Foot {
        self.nearest(self.place(handle))
    }

    /// Moves a nearest point along the path while the distance falls.
    #[must_use]
    pub fn follow(&self, from: Foot, handle: &HandleState) -> Foot {
        let place = self.place(handle);
        let mut foot = self.foot(from.piece.min(self.last_piece()), place);
        // The distance falls at each step, and there are no more steps than pieces.
        for _ in 0..POINTS_MAX {
            let ahead = foot.along >= 1.0 && foot.piece < self.last_piece();
            let behind = foot.along <= 0.0 && foot.piece > 0;
            let other = match (ahead, behind) {
                (true, _) => self.foot(foot.piece + 1, place),
                (_, true) => self.foot(foot.piece - 1, place),
                _ => return foot,
            };
            let leaves = if ahead {
                other.along > 0.0
            } else {
                other.along < 1.0
            };
            if !leaves {
                return foot;
            }
            foot = other;
        }
        foot
    }

    /// Pull on a hand whose nearest point is `foot`.
    #[must_use]
    pub fn pull(&self, foot: Foot, handle: &HandleState, bounds: &GuideBounds) -> Pull {
        let place = self.place(handle);
        let (_, way) = self.piece(foot.piece.min(self.last_piece()));
        let toward = self.point(foot) - place;
        let distance = toward.length();
        let left = self.normal.cross(way.normalize_or_zero());
        let share = (2.0 - distance / bounds.reach_m).clamp(0.0, 1.0);
        let most = self.most.min(bounds.force_n);
        let spring = (self.stiffness.min(bounds.stiffness_n_m) * distance).min(most);
        let across = left * handle.velocity.dot(left);
        let damping = across * -(self.damping.min(bounds.damping_n_s_m) * share);
        Pull {
            conservative: toward.normalize_or_zero() * (spring * share),
            damping: damping.clamp_length_max(most * share),
            left_m: -toward.dot(left),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
