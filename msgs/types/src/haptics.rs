//! Messages to a force-feedback device: models that it evaluates by itself, never forces.

use crate::pose::Pose;
use crate::wire::define::{message, wire_enum, wire_struct};

wire_struct! {
    /// Canvas grain: a small band-limited tangential texture.
    pub struct Grain {
        /// Amplitude as a share of the normal force.
        pub amplitude: f64,
        /// Dominant wavelength, m.
        pub wavelength_m: f64,
        /// Seed of its phases.
        pub seed: u64,
    }
}

wire_struct! {
    /// One of the five control tuples of the Hermite curve (Baxter 2004, § 8.7.2).
    pub struct HermiteKnot {
        /// Depth as a fraction of the head's length along the plane's normal.
        pub depth: f64,
        /// Force, N.
        pub force_n: f64,
        /// Slope, N per such fraction.
        pub slope_n: f64,
    }
}

wire_enum! {
    /// Normal force by depth.
    pub enum ForceLaw {
        /// No force; for comparison and for a lifted brush.
        None,
        /// Two straight pieces (Baxter 2004, eq. 8.1).
        Linear {
            /// Force when the handle meets the plane, N.
            k1_n: f64,
            /// Further force a head's length below, N.
            k2_n: f64,
        },
        /// Piecewise cubic: compression, buckling, bending, hard stop (Baxter 2004, fig. 8.2).
        Hermite {
            /// Knots in order of depth.
            knots: Vec<HermiteKnot>,
        },
        /// A force linearised about a pose.
        Local {
            /// Pose for which it holds.
            pose: Pose,
            /// Force there, N.
            force_n: [f64; 3],
            /// Derivative of the force by position, N/m, row after row.
            stiffness_n_m: [[f64; 3]; 3],
        },
        /// A hard wall, for comparison.
        Rigid {
            /// Stiffness, N/m.
            stiffness_n_m: f64,
        },
    }
}

wire_struct! {
    /// Relief around the brush: heights over the plane on [`SIDE`](Self::SIDE)² cells, desk frame. Beyond its edge the
    /// outermost heights continue.
    pub struct HeightPatch {
        /// Corner of the first cell, m.
        pub corner_m: [f64; 3],
        /// Unit vector along a row, in the plane; rows follow each other along normal × this.
        pub along: [f64; 3],
        /// Side of a cell, m, .25 to 25 mm.
        pub cell_m: f64,
        /// Heights in µm, −5000 to 5000, of the middles of the cells: little endian i16, row after row; empty for a flat
        /// surface.
        pub heights_um: serde_bytes::ByteBuf,
    }
}

impl HeightPatch {
    /// Cells along a side.
    pub const SIDE: usize = 16;
    /// Height or depth at most, µm.
    pub const MOST_UM: i16 = 5000;

    /// A surface without relief.
    #[must_use]
    pub fn flat() -> Self {
        Self {
            corner_m: [0.0; 3],
            along: [0.0; 3],
            cell_m: 0.0,
            heights_um: serde_bytes::ByteBuf::new(),
        }
    }

    /// True if there is no relief.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.heights_um.is_empty()
    }
}

/// Bytes of heights in µm, row after row.
#[must_use]
pub fn height_bytes(heights_um: impl IntoIterator<Item = i16>) -> serde_bytes::ByteBuf {
    let bytes = heights_um.into_iter().flat_map(i16::to_le_bytes);
    serde_bytes::ByteBuf::from(bytes.collect::<Vec<u8>>())
}

/// Heights in µm of their bytes, row after row.
pub fn heights_um(bytes: &[u8]) -> impl Iterator<Item = i16> {
    let pairs = bytes.chunks_exact(2);
    pairs.map(|pair| i16::from_le_bytes([pair[0], pair[1]]))
}

message! {
    /// Contact force on the handle until the next model, evaluated at the device's own rate; in the desk frame.
    pub struct ContactModel [contract of hash 0xf3eb_8772, version 3, at most 4096 bytes] {
        /// The device that it is for: the source of its samples.
        pub device: u32,
        /// The device's epoch; another one is dropped.
        pub device_epoch: u32,
        /// The device's brush as in `rig.toml`; another one is dropped.
        pub brush: String,
        /// A point of the plane, m.
        pub plane_point_m: [f64; 3],
        /// Its unit normal, toward the painter.
        pub plane_normal: [f64; 3],
        /// Coefficient of friction at rest.
        pub friction_static: f64,
        /// Coefficient of friction in motion.
        pub friction_kinetic: f64,
        /// Drag of the paint, N·s/m.
        pub viscous_n_s_m: f64,
        /// Canvas grain.
        pub grain: Grain,
        /// Normal force by depth.
        pub law: ForceLaw,
        /// Length of the brush head, m.
        pub head_length_m: f64,
        /// After this time since its arrival the model decays, ns, at most a second.
        pub time_to_live_ns: u64,
        /// A change of model is spread over this time, ns, at most a second.
        pub recovery_ns: u64,
        /// Relief around the brush.
        pub relief: HeightPatch,
        /// Depth of the unbent head's tip below the plane where the hand was as the model was made, m; negative above it.
        pub depth_m: f64,
    }
}

