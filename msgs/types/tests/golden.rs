//! The bytes of every message, as they were when its version was fixed.

mod parts;

use maulstick_types::brush::{
    BrushConsumed, BrushDef, BrushLook, BrushRelief, BrushState, Contact, Solve,
};
use maulstick_types::command::advice::Advice;
use maulstick_types::command::{Detail, GapRequest, Outcome};
use maulstick_types::haptics::{
    FluidForce, ForceLaw, ForceOrder, ForceRequest, GuideModel, height_bytes,
};
use maulstick_types::paint::{
    BrushCredit, Decision, Entry, FrameHolds, FrameReply, FrameRequest, FrameTile, PaintConsumed,
    StepName, ThumbnailRequest,
};
use maulstick_types::scene::{
    BrushSet, Environment, Layer, Light, NamedVersion, PaintSlot, Scene, Surface, Tuning, WellKind,
};
use maulstick_types::stylus::{StylusInfo, StylusPose, TakeEnd, TakeStatus};
use maulstick_types::window::PendingOrders;
use maulstick_types::{CATALOGUE, Edit, Flags, Message, Mixture, Origin, decode, encode};
use parts::messages::{
    after, command, entry, knot, local, mixture, model, pen, reply, sample, well,
};
use parts::{
    control, files, force_reply, handling, node_status, paint_status, pose, presented, status,
    takes, thumbnail,
};

/// A line `Name/version hash hex` of a message, which must also come back from its bytes.
fn line<M: Message + PartialEq + std::fmt::Debug>(message: &M) -> String {
    let origin = Origin {
        source: 0x0102_0304,
        epoch: 0x0506_0708,
    };
    let flags = Flags::REPLAY.with(Flags::FIRST);
    let bytes = encode(&origin, flags, 11, 12, 13, message).expect("within its limit");
    let (header, back) = decode::<M>(&bytes).expect("its own bytes");
    assert_eq!(
        (&back, header.seq, header.event_ns, header.sent_ns),
        (message, 11, 12, 13)
    );
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    format!(
        "{}/{} {:08x} {hex}\n",
        M::NAME,
        M::VERSION,
        M::schema().hash
    )
}

fn edit() -> Edit {
    Edit {
        name: "dry".into(),
        fields: r#"{"share":0.5,"layer":"sky"}"#.into(),
    }
}

fn decisions() -> [Decision; 6] {
    [
        Decision::Backend { name: "cpu".into() },
        Decision::Fallback {
            name: "cpu".into(),
            why: "lost".into(),
        },
        Decision::CoarserFlow { why: "room".into() },
        Decision::Resumed,
        Decision::LighterModel {
            model: "dab".into(),
        },
        Decision::Words {
            words: "other".into(),
        },
    ]
}

fn details() -> [Detail; 5] {
    [
        Detail::Nothing,
        Detail::Step {
            name: StepName::Stroke {
                kind: "round".into(),
                on_palette: true,
            },
        },
        Detail::Dried {
            layer: Layer {
                number: 1,
                name: "sky".into(),
                opacity: 1.0,
            },
        },
        Detail::Loaded {
            mixture: Mixture::pure("Bone Black"),
        },
        Detail::say("done"),
    ]
}

fn devices() -> [String; 6] {
    [
        line(&sample(pen())),
        line(&sample(StylusPose::Ferrule { pose: pose() })),
        line(&StylusInfo {
            device: "pen".into(),
            driver: "hid".into(),
            brush: "main".into(),
            priority: -5,
            senses: 1,
            drives: 2,
            rate_hz: 125.0,
            max_force_n: 3.0,
            max_stiffness_n_m: 400.0,
            workspace_m: [1.0; 6],
        }),
        line(&status()),
        line(&TakeStatus {
            epoch: 1,
            position_ns: 2,
            length_ns: 3,
            sent: 4,
            consumed: 5,
            end: Some(TakeEnd {
                after: after(),
                samples: 6,
            }),
        }),
        line(&control()),
    ]
}

