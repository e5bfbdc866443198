//! The head of a brush on a surface: where it is, and how far it goes.

use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose, Hold};
use maulstick_num::geometry::{Rigid, nlerp};
use maulstick_types::brush::Solve;

/// A strip lower than this may touch, cells.
const NEAR: f32 = 3.0;

/// A solved pose, between two of which the head moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoint {
    brush: Rigid,
    angles: Vec<[f32; 2]>,
    wetness: f32,
}

/// A [`Waypoint`] as it is kept: rotation x, y, z, w and translation of the brush, joint angles, how
/// full the brush is.
pub type KeptWaypoint = ([f64; 4], [f64; 3], Vec<[f32; 2]>, f32);

impl From<&Waypoint> for KeptWaypoint {
    fn from(from: &Waypoint) -> Self {
        let Rigid {
            rotation,
            translation,
        } = from.brush;
        let (rotation, translation) = (rotation.to_array(), translation.to_array());
        (rotation, translation, from.angles.clone(), from.wetness)
    }
}

impl From<KeptWaypoint> for Waypoint {
    fn from((rotation, translation, angles, wetness): KeptWaypoint) -> Self {
        Self {
            brush: Rigid {
                rotation: glam::DQuat::from_array(rotation),
                translation: translation.into(),
            },
            angles,
            wetness,
        }
    }
}

/// How a brush's lengths are seen on a surface.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Scale {
    /// Side of a cell in the surface's own lengths, m.
    pub cell_m: f64,
    /// Desk lengths per surface length.
    pub zoom: f64,
}

impl Waypoint {
    /// The pose of a solve on a surface, of a brush that is so full (0 to 1); with the brush's
    /// lengths, not the surface's.
    #[must_use]
    pub fn of(solve: &Solve, scale: Scale, wetness: f32) -> Self {
        let mut brush = Rigid::from(&solve.pose);
        brush.translation *= scale.zoom;
        Self {
            brush,
            angles: solve.angles_rad.clone(),
            wetness,
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
        Self {
            brush,
            angles,
            wetness: mix(self.wetness, other.wetness),
        }
    }

    /// The head there, in cells of the surface.
    pub fn pose(&self, head: &Head, scale: Scale, into: &mut HeadPose) {
        let per_m = 1.0 / (scale.cell_m * scale.zoom);
        let hold = Hold {
            brush: &self.brush,
            angles: &self.angles,
            per_m,
            wetness: self.wetness,
        };
        head.pose(&hold, into);
    }
}

/// The cells that strips of `half_width` cells lower than `height` cells cover, and those beside
/// them that paint may be pushed to, from the first up to but not with the second; none where all
/// strips are higher.
#[must_use]
pub fn low_bounds(
    head: &Head,
    pose: &HeadPose,
    half_width: f32,
    height: f32,
) -> Option<([i64; 2], [i64; 2])> {
    let strips = head.strips();
    let border = border(half_width);
    let (mut from, mut to) = ([f32::MAX; 2], [f32::MIN; 2]);
    let row = |station: usize| station * strips..(station + 1) * strips;
    for station in 1..STATIONS {
        let (before, after) = (row(station - 1), row(station));
        for (axis, plane) in [&pose.x, &pose.y].into_iter().enumerate() {
            let ends = plane[before.clone()].iter().zip(&plane[after.clone()]);
            let heights = pose.z[before.clone()].iter().zip(&pose.z[after.clone()]);
            for ((a, b), (za, zb)) in ends.zip(heights) {
                let low = za.min(*zb) < height;
                let (least, most) = if a < b { (*a, *b) } else { (*b, *a) };
                let least = if low { least } else { f32::MAX };
                let most = if low { most } else { f32::MIN };
                from[axis] = if least < from[axis] {
                    least
                } else {
                    from[axis]
                };
                to[axis] = if most > to[axis] { most } else { to[axis] };
            }
        }
    }
    if let Some(skin) = head.skin() {
        let points = &pose.skin;
        for face in skin.faces() {
            let corners = face.map(|i| i as usize);
            if corners.iter().any(|i| points.z[*i] < height) {
                for i in corners {
                    for (axis, plane) in [&points.x, &points.y].into_iter().enumerate() {
                        from[axis] = from[axis].min(plane[i]);
                        to[axis] = to[axis].max(plane[i]);
                    }
                }
            }
        }
    }
    (from[0] <= to[0]).then(|| {
        (
            from.map(|v| v.floor() as i64 - border),
            to.map(|v| v.ceil() as i64 + border + 1),
        )
    })
}

/// How many cells a ribbon of a half width reaches beyond its middle line: it covers half a cell beyond its
/// edge, seen across at most √2 times as far.
#[must_use]
pub fn border(half_width: f32) -> i64 {
    (std::f32::consts::SQRT_2 * (half_width + 0.5) + 0.5).ceil() as i64
}

/// The farthest that a strip near the surface moves between two poses, cells: along the surface, or
/// deeper into it.
#[must_use]
pub fn motion(from: &HeadPose, to: &HeadPose) -> f64 {
    let mut farthest = 0.0f32;
    for i in 0..from.z.len() {
        let [dx, dy, dz] = [
            to.x[i] - from.x[i],
            to.y[i] - from.y[i],
            to.z[i] - from.z[i],
        ];
        let deeper = dz.min(0.0);
        let square = (dx * dx + dy * dy).max(deeper * deeper);
        let near = from.z[i].min(to.z[i]) < NEAR;
        farthest = farthest.max(if near { square } else { 0.0 });
    }
    f64::from(farthest.sqrt())
}
