//! Parts of the messages whose bytes are golden.

use maulstick_types::control::ControlSample;
use maulstick_types::haptics::ForceReply;
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_types::stylus::StylusStatus;
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

pub(crate) fn status() -> StylusStatus {
    StylusStatus {
        samples: 1,
        dropped: 2,
        faults: vec!["late".into()],
        lateness: vec![3, 4],
        execution: vec![5],
        force_n: 0.5,
        foreign_models: 6,
        trouble: "gone".into(),
        is_on: true,
        strength: 0.6,
        resting: false,
        asked_n_m: 700.0,
        stiffness_n_m: 400.0,
        cap_n: 3.0,
        motor_temperature: 0.2,
    }
}

pub(crate) fn control() -> ControlSample {
    ControlSample {
        push: [0.5, -0.25, 0.0],
        turn: [0.0, 1.0, -1.0],
        switches: 3,
    }
}