fn haptics() -> [String; 11] {
    [
        line(&model(ForceLaw::None)),
        line(&model(ForceLaw::Linear {
            k1_n: 0.8,
            k2_n: 6.0,
        })),
        line(&model(ForceLaw::Hermite {
            knots: vec![knot()],
        })),
        line(&model(local())),
        line(&model(ForceLaw::Rigid {
            stiffness_n_m: 300.0,
        })),
        line(&GuideModel {
            device: 1,
            device_epoch: 2,
            points_m: vec![[0.1, 0.2, 0.0], [0.11, 0.2, 0.0]],
            normal: [0.0, 0.0, 1.0],
            head_length_m: 0.025,
            stiffness_n_m: 80.0,
            damping_n_s_m: 0.5,
            max_force_n: 0.6,
            time_to_live_ns: 100_000_000,
        }),
        line(&FluidForce {
            device: 1,
            device_epoch: 2,
            pose: pose(),
            velocity: [1.0; 6],
            wrench: [2.0; 6],
            jacobian: [[3.0; 6]; 6],
            time_to_live_ns: 4,
            recovery_ns: 5,
        }),
        line(&ForceRequest::by(
            "hand",
            ForceOrder::Strength { share: 0.5 },
        )),
        line(&ForceRequest::by(
            "hand",
            ForceOrder::Guidance { share: 0.5 },
        )),
        line(&ForceRequest::by(
            "hand",
            ForceOrder::Drive {
                source: 1,
                epoch: 2,
            },
        )),
        line(&force_reply()),
    ]
}

fn brushes() -> [String; 5] {
    [
        line(&BrushDef {
            brush: "main".into(),
            toml: "kind = 1".into(),
            hash: 9,
            head_length_m: 0.025,
        }),
        line(&BrushState {
            device: 1,
            device_epoch: 2,
            device_seq: 3,
            solves: vec![Solve {
                event_ns: 4,
                stroke: 5,
                surface: 0,
                flags: 1,
                pose: pose(),
                zoom: 1.0,
                angles_rad: vec![[0.5, -0.5]],
                contacts: vec![Contact {
                    spine: 0,
                    joint: 3,
                    force_n: 0.25,
                }],
            }],
        }),
        line(&BrushConsumed {
            device: 1,
            device_epoch: 2,
            next: 3,
            brush_epoch: 4,
            state: 5,
        }),
        line(&BrushLook {
            strips: 1,
            along: 1,
            samples: vec![0, 60, 0, 56, 0, 52, 0, 60].into(),
            load_share: 0.5,
        }),
        line(&BrushRelief {
            surface: 1,
            cell_m: 0.001,
            side: 2,
            first: [-3, 4],
            heights_um: height_bytes([5, -6, 700, 8]),
        }),
    ]
}

fn credit() -> [String; 1] {
    [line(&PaintConsumed {
        brushes: vec![BrushCredit {
            brush: 1,
            epoch: 2,
            next: 3,
            wetness: 0.5,
            film_m: 1e-4,
            viscosity_m2_s: 0.01,
            contact_m: 0.008,
            file: 4,
        }],
    })]
}

fn light() -> Light {
    Light {
        direction: [0.0, 0.0, 1.0],
        intensity: 1.0,
        illuminant: "D65".into(),
        spectrum: vec![1.0; 2],
        exposure: 0.9,
        relief: 2.0,
        softness: 0.1,
        observer: 1964,
        rule: "gauss".into(),
        samples: 8,
        adapted: false,
        environment: Environment::Picture {
            name: "hall".into(),
            texels: vec![128, 64, 0, 129],
        },
    }
}

fn scene() -> [String; 1] {
    [line(&Scene {
        version: 1,
        surfaces: vec![Surface {
            id: 0,
            pose: pose(),
            zoom: 1.0,
            cells: [64, 32],
            cell_m: 2.5e-4,
            ground: "gesso".into(),
            tooth: "linen".into(),
            tooth_seed: 2,
            wells: vec![
                well(WellKind::Cleaner),
                well(WellKind::Medium),
                well(WellKind::Paint { mixture: mixture() }),
            ],
            stain_m: 1e-5,
            piles_last: true,
            model: "impasto".into(),
        }],
        paints: vec![PaintSlot {
            name: "Bone Black".into(),
            masstone: [0.01; 3],
            tint: [0.5; 3],
            file_hash: 3,
        }],
        light: light(),
        tunings: vec![Tuning {
            brush: "main".into(),
            stiffness: 1.5,
            wetness: 0.5,
        }],
        layers: vec![Layer {
            number: 1,
            name: "sky".into(),
            opacity: 0.5,
        }],
        versions: vec![NamedVersion {
            name: "warm".into(),
            parent: "sketch".into(),
            here: true,
        }],
        handlings: vec![handling()],
        sets: vec![BrushSet {
            brush: "main".into(),
            given: 2,
            angles_rad: vec![[0.01, -0.02]],
        }],
    })]
}

