//! Streams of a rig as data, whatever their messages are.
//!
//! | module | holds |
//! | --- | --- |
//! | [`catalogue`] | this program's messages by their hash |
//! | [`translate`] | messages of other versions as those of this program |
//! | [`topic_pattern`] | patterns of topics |
//! | [`json_channel`] | messages as JSON, for viewers |
//! | [`rate_limit`] | streams thinned to a rate |
//! | [`traffic`] | rates, losses and delays |
//! | [`recording_writer`], [`recording`] | recordings, written and read |
//! | [`recovery`] | what is left of a damaged recording |
//! | [`mcap_records`], `mcap_walk` | records of MCAP files, read within their bounds |
//!
//! # Recordings
//!
//! - A recording is MCAP with an index, flushed each half second. It is opened by the index; where a crash left none,
//!   or messages lie outside of chunks, record by record. Messages come in order of time wherever they stand.
//! - A message is read by the field table of its schema hash: this program's, or the one in the file. So appended
//!   fields of later versions and missing fields of earlier ones do no harm.
//! - No length is believed before it is compared with the bytes at hand. Attached files stay on the disk until they are
//!   asked for. A damaged recording is copied, as far as it is intact, into a whole one.
//! - For viewers the same topics are written as thinned JSON, which our own readers skip.

pub mod catalogue;
pub mod json_channel;
pub mod mcap_records;
mod mcap_walk;
pub mod rate_limit;
pub mod recording;
pub mod recording_writer;
pub mod recovery;
pub mod topic_pattern;
pub mod traffic;
pub mod translate;

pub use maulstick_types::wire::field_table::{FieldTable, TableError};
pub use maulstick_types::wire::value::{Fields, Value};
pub use rate_limit::RateLimit;
pub use recording::Recording;
pub use recording_writer::RecordingWriter;
pub use traffic::Traffic;
