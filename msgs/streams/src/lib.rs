//! Streams of a rig as data, whatever their messages are.
//!
//! | module | holds |
//! | --- | --- |
//! | [`catalogue`] | this program's messages by their hash |
//! | [`field_table`] | bodies of messages, decoded by their field tables |
//! | [`value`] | what comes of it |
//! | [`translate`] | messages of other versions as those of this program |
//! | [`topic_pattern`] | patterns of topics |
//! | [`json_channel`] | messages as JSON, for viewers |
//! | [`rate_limit`] | streams thinned to a rate |
//! | [`traffic`] | rates, losses and delays |
//! | [`recording_writer`], [`recording`] | recordings, written and read |
//! | [`recovery`] | what is left of a damaged recording |
//! | [`mcap_records`], `mcap_walk` | records of MCAP files, read within their bounds |

pub mod catalogue;
pub mod field_table;
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
pub mod value;

pub use field_table::{FieldTable, TableError};
pub use rate_limit::RateLimit;
pub use recording::Recording;
pub use recording_writer::RecordingWriter;
pub use traffic::Traffic;
pub use value::Value;
