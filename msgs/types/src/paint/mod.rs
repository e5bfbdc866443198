//! Messages of the paint node: credit, journal, frames, status.

mod decision;
pub(crate) mod frame_view;
mod step_name;
mod stored_entry;

use serde_bytes::ByteBuf;

use crate::command::Command;
pub use crate::paint::decision::Decision;
pub use crate::paint::step_name::StepName;
use crate::wire::define::{message, wire_enum, wire_struct};

/// Side of a tile in cells.
pub const TILE: usize = 64;

wire_struct! {
    /// Credit to a brush, and the paint under it.
    pub struct BrushCredit {
        /// The brush: the source of its states.
        pub brush: u32,
        /// Its epoch.
        pub epoch: u32,
        /// All states below this number are consumed.
        pub next: u64,
        /// Mean share of wet cells under the brush, 0 to 1.
        pub wetness: f32,
        /// Mean thickness of the film under the brush, m.
        pub film_m: f32,
        /// Kinematic viscosity of that film, m²/s.
        pub viscosity_m2_s: f32,
        /// Length of the contact: the side of a square as large, m.
        pub contact_m: f32,
        /// FNV-1a of the brush file with which the next of its states are painted; 0 where none is known.
        pub file: u32,
    }
}

message! {
    /// Credit to the brushes.
    pub struct PaintConsumed [version 3, at most 4096 bytes] {
        /// One a brush; of a brush without a state so far epoch and number are 0.
        pub brushes: Vec<BrushCredit>,
    }
}

wire_enum! {
    /// Record that the sequencer accepted.
    pub enum Entry {
        /// Brush states, from the first to the last of a range.
        States {
            /// Name of the brush.
            brush: String,
            /// Its epoch.
            epoch: u32,
            /// First state.
            from: u64,
            /// Last state.
            to: u64,
        },
        /// A command.
        Command {
            /// The sender.
            client: u64,
            /// Its number.
            number: u64,
            /// The command.
            command: Command,
        },
        /// A sixtieth of a second of flowing or drying.
        Tick {
            /// Number of ticks since the painting began.
            count: u64,
        },
        /// Brush states that an undo dropped before they were painted, from the first to the last of a range.
        Cut {
            /// The sender of the undo.
            client: u64,
            /// The undo's number.
            number: u64,
            /// Name of the brush.
            brush: String,
            /// Its epoch.
            epoch: u32,
            /// First state.
            from: u64,
            /// Last state.
            to: u64,
            /// True if nothing of the stroke was painted: then the undo is done.
            whole: bool,
        },
        /// A decision of the paint node itself.
        Decision {
            /// The decision.
            #[serde(deserialize_with = "crate::wire::worded::read")]
            what: Decision,
        },
        /// A brush, or another file of a known one.
        Brush {
            /// Its name.
            brush: String,
            /// The file, TOML.
            toml: String,
        },
    }
}

message! {
    /// An entry of the journal, in order; it has room for the largest command with its index.
    pub struct JournalEntry [version 13, at most 1049600 bytes] {
        /// From 0, without gaps.
        pub index: u64,
        /// The record.
        pub entry: Entry,
    }
}

message! {
    /// Asks for the tiles of a surface that changed.
    pub struct FrameRequest [version 3, at most 256 bytes] {
        /// The surface.
        pub surface: u32,
        /// Tiles of a version above this; 0 asks for all.
        pub since: u64,
        /// The epoch that `since` belongs to; 0 if none.
        pub epoch: u32,
        /// Visible tiles of that level: least x, y, then one past the greatest.
        pub tiles: [u32; 4],
        /// 0 is full resolution, each further level halves it.
        pub level: u32,
        /// Longest wait for a change, ms, at most 400.
        pub wait_ms: u32,
        /// The look that `since` belongs to.
        pub look: u64,
        /// True if a large reply may lie in memory that both processes share.
        pub shared: bool,
    }
}

wire_struct! {
    /// A changed tile, unlit, 64×64 cells from the lowest row.
    pub struct FrameTile {
        /// Column of the tile.
        pub x: u32,
        /// Row of the tile, 0 at the bottom.
        pub y: u32,
        /// Five planes of half floats: linear red, green, blue (sRGB primaries, unclamped), gloss,
        /// wetness; then a plane of floats: height, m. Little endian, 4096 values a plane.
        pub planes: ByteBuf,
    }
}

wire_struct! {
    /// The newest brush state that a frame holds.
    pub struct FrameHolds {
        /// The brush: the source of its states.
        pub brush: u32,
        /// Its epoch.
        pub epoch: u32,
        /// All states below this number are in the picture.
        pub next: u64,
    }
}

