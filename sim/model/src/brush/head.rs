//! The head of a brush on a surface: its position and its extent.

use glam::DVec3;
use maulstick_brush::head::STATIONS;
use maulstick_brush::{Head, HeadPose, Hold};
use maulstick_num::geometry::{Rigid, nlerp};
use maulstick_num::lanes::run;
use maulstick_num::wide;
use maulstick_types::brush::Solve;

use crate::brush::scale::Scale;
use crate::brush::traits::BrushTraits;

/// Strips looked at at a time.
const LANES: usize = 8;
/// A strip lower than this may touch, cells.
const CONTACT_HEIGHT_CELLS: f32 = 3.0;

/// A solved pose, between two of which the head moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoint {
    brush: Rigid,
    angles: Vec<[f32; 2]>,
    wetness: f32,
}

/// A saved [`Waypoint`]: rotation x, y, z, w and translation of the brush, joint angles, wetness of the brush.
pub type WaypointSnapshot = ([f64; 4], [f64; 3], Vec<[f32; 2]>, f32);

impl From<&Waypoint> for WaypointSnapshot {
    fn from(from: &Waypoint) -> Self {
        let Rigid {
            rotation,
            translation,
        } = from.brush;
        let (rotation, translation) = (rotation.to_array(), translation.to_array());
        (rotation, translation, from.angles.clone(), from.wetness)
    }
}

impl From<WaypointSnapshot> for Waypoint {
    fn from((rotation, translation, angles, wetness): WaypointSnapshot) -> Self {
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

impl Waypoint {
    /// The pose of a solve on a surface, for a brush of wetness 0 to 1; with the brush's lengths, not the surface's.
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

    /// The same pose `by_m` of the brush higher, and back toward its handle: the pose before setting it down, which is
    /// steeper than the lean of the handle.
    #[must_use]
    pub fn withdrawn(&self, by_m: f64) -> Self {
        const ASIDE: f64 = 0.7;
        const FLATTEST: f64 = 0.5;
        let handle = self.brush.rotation * DVec3::Z;
        let aside = ASIDE * handle.truncate() / handle.z.max(FLATTEST);
        let mut withdrawn = self.clone();
        withdrawn.brush.translation += by_m * aside.extend(1.0);
        withdrawn
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

wide! {
    /// Widens a range by those segments, with their two ends, that come below `height`.
    fn reach<L>(
        ends: [&[f32]; 2],
        heights: [&[f32]; 2],
        height: f32,
        least: &mut f32,
        most: &mut f32,
    ) {
        let (mut low, mut high) = (L::splat(*least), L::splat(*most));
        let (none_low, none_high) = (L::splat(f32::MAX), L::splat(f32::MIN));
        let height = L::splat(height);
        let strips = ends[0].len();
        for start in (0..strips).step_by(LANES) {
            // The last few come with others before them.
            let start = start.min(strips.saturating_sub(LANES));
            let (a, b) = (run::<L>(ends[0], start), run::<L>(ends[1], start));
            let (za, zb) = (run::<L>(heights[0], start), run::<L>(heights[1], start));
            let below = za.least(zb).less(height);
            low = low.least(below.choose(a.least(b), none_low));
            high = high.most(below.choose(a.most(b), none_high));
        }
        *least = low.values().into_iter().fold(f32::MAX, f32::min);
        *most = high.values().into_iter().fold(f32::MIN, f32::max);
    }
}

/// The cells covered by strips lower than `height` cells in a step that ends at `pose`, half-open; `None` if all strips
/// are higher.
#[must_use]
pub fn low_bounds(
    head: &Head,
    pose: &HeadPose,
    traits: &BrushTraits,
    height: f32,
) -> Option<([i64; 2], [i64; 2])> {
    let strips = head.strips();
    let border = border(traits);
    let (mut from, mut to) = ([f32::MAX; 2], [f32::MIN; 2]);
    let row = |station: usize| station * strips..(station + 1) * strips;
    for station in 1..STATIONS {
        let rows = [row(station - 1), row(station)];
        let heights = rows.clone().map(|row| &pose.z[row]);
        for (axis, plane) in [&pose.x, &pose.y].into_iter().enumerate() {
            let ends = rows.clone().map(|row| &plane[row]);
            let (mut least, mut most) = (from[axis], to[axis]);
            reach(ends, heights, height, &mut least, &mut most);
            (from[axis], to[axis]) = (least, most);
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

/// Cells covered by a ribbon beyond its middle line at the end of a step: its position in the middle of the step, plus
/// its soft edge, up to √2 times as far across.
#[must_use]
pub fn border(traits: &BrushTraits) -> i64 {
    let half = 0.5 * traits.step_cells;
    (std::f32::consts::SQRT_2 * (traits.half_width + half) + 0.5 + half).ceil() as i64
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
        let near = from.z[i].min(to.z[i]) < CONTACT_HEIGHT_CELLS;
        farthest = farthest.max(if near { square } else { 0.0 });
    }
    f64::from(farthest.sqrt())
}
