//! Messages as they were in older versions, for what paintings have kept of them.

use crate::brush::{BrushState, Contact, Solve};
use crate::define::{message, wire_struct};
use crate::pose::Pose;

wire_struct! {
    /// A solved pose without the zoom that it was solved at.
    pub struct SolveV1 {
        /// See [`Solve::event_ns`].
        pub event_ns: u64,
        /// See [`Solve::stroke`].
        pub stroke: u64,
        /// See [`Solve::surface`].
        pub surface: u32,
        /// See [`Solve::flags`].
        pub flags: u32,
        /// See [`Solve::pose`].
        pub pose: Pose,
        /// See [`Solve::angles_rad`].
        pub angles_rad: Vec<[f32; 2]>,
        /// See [`Solve::contacts`].
        pub contacts: Vec<Contact>,
    }
}

message! {
    /// The first version of [`BrushState`].
    pub struct BrushStateV1 [version 1, at most 61440 bytes] {
        /// See [`BrushState::device`].
        pub device: u32,
        /// See [`BrushState::device_epoch`].
        pub device_epoch: u32,
        /// See [`BrushState::device_seq`].
        pub device_seq: u64,
        /// See [`BrushState::solves`].
        pub solves: Vec<SolveV1>,
    }
}

impl BrushStateV1 {
    /// Hash of its schema, where it was called `BrushState`.
    pub const SCHEMA: u32 = 0x5df7_4b97;

    /// The same on a surface of this zoom.
    #[must_use]
    pub fn at_zoom(self, zoom: f64) -> BrushState {
        let solves = self.solves.into_iter().map(|solve| Solve {
            event_ns: solve.event_ns,
            stroke: solve.stroke,
            surface: solve.surface,
            flags: solve.flags,
            pose: solve.pose,
            zoom,
            angles_rad: solve.angles_rad,
            contacts: solve.contacts,
        });
        BrushState {
            device: self.device,
            device_epoch: self.device_epoch,
            device_seq: self.device_seq,
            solves: solves.collect(),
        }
    }
}
