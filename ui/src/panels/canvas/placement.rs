//! Tilt, turn and zoom of a surface about its middle.

use glam::{DQuat, DVec3};
use maulstick_num::atan2;
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_types::Pose;
use maulstick_types::scene::Surface;

/// Placement of a surface on the desk.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Posture {
    /// Tilt of its upper side, degrees.
    pub(super) tilt_deg: f64,
    /// Turn in its own plane, counter-clockwise, degrees.
    pub(super) turn_deg: f64,
    /// Desk lengths per surface length.
    pub(super) zoom: f64,
}

/// Rounds to thousandths, so that a requested value is recognised in the scene.
fn tidy(value: f64) -> f64 {
    (value * 1e3).round() * 1e-3 + 0.0
}

impl Posture {
    /// Placement of a surface; a sideways lean is left out.
    #[must_use]
    pub(super) fn of(surface: &Surface) -> Self {
        let turned = Rigid::from(&surface.pose).rotation;
        let normal = turned * DVec3::Z;
        let tilt = atan2(-normal.y, normal.z);
        let across = rotation(DVec3::X, -tilt) * (turned * DVec3::X);
        Self {
            tilt_deg: tidy(tilt.to_degrees()),
            turn_deg: tidy(atan2(across.y, across.x).to_degrees()),
            zoom: (surface.zoom * 1e5).round() * 1e-5,
        }
    }

    /// Pose and zoom of the surface with this placement, its middle unmoved.
    #[must_use]
    pub(super) fn laid(&self, surface: &Surface) -> (Pose, f64) {
        let zoom = self.zoom;
        let [x, y] = surface
            .cells
            .map(|cells| 0.5 * f64::from(cells) * surface.cell_m);
        let half = DVec3::new(x, y, 0.0);
        let middle = Rigid::from(&surface.pose).point(half * surface.zoom);
        let turned: DQuat = canonical(
            rotation(DVec3::X, self.tilt_deg.to_radians())
                * rotation(DVec3::Z, self.turn_deg.to_radians()),
        );
        let pose = Pose {
            position_m: (middle - turned * (half * zoom)).to_array(),
            orientation: turned.to_array(),
        };
        (pose, zoom)
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::PaintingSetup;

    use super::*;

    fn middle(surface: &Surface) -> DVec3 {
        let [x, y] = surface
            .cells
            .map(|cells| 0.5 * f64::from(cells) * surface.cell_m * surface.zoom);
        Rigid::from(&surface.pose).point(DVec3::new(x, y, 0.0))
    }

    #[test]
    fn a_canvas_tilts_turns_and_grows_about_its_middle() {
        let mut canvas = PaintingSetup::default().scene().surfaces[0].clone();
        canvas.pose.position_m[0] += 0.03;
        let before = middle(&canvas);
        assert_eq!(Posture::of(&canvas).tilt_deg, 0.0);
        let posture = Posture {
            tilt_deg: 35.0,
            turn_deg: -20.0,
            zoom: 2.5,
        };
        let (pose, zoom) = posture.laid(&canvas);
        assert!(pose.is_valid());
        let upper = Rigid::from(&pose).vector(DVec3::Y);
        assert!(upper.z > 0.4, "its upper edge is raised: {upper}");
        (canvas.pose, canvas.zoom) = (pose, zoom);
        assert_eq!(Posture::of(&canvas), posture);
        assert!((middle(&canvas) - before).length() < 1e-9);
        canvas.zoom = 2.0;
        assert!(
            (middle(&canvas) - before).length() > 1e-2,
            "a fault would pass"
        );
    }
}
