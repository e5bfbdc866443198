//! Messages of a kind whose bytes are golden, each around one part of it.

use maulstick_types::Mixture;
use maulstick_types::command::{After, Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::haptics::{
    ContactModel, ForceLaw, Grain, HeightPatch, HermiteKnot, height_bytes,
};
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::scene::{Well, WellKind};
use maulstick_types::stylus::{StylusPose, StylusSample};

use super::pose;

pub(crate) fn after() -> After {
    After {
        brush: 7,
        epoch: 8,
        sequence: 9,
    }
}

pub(crate) fn mixture() -> Mixture {
    Mixture::pure("Bone Black")
}

pub(crate) fn sample(pose: StylusPose) -> StylusSample {
    StylusSample {
        senses: 5,
        pose,
        velocity_m_s: [1.0, 2.0, 3.0],
        force_n: [0.5, 0.25, 0.125],
        switches: 3,
        in_range: true,
    }
}

pub(crate) fn pen() -> StylusPose {
    StylusPose::Contact {
        point_m: [0.01, 0.02, 0.0],
        tilt_rad: [0.1, -0.1],
        twist_rad: 0.5,
        pressure: 0.75,
    }
}

pub(crate) fn command(command: Command) -> CommandRequest {
    CommandRequest {
        client: 1,
        number: 2,
        after: Some(after()),
        command,
    }
}

pub(crate) fn model(law: ForceLaw) -> ContactModel {
    ContactModel {
        device: 1,
        device_epoch: 2,
        brush: "main".into(),
        plane_point_m: [0.0; 3],
        plane_normal: [0.0, 0.0, 1.0],
        friction_static: 0.3,
        friction_kinetic: 0.2,
        viscous_n_s_m: 0.1,
        grain: Grain {
            amplitude: 0.01,
            wavelength_m: 0.001,
            seed: 4,
        },
        law,
        head_length_m: 0.025,
        time_to_live_ns: 5,
        recovery_ns: 6,
        relief: HeightPatch {
            corner_m: [0.1, 0.2, 0.3],
            along: [1.0, 0.0, 0.0],
            cell_m: 0.001,
            heights_um: height_bytes([7, -8, 300]),
        },
        depth_m: 0.002,
    }
}

pub(crate) fn knot() -> HermiteKnot {
    HermiteKnot {
        depth: 0.5,
        force_n: 1.0,
        slope_n: 2.0,
    }
}

pub(crate) fn local() -> ForceLaw {
    ForceLaw::Local {
        pose: pose(),
        force_n: [1.0; 3],
        stiffness_n_m: [[2.0; 3]; 3],
    }
}

pub(crate) fn well(kind: WellKind) -> Well {
    Well {
        center_m: [0.1, 0.2],
        radius_m: 0.01,
        kind,
    }
}

pub(crate) fn entry(entry: Entry) -> JournalEntry {
    JournalEntry { index: 3, entry }
}

pub(crate) fn reply(outcome: Outcome) -> CommandReply {
    CommandReply { number: 4, outcome }
}
