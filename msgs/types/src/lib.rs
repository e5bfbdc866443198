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
//! | [`edits`] | edits of a painting, one in one file |
//! | [`values`] | numbers and names that are in range |
//! | [`pose`], [`region`], [`mixture`] | where something is, a part of a surface, a mixture of paints |

pub mod brush;
pub mod command;
pub mod control;
pub mod edits;
pub mod haptics;
pub mod mixture;
pub mod node;
pub mod paint;
pub mod pose;
pub mod region;
pub mod scene;
pub mod stylus;
pub mod values;
pub mod window;
pub mod wire;

pub use command::advice::nearest;
pub use mixture::{Mixture, MixtureError};
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
