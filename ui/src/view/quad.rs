//! A surface as the eye sees it: the part of a plane that lies on it, in perspective.

#[cfg(test)]
use glam::DVec2;
use glam::DVec3;

/// Least depth of what is in front of the eye, by that of the desk.
const NEAREST: f64 = 0.05;

/// Shares of a surface's sides as homogeneous points of the view: x and y times the depth, and the depth, that of the
/// desk being 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quad {
    /// The lower left corner.
    pub corner: DVec3,
    /// From there to the lower right one.
    pub right: DVec3,
    /// From there to the upper left one.
    pub up: DVec3,
}

impl Quad {
    /// The place of a share of the sides in the view, points; `None` beside or behind the eye.
    #[cfg(test)]
    #[must_use]
    pub(crate) fn at(&self, [across, up]: [f64; 2]) -> Option<DVec2> {
        let place = self.corner + across * self.right + up * self.up;
        (place.z > NEAREST).then(|| place.truncate() / place.z)
    }

    /// The part that begins at a share of the sides and takes another.
    #[must_use]
    pub(crate) fn part(&self, [across, up]: [f64; 2], [wide, tall]: [f64; 2]) -> Self {
        Self {
            corner: self.corner + across * self.right + up * self.up,
            right: wide * self.right,
            up: tall * self.up,
        }
    }

    /// The same in pixels of the view: corner and sides, and their depths.
    #[must_use]
    pub(crate) fn pixels(&self, pixels_per_point: f32) -> ([[f32; 2]; 3], [f32; 4]) {
        let all = [self.corner, self.right, self.up];
        let flat = all.map(|at| [at.x as f32, at.y as f32].map(|points| points * pixels_per_point));
        let [corner, right, up] = all.map(|at| at.z as f32);
        (flat, [corner, right, up, 0.0])
    }

    /// Depth of a point so high over the desk, by that of the desk.
    #[must_use]
    pub(crate) fn depth(height_m: f64, eye_m: f64) -> f64 {
        (1.0 - height_m / eye_m).max(NEAREST)
    }
}