impl ContactModel {
    /// Longest lifetime of a model, ns: a brush that has died exerts no force after that.
    pub const TIME_TO_LIVE_MOST_NS: u64 = 1_000_000_000;
    /// Longest time over which the change to a model is spread, ns.
    pub const RECOVERY_MOST_NS: u64 = 1_000_000_000;

    /// A dry, smooth canvas at the desk's z = 0 that pushes back by `law` on a head of
    /// `head_length_m`, and lives for as long as a model may.
    #[must_use]
    pub fn bare(law: ForceLaw, head_length_m: f64) -> Self {
        Self {
            device: 0,
            device_epoch: 0,
            brush: "main".to_owned(),
            plane_point_m: [0.0; 3],
            plane_normal: [0.0, 0.0, 1.0],
            friction_static: 0.0,
            friction_kinetic: 0.0,
            viscous_n_s_m: 0.0,
            grain: Grain {
                amplitude: 0.0,
                wavelength_m: 1e-3,
                seed: 1,
            },
            law,
            head_length_m,
            time_to_live_ns: Self::TIME_TO_LIVE_MOST_NS,
            recovery_ns: 0,
            relief: HeightPatch::flat(),
            depth_m: 0.0,
        }
    }
}

wire_enum! {
    /// Request about a device's force.
    pub enum ForceOrder {
        /// No force, at once.
        Off,
        /// Force, from nothing on.
        On,
        /// Weaker force.
        Strength {
            /// Share of the models' force, 0 to 1.
            share: f64,
        },
        /// Force again after a fault, from nothing on.
        Rearm,
        /// Weaker guidance.
        Guidance {
            /// Share of the guides' force, 0 to 1.
            share: f64,
        },
        /// Consent to another sender than the device's brush: for three seconds its contact models, forces of paint and
        /// guides count. Who drives a hand for longer asks again in time.
        Drive {
            /// Source of its messages.
            source: u32,
            /// Their epoch.
            epoch: u32,
        },
    }
}

message! {
    /// Request to a device to change its force; asking again is safe.
    pub struct ForceRequest [contract of hash 0xf795_6c2b, version 3, at most 256 bytes] {
        /// The change.
        pub order: ForceOrder,
        /// Asker, for the log: program, user, terminal; at most [`ForceRequest::ASKER_BYTES`] bytes.
        pub asker: String,
    }
}

impl ForceRequest {
    /// Most bytes of the name of who asks.
    pub const ASKER_BYTES: usize = 128;

    /// A request of `asker`, whose name is cut where it is too long.
    #[must_use]
    pub fn by(asker: &str, order: ForceOrder) -> Self {
        Self {
            order,
            asker: asker[..asker.floor_char_boundary(Self::ASKER_BYTES)].to_owned(),
        }
    }
}

message! {
    /// State of a device's force after a request.
    pub struct ForceReply [contract of hash 0x203e_0860, version 2, at most 1024 bytes] {
        /// True if it is switched on.
        pub is_on: bool,
        /// Share of the models' force, 0 to 1.
        pub strength: f64,
        /// Fault that blocks the force until it is armed again, in words; empty without one.
        pub fault: String,
        /// Share of the guides' force, 0 to 1.
        pub guidance: f64,
    }
}

message! {
    /// Guide of the hand: a piece of path that a soft spring holds the brush to, across the path and within the canvas, until
    /// the next one; in the desk frame. It neither presses nor moves the brush along the path.
    pub struct GuideModel [version 1, at most 1024 bytes] {
        /// The device that it is for: the source of its samples.
        pub device: u32,
        /// The device's epoch; another one is dropped.
        pub device_epoch: u32,
        /// Points of the path of the undeformed tip, m, 2 to 16; it goes straight on beyond its ends.
        pub points_m: Vec<[f64; 3]>,
        /// Unit normal of the canvas, toward the painter.
        pub normal: [f64; 3],
        /// Length of the brush head, m.
        pub head_length_m: f64,
        /// Stiffness, N/m; the servo bounds it.
        pub stiffness_n_m: f64,
        /// Damping across the path, N·s/m; the servo bounds it.
        pub damping_n_s_m: f64,
        /// Largest force, N; the servo bounds it.
        pub max_force_n: f64,
        /// After this time since its arrival the guide fades, ns, at most a second.
        pub time_to_live_ns: u64,
    }
}

impl GuideModel {
    /// Most points of a path.
    pub const POINTS_MOST: usize = 16;
    /// Longest lifetime of a guide, ns.
    pub const TIME_TO_LIVE_MOST_NS: u64 = 1_000_000_000;
}

message! {
    /// A force from the paint's fields with all that makes it a model.
    pub struct FluidForce [contract of hash 0x04fc_9dd5, version 1, at most 2048 bytes] {
        /// The device that it is for.
        pub device: u32,
        /// The device's epoch.
        pub device_epoch: u32,
        /// Pose for which it holds, desk frame.
        pub pose: Pose,
        /// Linear, then angular velocity for which it holds, m/s and rad/s.
        pub velocity: [f64; 6],
        /// Force, then torque, N and N·m.
        pub wrench: [f64; 6],
        /// Derivative of the wrench by velocity, row after row.
        pub jacobian: [[f64; 6]; 6],
        /// As in [`ContactModel`].
        pub time_to_live_ns: u64,
        /// As in [`ContactModel`].
        pub recovery_ns: u64,
    }
}
