//! Messages between the processes of a rig.
//!
//! Every message is one definition (`wire/define.rs`) from which its struct, its codec, its field
//! table, its schema hash and its size limit follow. On the wire a message is a 48-byte
//! [`Header`] and a body in little-endian, fixed-width bincode. This crate knows no transport.
//!
//! | module | holds |
//! | --- | --- |
//! | [`wire`] | header, codec, field tables and their hash, the key expressions of a rig |
//! | [`stylus`], [`control`], [`haptics`], [`brush`], [`scene`], [`paint`], [`command`], [`window`], [`node`] | the messages |
//! | [`edit`] | edits of a painting, by name and fields |
//! | [`values`], [`limits`] | numbers and names that are in range, and the ranges |
//! | [`nearest`](mod@nearest) | the known name that was probably meant |
//! | [`pose`], [`region`], [`mixture`] | where something is, a part of a surface, a mixture of paints |
//!
//! A pen that touches 20 mm right of the canvas's middle, as bytes of the wire and back:
//!
//! ```
//! use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
//! use maulstick_types::{Flags, HEADER_BYTES, Origin, decode, encode, name_hash};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let sample = StylusSample {
//!     pose: StylusPose::Contact {
//!         point_m: [0.02, 0.0, 0.0],
//!         tilt_rad: DEFAULT_TILT_RAD,
//!         twist_rad: 0.0,
//!         pressure: 0.5,
//!     },
//!     in_range: true,
//!     ..StylusSample::away()
//! };
//! let pen = Origin { source: name_hash("my-pen"), epoch: 1 };
//! let (sampled_ns, sent_ns) = (1_500_000_000, 1_500_400_000);
//! let bytes = encode(&pen, Flags::FIRST, 0, sampled_ns, sent_ns, &sample)?;
//!
//! let (header, read) = decode::<StylusSample>(&bytes)?;
//! assert_eq!(read, sample);
//! assert_eq!((header.origin(), header.event_ns), (pen, sampled_ns));
//! assert!(decode::<StylusSample>(&bytes[..HEADER_BYTES]).is_err(), "the body is missing");
//! # Ok(())
//! # }
//! ```
//!
//! # Versions
//!
//! The header holds magic, version, schema hash, source, epoch, flags, length, sequence number, event time and send
//! time. Fields are only appended, and the version rises with them. Programs of one rig speak one version; recordings
//! carry the field tables of their messages and are translated when read. Two statuses, `PaintStatus` and `TakeStatus`,
//! are read by no program of another version and may be redefined.
//!
//! The messages of a device are a contract, `STYLUS_CONTRACT`. `tests/golden.txt` pins the bytes of every version, and
//! `tests/contract.txt` never changes.
//!
//! # Topics
//!
//! Below `maulstick/<rig>/`. A cached topic sends its last value to late joiners; a query is answered by the receiver.
//!
//! | topic | message | from → to |
//! | --- | --- | --- |
//! | `stylus/<device>/sample` | `StylusSample` | device → brush, window |
//! | `stylus/<device>/info`, `/status`, `/take` | `StylusInfo` (cached), `StylusStatus`, `TakeStatus` | device → all |
//! | `control/<device>/sample` | `ControlSample` | 6-DOF mouse → all |
//! | `haptics/<device>/model` | `ContactModel` | brush, by consent `recording replay --drive` → device |
//! | `haptics/<device>/guide` | `GuideModel` | `recording replay --guide` → device |
//! | `haptics/<device>/fluid` | `FluidForce` | brush, `recording replay --drive` → device |
//! | `haptics/<device>/force` (query) | `ForceRequest` → `ForceReply` | window, command line, `recording replay` → device |
//! | `brush/<brush>/def` | `BrushDef` (cached) | brush → paint, window |
//! | `brush/<brush>/state` | `BrushState` | brush → paint, window |
//! | `brush/<brush>/look` | `BrushLook` (cached) | paint → window |
//! | `brush/<brush>/relief` | `BrushRelief` | paint → brush |
//! | `brush/<brush>/consumed`, `paint/consumed` | `BrushConsumed`, `PaintConsumed` | receiver → sender: credit |
//! | `scene` | `Scene` (cached) | paint → all |
//! | `paint/journal`, `paint/status` | `JournalEntry`, `PaintStatus` | paint → all |
//! | `paint/frame` (query) | `FrameRequest` → `FrameReply` | window → paint |
//! | `paint/thumbnail` (query) | `ThumbnailRequest` → `ThumbnailReply` | window → paint |
//! | `ui/presented` | `Presented` | window → all |
//! | `ui/pending` | `PendingOrders` | window → brush |
//! | `command/<node>` (query) | `CommandRequest` → `CommandReply` | window, command line, device, player → node |
//! | `gap/<stream>` (query) | `GapRequest` → lost messages | receiver → sender |
//! | `node/<name>` | liveliness token | node |
//! | `node/<name>/status` | `NodeStatus` | node → launcher, all |
//!
//! # Frames
//!
//! - Desk: origin in the middle of the working area, x right, y up along the surface, z out of it toward the painter.
//! - Surface: origin at the lower left corner, x right, y up, z out. Cell (i, j) begins at (i·h, j·h) and is h wide;
//!   row 0 is the bottom one; pictures flip y. Zoom scales a surface, not the brush.
//! - Brush: origin where head and ferrule meet, bristles along −z. Quaternions are x, y, z, w.
//!
//! # Edits and commands
//!
//! - An edit travels as its name and its fields in JSON, so that another one changes no message. Its struct is in the
//!   painting; a device that asks for one and does not know the painting names it.
//! - Numbers and names with a range are types of `values`, so what is read is valid; a request that does not decode is
//!   answered with the reason. What to do about a refusal travels as an `Advice`, for which window, command line and
//!   script have their own words.
//! - Commands are nested by who carries them out (edit, take, file, brush, rig, session), so each node matches its own
//!   exhaustively. They carry a client id and a number, and a reply cache makes them safe to repeat; the sequencer's
//!   cache is saved with the painting. Batches of a replayed session have numbers of their own. `after` places a
//!   command right behind a brush state.

pub mod brush;
pub mod command;
pub mod control;
pub mod edit;
pub mod haptics;
pub mod limits;
pub mod mixture;
pub mod nearest;
pub mod node;
pub mod paint;
pub mod pose;
pub mod region;
pub mod scene;
pub mod stylus;
pub mod values;
pub mod window;
pub mod wire;

pub use edit::{Edit, EditFault, EditFields};
pub use mixture::{Mixture, MixtureError};
pub use nearest::nearest;
pub use paint::frame_view::{FrameTileView, FrameView};
pub use pose::Pose;
pub use region::Region;
pub use wire::catalogue::{CATALOGUE, CatalogueEntry};
pub use wire::codec::{Message, decode, encode, encode_into, encoded_bytes};
pub use wire::header::{DecodeError, Flags, HEADER_BYTES, Header, Origin};
pub use wire::plain::plain;

/// The contract of devices with a rig: its messages keep the hashes of their first versions, and programs of all later
/// versions read each other's. Fields are only appended, and to the messages themselves: the types inside them, their
/// variants and the size limits stay. What appended fields an older message lacks is 0, none or empty.
pub const STYLUS_CONTRACT: &str = "stylus/1";

/// The FNV-1a hash of `text`, by which sources, schemas and files are named.
#[must_use]
pub fn name_hash(text: &str) -> u32 {
    wire::schema::fnv1a(text.as_bytes())
}
