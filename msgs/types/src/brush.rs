//! What the brush node says: the brush file, the solved states, and how far it has consumed.

use crate::define::{message, wire_struct};
use crate::pose::Pose;

/// Bits of [`Solve::flags`].
pub mod solve_flags {
    /// The solver began anew at this pose: nothing is painted between it and the one before.
    pub const RESTARTED: u32 = 1;
    /// The solver did not converge and kept its last good state.
    pub const NOT_CONVERGED: u32 = 2;
    /// Where the brush is at a sample between two solves of its path: to be shown, not to be painted.
    pub const GLIMPSE: u32 = 4;
}

wire_struct! {
    /// A joint that touches a surface.
    pub struct Contact {
        /// Number of the spine.
        pub spine: u16,
        /// Number of the joint's far end, 1 at the end of the first segment.
        pub joint: u16,
        /// Normal force, N.
        pub force_n: f32,
    }
}

wire_struct! {
    /// One solved pose.
    pub struct Solve {
        /// When the stylus was there, rig clock, ns.
        pub event_ns: u64,
        /// The stroke, from 1 in the brush's epoch; 0 while nothing touches.
        pub stroke: u64,
        /// The surface whose frame the pose is in.
        pub surface: u32,
        /// See [`solve_flags`].
        pub flags: u32,
        /// Brush frame to surface frame; lengths are divided by the surface's zoom.
        pub pose: Pose,
        /// θ and φ of each joint, rad, spine after spine.
        pub angles_rad: Vec<[f32; 2]>,
        /// What touches.
        pub contacts: Vec<Contact>,
    }
}

message! {
    /// The brush at a stylus sample, with all sub-solves since the sample before.
    pub struct BrushState [version 1, at most 61440 bytes] {
        /// The device followed: the source of its samples.
        pub device: u32,
        /// Its epoch.
        pub device_epoch: u32,
        /// The newest of its samples that this message consumes.
        pub device_seq: u64,
        /// In order of time.
        pub solves: Vec<Solve>,
    }
}

message! {
    /// A brush file; cached for late joiners.
    pub struct BrushDef [version 1, at most 1048576 bytes] {
        /// Name of the brush in the rig.
        pub brush: String,
        /// The file, TOML.
        pub toml: String,
        /// FNV-1a of the file.
        pub hash: u32,
    }
}

message! {
    /// Credit to a device: what the brush node has consumed of its samples.
    pub struct BrushConsumed [version 1, at most 256 bytes] {
        /// The device: the source of its samples.
        pub device: u32,
        /// Its epoch.
        pub device_epoch: u32,
        /// All samples below this number are consumed.
        pub next: u64,
        /// The brush's epoch.
        pub brush_epoch: u32,
        /// The brush state that holds the newest of them.
        pub state: u64,
    }
}
