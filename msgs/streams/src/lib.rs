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
//! Ten seconds of a stylus of 1 kHz that loses each hundredth sample, written, read back and measured:
//!
//! ```
//! use maulstick_streams::traffic::Arrived;
//! use maulstick_streams::{Recording, RecordingWriter, Traffic};
//! use maulstick_types::stylus::StylusSample;
//! use maulstick_types::{Flags, Header, Origin, encode};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("hand.mcap");
//! let mut writer = RecordingWriter::begin(std::fs::File::create(&path)?)?;
//! let hand = Origin { source: 1, epoch: 1 };
//! for seq in (0..10_000).filter(|seq| seq % 100 != 50) {
//!     let ns = seq * 1_000_000;
//!     let bytes = encode(&hand, Flags::NONE, seq, ns, ns, &StylusSample::away())?;
//!     writer.write("stylus/hand/sample", &Header::from_bytes(&bytes)?, &bytes, ns + 80_000)?;
//! }
//! writer.finish()?;
//!
//! let mut recording = Recording::open(&path)?;
//! let topics = recording.topics().clone();
//! let mut traffic = Traffic::default();
//! recording.messages([0, u64::MAX], &mut |read| {
//!     let (header, bytes) = (read.header, read.bytes.len());
//!     let arrived = Arrived { header, bytes, arrived_ns: read.arrived_ns };
//!     traffic.add(&topics[&read.channel].name, &arrived);
//!     true
//! })?;
//! for (topic, _, stream) in traffic.streams() {
//!     println!("{topic}: {:.0} Hz, {} lost", stream.rate_hz(), stream.lost);
//!     assert_eq!((stream.lost, stream.transit.quantile(0.99)), (100, 80_000));
//!     assert!((stream.rate_hz() - 990.0).abs() < 1.0);
//! }
//! # Ok(())
//! # }
//! ```
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
