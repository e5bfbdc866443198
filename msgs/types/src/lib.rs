//! Messages between the processes of a rig.
//!
//! Every message is one definition (`define.rs`) from which its struct, its codec, its field
//! table, its schema hash and its size limit follow. On the wire a message is a 48-byte
//! [`Header`] and a body in little-endian, fixed-width bincode. This crate knows no transport.
//!
//! | module | holds |
//! | --- | --- |
//! | [`header`] | the header, flags, and the errors of reading a message |
//! | [`schema`] | field tables and their hash |
//! | [`topics`] | the key expressions of a rig |
//! | [`reply_cache`] | the newest reply to each client |
//! | [`advice`] | what to do about something that is wrong |
//! | [`edits`] | edits of a painting, one in one file |
//! | [`values`] | numbers and names that are in range |
//! | [`stylus`], [`control`], [`haptics`], [`brush`], [`scene`], [`paint`], [`command`], [`window`] | the messages |

mod codec;
mod define;
mod frame_view;
mod plain;

pub mod advice;
pub mod brush;
pub mod catalogue;
pub mod command;
pub mod control;
pub mod edits;
pub mod haptics;
pub mod header;
pub mod mixture;
pub mod paint;
pub mod pose;
pub mod region;
pub mod reply_cache;
pub mod scene;
pub mod schema;
pub mod stylus;
pub mod topics;
pub mod values;
pub mod window;

pub use advice::nearest;
pub use catalogue::{CATALOGUE, CatalogueEntry};
pub use codec::{Message, decode, encode, encode_into, encoded_bytes};
pub use frame_view::{FrameTileView, FrameView};
pub use header::{DecodeError, Flags, HEADER_BYTES, Header, Origin};
pub use mixture::{Mixture, MixtureError};
pub use plain::plain;
pub use pose::Pose;
pub use region::Region;

/// The FNV-1a hash of `text`, by which sources, schemas and files are named.
#[must_use]
pub fn name_hash(text: &str) -> u32 {
    schema::fnv1a(text.as_bytes())
}