fn journal() -> [String; 6] {
    [
        line(&entry(Entry::States {
            brush: "main".into(),
            epoch: 1,
            from: 2,
            to: 3,
        })),
        line(&entry(Entry::Command {
            client: 1,
            number: 2,
            command: edit().into(),
        })),
        line(&entry(Entry::Tick { count: 4 })),
        line(&entry(Entry::Cut {
            client: 1,
            number: 2,
            brush: "main".into(),
            epoch: 1,
            from: 4,
            to: 6,
            whole: true,
        })),
        decisions()
            .map(|what| line(&entry(Entry::Decision { what })))
            .concat(),
        line(&entry(Entry::Brush {
            brush: "main".into(),
            toml: "kind".into(),
        })),
    ]
}

fn views() -> [String; 6] {
    [
        line(&FrameRequest {
            surface: 0,
            since: 1,
            epoch: 2,
            tiles: [0, 0, 4, 4],
            level: 1,
            wait_ms: 100,
            look: 3,
            shared: true,
        }),
        line(&FrameReply {
            surface: 0,
            epoch: 1,
            version: 2,
            level: 0,
            cells: [64, 64],
            journal: 3,
            holds: vec![FrameHolds {
                brush: 1,
                epoch: 2,
                next: 3,
            }],
            more: false,
            tiles: vec![FrameTile {
                x: 0,
                y: 1,
                planes: vec![1, 2, 3].into(),
            }],
            look: 4,
        }),
        line(&paint_status()),
        line(&ThumbnailRequest {
            version: "first".into(),
            side: 96,
            step: None,
        }),
        line(&ThumbnailRequest {
            version: String::new(),
            side: 96,
            step: Some(7),
        }),
        line(&thumbnail()),
    ]
}

fn commands() -> [String; 8] {
    [
        line(&command(edit().into())),
        takes().map(|asked| line(&command(asked.into()))).concat(),
        files().map(|asked| line(&command(asked))).concat(),
        details()
            .map(|detail| line(&reply(Outcome::Done { journal: 1, detail })))
            .concat(),
        line(&reply(Outcome::Waiting)),
        line(&reply(Outcome::Refused {
            what: "no".into(),
            advice: Advice::say("yes"),
        })),
        line(&reply(Outcome::Refused {
            what: "no".into(),
            advice: Advice::FullOpacity { layer: 2 },
        })),
        line(&GapRequest {
            epoch: 1,
            from: 2,
            to: 3,
        }),
    ]
}

/// A line for each message, and for each kind of some.
fn all() -> String {
    [
        devices().concat(),
        haptics().concat(),
        brushes().concat(),
        credit().concat(),
        scene().concat(),
        journal().concat(),
        views().concat(),
        commands().concat(),
        windows_and_nodes(),
    ]
    .concat()
}

/// Examples of messages whose order follows no other.
fn windows_and_nodes() -> String {
    [
        line(&presented()),
        line(&node_status()),
        line(&PendingOrders { since_ns: 1 }),
    ]
    .concat()
}

/// The file holds the bytes of each version. A line that changes without its version changes what
/// recorded takes and running rigs mean: a message with other fields is another version, and one that
/// takes hold (`StylusSample`, `StylusInfo`) gets an upgrade with it.
#[test]
fn bytes_are_golden() {
    let got = all();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden.txt");
        std::fs::write(path, &got).expect("written");
        return;
    }
    let golden = include_str!("golden.txt");
    for (got, golden) in got.lines().zip(golden.lines()) {
        assert_eq!(got, golden);
    }
    assert_eq!(
        got.lines().count(),
        golden.lines().count(),
        "UPDATE_GOLDEN=1 writes golden.txt anew"
    );
    for entry in CATALOGUE {
        let name = format!("{}/{} ", entry.name, entry.version);
        assert!(golden.contains(&name), "{name} has no golden bytes");
    }
}
