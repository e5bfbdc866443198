//! The root of a spine in the ferrule.

use glam::{DQuat, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};

use crate::spine::{Spine, SpineShape};

/// A spine and its root.
#[derive(Clone, Debug, PartialEq)]
pub struct SpineRoot {
    /// Origin in the ferrule, brush frame, m.
    pub origin: DVec3,
    /// Rotation of the brush frame that takes its −z to the spine's direction at the ferrule.
    pub lean: DQuat,
    /// The spine, with its share of the head's stiffness.
    pub spine: Spine,
}

impl SpineRoot {
    /// A spine with a drawn shape at rest: from `root` on by segments, brush frame, m.
    #[must_use]
    pub fn drawn(root: DVec3, segments: &[DVec3], spine: Spine) -> Self {
        let lean = shortest_arc(DVec3::NEG_Z, segments[0].normalize());
        let directions: Vec<DVec3> = segments
            .iter()
            .map(|segment| lean.conjugate() * segment.normalize())
            .collect();
        let straight = directions
            .iter()
            .all(|d| (*d - DVec3::NEG_Z).length() < 1e-9);
        Self {
            origin: root,
            lean,
            spine: if straight {
                spine
            } else {
                spine.resting(&directions)
            },
        }
    }

    /// The frame of the spine, brush at `brush`: origin and orientation.
    #[must_use]
    pub fn frame(&self, brush: &Rigid) -> Rigid {
        Rigid {
            rotation: brush.rotation * self.lean,
            translation: brush.point(self.origin),
        }
    }

    /// The spine at rest, brush at `brush`.
    #[must_use]
    pub fn at_rest(&self, brush: &Rigid) -> SpineShape {
        let frame = self.frame(brush);
        SpineShape::at_rest(frame.translation, frame.rotation, &self.spine)
    }
}
