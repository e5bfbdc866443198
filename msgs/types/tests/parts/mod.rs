//! Parts of the messages whose bytes are golden.

use maulstick_types::haptics::ForceReply;
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_types::{Pose, Region};

pub(crate) fn handling() -> BrushHandling {
    BrushHandling {
        brush: "main".into(),
        mode: BrushMode::Marker,
        flow: 0.004,
        most_m: 2e-5,
    }
}

pub(crate) fn force_reply() -> ForceReply {
    ForceReply {
        is_on: true,
        strength: 0.6,
        fault: "it shakes".into(),
    }
}

pub(crate) fn pose() -> Pose {
    Pose {
        position_m: [0.1, -0.2, 0.3],
        orientation: [0.0, 0.6, 0.0, 0.8],
    }
}

pub(crate) fn region() -> Region {
    Region {
        corner_m: [0.01, 0.02],
        size_m: [0.06, 0.04],
    }
}
