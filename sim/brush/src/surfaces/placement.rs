//! Placement of a surface on the desk, and its motion by the free hand.

use glam::DVec3;
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_num::sin_cos;
use maulstick_types::scene::Surface;
use maulstick_types::values::{ValueError, Zoom, check_reach};
use maulstick_types::{Edit, Pose};
use serde_json::json;

/// Zooms that a painter can use.
pub const ZOOMS: [f64; 2] = [0.1, 20.0];
/// Greatest distance of the canvas from the middle of the desk, m, before its zoom.
pub const FARTHEST_M: f64 = 1.0;
/// Greatest tilt of a surface, rad.
pub const TILT_MOST: f64 = 1.05;

/// The edit that sets a surface's pose and zoom.
///
/// # Errors
/// [`ValueError`] where they are not finite or out of range.
pub fn place(surface: u32, pose: &Pose, zoom: f64) -> Result<Edit, ValueError> {
    check_reach(pose)?;
    let zoom = Zoom::new(zoom)?;
    let fields = json!({ "surface": surface, "pose": pose, "zoom": zoom });
    Ok(Edit::named("place", &fields))
}

/// Pose and zoom of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePlacement {
    /// Surface frame to desk frame.
    pub pose: Rigid,
    /// Desk lengths per surface length.
    pub zoom: f64,
}

impl From<&Surface> for SurfacePlacement {
    fn from(surface: &Surface) -> Self {
        Self {
            pose: Rigid::from(&surface.pose),
            zoom: surface.zoom,
        }
    }
}

impl SurfacePlacement {
    /// This placement moved along the desk, within its bounds.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        let bound = DVec3::splat(FARTHEST_M * self.zoom.max(1.0));
        Self {
            pose: Rigid {
                translation: (self.pose.translation + by).clamp(-bound, bound),
                ..self.pose
            },
            ..*self
        }
    }

    /// The edit that gives a surface this placement.
    ///
    /// # Errors
    /// [`ValueError`] where it is not finite or out of range.
    pub fn edit(&self, surface: u32) -> Result<Edit, ValueError> {
        place(surface, &self.pose.to_pose(), self.zoom)
    }

    /// This placement enlarged by a factor about a point of the desk. A zoom beyond a painter's bounds grows no
    /// further; it does not snap to the bound.
    #[must_use]
    pub fn zoomed(&self, about: DVec3, factor: f64) -> Self {
        let [least, most] = [ZOOMS[0].min(self.zoom), ZOOMS[1].max(self.zoom)];
        let zoom = (self.zoom * factor).clamp(least, most);
        let translation = about + (self.pose.translation - about) * (zoom / self.zoom);
        Self {
            pose: Rigid {
                translation,
                ..self.pose
            },
            zoom,
        }
        .moved(DVec3::ZERO)
    }

    /// This placement rotated by an angle, rad, about an axis of the desk through a point of it.
    #[must_use]
    pub fn turned(&self, about: DVec3, axis: DVec3, angle: f64) -> Self {
        let turn = rotation(axis, angle);
        Self {
            pose: Rigid {
                rotation: canonical(turn * self.pose.rotation),
                translation: about + turn * (self.pose.translation - about),
            },
            ..*self
        }
        .moved(DVec3::ZERO)
    }

    /// This placement tilted by an angle, rad, about the horizontal axis of the desk through a point of it; unchanged
    /// where that would turn it away from the painter.
    #[must_use]
    pub fn tilted(&self, about: DVec3, angle: f64) -> Self {
        let tilted = self.turned(about, DVec3::X, angle);
        let least = sin_cos(TILT_MOST).1;
        if tilted.pose.vector(DVec3::Z).z >= least {
            tilted
        } else {
            *self
        }
    }
}

/// A surface with this placement.
#[must_use]
pub fn placed(surface: &Surface, placement: &SurfacePlacement) -> Surface {
    Surface {
        pose: placement.pose.to_pose(),
        zoom: placement.zoom,
        ..surface.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACEMENT: SurfacePlacement = SurfacePlacement {
        pose: Rigid {
            translation: DVec3::new(-0.128, -0.128, 0.0),
            ..Rigid::IDENTITY
        },
        zoom: 1.0,
    };

    /// The place on the surface, in its own lengths, under a point of the desk.
    fn under(placement: &SurfacePlacement, desk: DVec3) -> DVec3 {
        placement.pose.inverse().point(desk) / placement.zoom
    }

    #[test]
    fn what_the_hand_holds_stays_under_it() {
        let held = DVec3::new(0.05, -0.02, 0.0);
        let own = under(&PLACEMENT, held);
        let zoomed = PLACEMENT.zoomed(held, 3.0);
        let turned = zoomed.turned(held, DVec3::Z, 0.7);
        let tilted = turned.tilted(held, 0.4);
        for placement in [zoomed, turned, tilted] {
            assert!(
                (under(&placement, held) - own).length() < 1e-12,
                "{placement:?}"
            );
            assert!(placement.edit(0).is_ok());
        }
        let beside = held + DVec3::X * 1e-3;
        let off = (under(&PLACEMENT.zoomed(beside, 3.0), held) - own).length();
        assert!(off > 1e-4, "a fault would pass");
        let moved = PLACEMENT.moved(DVec3::X * 0.01);
        assert!((under(&moved, held) - own - DVec3::X * -0.01).length() < 1e-12);
    }

    #[test]
    fn however_far_it_is_moved_it_stays_within_reach() {
        let (mut placement, about) = (PLACEMENT, DVec3::new(0.3, 0.3, 0.0));
        for _ in 0..200 {
            placement = placement
                .zoomed(about, 1.3)
                .moved(DVec3::splat(1.0))
                .tilted(about, 0.1);
        }
        assert!(placement.zoom <= ZOOMS[1]);
        assert!(placement.pose.translation.abs().max_element() <= FARTHEST_M * ZOOMS[1]);
        assert!(
            placement.pose.vector(DVec3::Z).z > 0.45,
            "never away from the painter"
        );
        let small = SurfacePlacement {
            zoom: 0.05,
            ..PLACEMENT
        };
        assert_eq!(small.zoomed(about, 0.5).zoom, 0.05, "no leap to the bound");
    }
}
