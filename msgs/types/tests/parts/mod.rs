//! Parts of the messages whose bytes are golden.

pub(crate) mod scene;

use maulstick_types::command::{
    BrushCommand, Command, ExportOrder, FileCommand, NewCanvas, RigCommand, SaveAs, SessionCommand,
    TakeCommand,
};
use maulstick_types::control::ControlSample;
use maulstick_types::haptics::ForceReply;
use maulstick_types::node::{NodeStatus, NodeWork};
use maulstick_types::paint::{
    DryingStatus, ExportStatus, FrameHolds, HistoryStep, PaintStatus, StepName, ThumbnailReply,
};
use maulstick_types::scene::{BrushHandling, BrushMode};
use maulstick_types::stylus::StylusStatus;
use maulstick_types::values::{
    BrushName, BrushToml, DeviceName, DeviceToml, MaterialName, WholePath,
};
use maulstick_types::window::Presented;
use maulstick_types::{Mixture, Pose};
use serde_bytes::ByteBuf;

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
        guidance: 0.7,
    }
}

pub(crate) fn pose() -> Pose {
    Pose {
        position_m: [0.1, -0.2, 0.3],
        orientation: [0.0, 0.6, 0.0, 0.8],
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
        is_guided: true,
        guidance: 0.7,
        refused_senders: 8,
        help: "plug it in".into(),
    }
}

pub(crate) fn control() -> ControlSample {
    ControlSample {
        push: [0.5, -0.25, 0.0],
        turn: [0.0, 1.0, -1.0],
        switches: 3,
    }
}

pub(crate) fn paint_status() -> PaintStatus {
    PaintStatus {
        journal: 1,
        steps: 2,
        footprint_cells: 3,
        lag_ns: 4,
        longer: 2,
        memory_bytes: 5,
        lost: 6,
        refused: 7,
        baking: 8,
        baked: 9,
        committed: 10,
        undo: 11,
        redo: 12,
        merged: 13,
        kept_bytes: 14,
        fault: "full".into(),
        path: "/a.maul".into(),
        all_committed: true,
        committed_ns: 15,
        blank: false,
        take: true,
        drying: Some(DryingStatus {
            share: 0.25,
            ticks_left: 16,
            layer: "sky".into(),
        }),
        export: Some(ExportStatus {
            path: "/a.png".into(),
            share: 0.5,
            since_ns: 17,
        }),
        backend: "cpu".into(),
        history: vec![HistoryStep {
            id: 18,
            what: StepName::Fill,
            done: true,
        }],
    }
}

pub(crate) fn thumbnail() -> ThumbnailReply {
    ThumbnailReply {
        width: 2,
        height: 1,
        rgb: vec![1, 2, 3, 4, 5, 6].into(),
        version: 9,
    }
}

fn path(name: &str) -> WholePath {
    WholePath::new(name).expect("whole")
}

/// What takes its place in the journal besides edits.
pub(crate) fn takes() -> [TakeCommand; 3] {
    [
        TakeCommand::Begin {
            brush: BrushName::main(),
            device: 1,
            device_epoch: 2,
            loads: vec![Mixture::pure("Bone Black")],
            again: true,
        },
        TakeCommand::Mark,
        TakeCommand::Snapshot {
            path: path("/p.png"),
            ledger: Some(path("/l.json")),
        },
    ]
}

/// An example of a new canvas.
fn canvas() -> NewCanvas {
    let material = |name: &str| MaterialName::new(name).expect("a name");
    NewCanvas {
        width_m: 0.3,
        height_m: 0.2,
        cell_m: 2.5e-4,
        ground: material("gesso"),
        tooth: material("linen"),
        tooth_seed: 1,
        stain_m: 3e-6,
    }
}

/// The commands about files, and those of other nodes.
pub(crate) fn files() -> [Command; 13] {
    let order = ExportOrder {
        format: "stl".into(),
        step: 4,
        profile: "srgb".into(),
        gamut: "clamp".into(),
        ..ExportOrder::to(path("/a.stl"))
    };
    let save_as = SaveAs {
        path: path("/c.maul"),
        replace: true,
    };
    [
        FileCommand::Export(order).into(),
        FileCommand::StopExport.into(),
        FileCommand::SaveAs(save_as.clone()).into(),
        FileCommand::Copy {
            path: path("/d.maul"),
        }
        .into(),
        SessionCommand::Begin { session: 1 }.into(),
        SessionCommand::Repeat {
            session: 1,
            batch: 2,
            records: ByteBuf::from(vec![1, 2, 3]),
        }
        .into(),
        SessionCommand::End { session: 1 }.into(),
        BrushCommand::Define {
            brush: BrushName::main(),
            toml: BrushToml::new("kind").expect("short"),
        }
        .into(),
        RigCommand::Open {
            path: path("/a.maul"),
            forget: true,
        }
        .into(),
        RigCommand::New {
            path: Some(path("/b.maul")),
            canvas: canvas(),
            forget: false,
        }
        .into(),
        RigCommand::SaveAs(save_as).into(),
        RigCommand::PutDevice {
            toml: DeviceToml::new("name").expect("short"),
        }
        .into(),
        RigCommand::RemoveDevice {
            name: DeviceName::new("pen").expect("short"),
        }
        .into(),
    ]
}

pub(crate) fn presented() -> Presented {
    Presented {
        frame: 1,
        begun_ns: 2,
        draw_ns: 3,
        journal: 4,
        holds: vec![FrameHolds {
            brush: 5,
            epoch: 6,
            next: 7,
        }],
    }
}

pub(crate) fn node_status() -> NodeStatus {
    NodeStatus {
        process: 1,
        turns: 2,
        work: NodeWork {
            consumed: 3,
            produced: 4,
            waiting: 5,
            held: 6,
            refused: 7,
            lost: 8,
            too_fast: 9,
        },
    }
}