message! {
    /// The tiles that changed; where they are too many for one reply the rest comes with the next.
    pub struct FrameReply [version 2, at most 67108864 bytes] {
        /// The surface.
        pub surface: u32,
        /// Epoch of the paint node: where it differs from the asker's, all tiles come anew.
        pub epoch: u32,
        /// Version to ask from the next time.
        pub version: u64,
        /// The level of the tiles.
        pub level: u32,
        /// Cells of the surface at this level, across and up.
        pub cells: [u32; 2],
        /// The journal entries below this index are in the picture.
        pub journal: u64,
        /// The brush states that are in the picture.
        pub holds: Vec<FrameHolds>,
        /// True if further tiles wait for the next request.
        pub more: bool,
        /// The tiles.
        pub tiles: Vec<FrameTile>,
        /// Grows when the light changes: where it differs from the asker's, all tiles come anew.
        pub look: u64,
    }
}

wire_struct! {
    /// A running drying.
    pub struct DryingStatus {
        /// Share of its time that went by, 0 to 1.
        pub share: f32,
        /// Sixtieths of a second until its end.
        pub ticks_left: u32,
        /// Name of its layer; empty where it is to be called by its number.
        pub layer: String,
    }
}

wire_struct! {
    /// A running export.
    pub struct ExportStatus {
        /// Its file.
        pub path: String,
        /// Share of it that is written, 0 to 1.
        pub share: f32,
        /// For how long it has gone on, ns.
        pub since_ns: u64,
    }
}

wire_struct! {
    /// A step that can be undone or redone.
    pub struct HistoryStep {
        /// Its number.
        pub id: u64,
        /// Its name.
        #[serde(deserialize_with = "crate::wire::worded::read")]
        pub what: StepName,
        /// True if it is done, false if it was undone.
        pub done: bool,
    }
}

message! {
    /// Status of the paint node, ten times a second.
    pub struct PaintStatus [version 7, at most 32768 bytes] {
        /// Entries of the journal so far.
        pub journal: u64,
        /// Steps of the paint model so far.
        pub steps: u64,
        /// Footprint cells so far.
        pub footprint_cells: u64,
        /// Age of the oldest brush state that waits, ns.
        pub lag_ns: u64,
        /// Length of the present stroke's steps by the brush's own: 1, or more while painting is late.
        pub longer: u32,
        /// Bytes that the tiles take.
        pub memory_bytes: u64,
        /// Brush states that were lost for good.
        pub lost: u64,
        /// Messages that did not decode or were not expected.
        pub refused: u64,
        /// Tiles whose dry layers are to be computed for the present light.
        pub baking: u32,
        /// Those of them that are done.
        pub baked: u32,
        /// The journal entries below this index are in the document; 0 without one.
        pub committed: u64,
        /// Steps that can be undone.
        pub undo: u32,
        /// Steps that can be redone.
        pub redo: u32,
        /// Operations that the oldest step holds: more than one where steps were merged.
        pub merged: u64,
        /// Bytes that the painting with its history takes where it is kept.
        pub kept_bytes: u64,
        /// Reason why the document is not written at present; empty if it is.
        pub fault: String,
        /// The painting's file; empty where it is in memory alone.
        pub path: String,
        /// True if all accepted records are in the file.
        pub all_committed: bool,
        /// Time of the last commit, rig clock, ns; 0 if not yet.
        pub committed_ns: u64,
        /// True if nothing was ever painted or kept.
        pub blank: bool,
        /// True while a take is played.
        pub take: bool,
        /// Layer that dries on the canvas.
        pub drying: Option<DryingStatus>,
        /// The running export.
        pub export: Option<ExportStatus>,
        /// Backend of the paint: `cpu`, or `gpu` and the adapter's name.
        pub backend: String,
        /// The steps around the present one, the newest first: those that are undone, the last of which would be redone
        /// next, then those that are done.
        pub history: Vec<HistoryStep>,
    }
}

message! {
    /// Asks for a small picture of the canvas under its light; the answer comes when it is drawn.
    pub struct ThumbnailRequest [version 2, at most 256 bytes] {
        /// Name of a version; the painting as it is if empty.
        pub version: String,
        /// Most pixels of its longer side, 1 to 512.
        pub side: u32,
        /// Instead of a version the painting after this step of its history, 0 for before all of them. Drawn while
        /// nobody paints.
        pub step: Option<u64>,
    }
}

message! {
    /// A small picture.
    pub struct ThumbnailReply [version 1, at most 1048576 bytes] {
        /// Pixels across; 0 where there is no such version or step.
        pub width: u32,
        /// Pixels down.
        pub height: u32,
        /// sRGB, three bytes a pixel from the top row.
        pub rgb: ByteBuf,
        /// The newest tile version that it shows, of the painting as it is.
        pub version: u64,
    }
}
