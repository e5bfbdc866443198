//! The head of a brush in the frame of a surface, as the paint sees it.

use glam::DVec3;
use maulstick_brush::{BrushFile, Spine, SpineShape};
use maulstick_num::geometry::{Rigid, nlerp};
use maulstick_types::brush::Solve;

/// A point of the spine with the head's radius around it, in cells of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// Place, cells.
    pub at: [f32; 3],
    /// Radius, cells.
    pub radius: f32,
}

/// A head: the balls at the root and at the end of each segment; between them it tapers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadPose {
    /// From the ferrule to the point.
    pub balls: Vec<Ball>,
}

/// What of a brush file the paint needs.
#[derive(Clone, Debug)]
pub struct HeadShape {
    spine: Spine,
    radii_m: Vec<f64>,
}

/// A solved pose, between two of which the head moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoint {
    brush: Rigid,
    angles: Vec<[f32; 2]>,
}

impl Waypoint {
    /// The pose of a solve.
    #[must_use]
    pub fn of(solve: &Solve) -> Self {
        Self {
            brush: Rigid::from(&solve.pose),
            angles: solve.angles_rad.clone(),
        }
    }

    /// A pose between this one and `other`, at `t` in 0..1.
    #[must_use]
    pub fn toward(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * t as f32;
        let angles = self
            .angles
            .iter()
            .zip(&other.angles)
            .map(|(a, b)| [mix(a[0], b[0]), mix(a[1], b[1])])
            .collect();
        let brush = Rigid {
            rotation: nlerp(self.brush.rotation, other.brush.rotation, t),
            translation: self.brush.translation.lerp(other.brush.translation, t),
        };
        Self { brush, angles }
    }
}

impl HeadShape {
    /// The shape of a brush's head.
    #[must_use]
    pub fn of(file: &BrushFile) -> Self {
        let spine = file.spine();
        let whole = spine.length_m();
        let mut radii_m = vec![file.radius_m(0.0)];
        let mut along = 0.0;
        for length in &spine.lengths_m {
            along += length;
            radii_m.push(file.radius_m(along / whole));
        }
        Self { spine, radii_m }
    }

    /// Whether a solve has as many joints as the brush.
    #[must_use]
    pub fn fits(&self, solve: &Solve) -> bool {
        solve.angles_rad.len() == self.spine.joints()
    }

    /// The head at a pose, in cells of side `cell_m`.
    pub fn pose(&self, waypoint: &Waypoint, cell_m: f64, into: &mut HeadPose) {
        let Rigid {
            rotation,
            translation,
        } = waypoint.brush;
        let shape = SpineShape::from_angles(translation, rotation, &waypoint.angles);
        into.balls.clear();
        let mut at: DVec3 = translation;
        let ends = shape.directions.iter().zip(&self.spine.lengths_m);
        let mut ball = |at: DVec3, radius: f64| {
            into.balls.push(Ball {
                at: (at / cell_m).as_vec3().to_array(),
                radius: (radius / cell_m) as f32,
            });
        };
        ball(at, self.radii_m[0]);
        for ((direction, length), radius) in ends.zip(&self.radii_m[1..]) {
            at += *direction * *length;
            ball(at, *radius);
        }
    }
}

impl HeadPose {
    /// The cells that the head may cover, from the first up to but not with the second.
    #[must_use]
    pub fn bounds(&self) -> ([i64; 2], [i64; 2]) {
        let (mut from, mut to) = ([i64::MAX; 2], [i64::MIN; 2]);
        for ball in &self.balls {
            for i in 0..2 {
                from[i] = from[i].min((ball.at[i] - ball.radius).floor() as i64);
                to[i] = to[i].max((ball.at[i] + ball.radius).ceil() as i64 + 1);
            }
        }
        (from, to)
    }

    /// The farthest that a ball in contact moves between two poses, cells: along the surface, or
    /// deeper into it.
    #[must_use]
    pub fn motion(&self, next: &Self) -> f64 {
        let low = |ball: &Ball| ball.at[2] < ball.radius;
        self.balls
            .iter()
            .zip(&next.balls)
            .filter(|(a, b)| low(a) || low(b))
            .map(|(a, b)| {
                let d: [f64; 3] = std::array::from_fn(|i| f64::from(b.at[i]) - f64::from(a.at[i]));
                (d[0] * d[0] + d[1] * d[1]).sqrt().max(-d[2])
            })
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_head_stands_under_its_ferrule() {
        let file = BrushFile::library("round").expect("round");
        let shape = HeadShape::of(&file);
        let waypoint = Waypoint {
            brush: Rigid {
                translation: DVec3::new(0.01, 0.02, 0.03),
                ..Rigid::IDENTITY
            },
            angles: vec![[0.0; 2]; 3],
        };
        let mut pose = HeadPose::default();
        shape.pose(&waypoint, 2.5e-4, &mut pose);
        assert_eq!(pose.balls.len(), 4);
        let tip = pose.balls[3];
        assert!(
            (tip.at[0] - 40.0).abs() < 1e-4 && (tip.at[2] - 20.0).abs() < 1e-3,
            "{tip:?}"
        );
        let (from, to) = pose.bounds();
        assert!(from[0] < 25 && to[0] > 55 && from[1] < 65 && to[1] > 95);
    }

    #[test]
    fn halfway_between_two_poses_is_halfway() {
        let at = |x: f64| Waypoint {
            brush: Rigid {
                translation: DVec3::new(x, 0.0, 0.03),
                ..Rigid::IDENTITY
            },
            angles: vec![[0.2 * x as f32, 0.0]; 3],
        };
        assert_eq!(at(0.0).toward(&at(1.0), 0.5), at(0.5));
    }
}
