//! A take: the samples of a stylus as an MCAP file, one channel `stylus/<device>/sample` whose
//! messages are those of the bus, header and all. `log_time` is the time since the take's start.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

pub use maulstick_motion::TakeSample;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Message as _, Origin, encode, name_hash};
use mcap::records::MessageHeader;

use crate::take_setup::TakeSetup;

/// Encoding of the messages: the bus's own header and body.
pub const MESSAGE_ENCODING: &str = "x-maulstick";
/// Encoding of the schemas: header and field table as JSON, with how they are encoded.
pub const SCHEMA_ENCODING: &str = "x-maulstick-fields+json";

/// Bytes of samples that are compressed together, and lost together where one is damaged.
const CHUNK_BYTES: u64 = 64 << 10;

/// The samples of one stylus, in order of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    /// Name of the device.
    pub device: String,
    /// At least one.
    pub samples: Vec<TakeSample>,
    /// Embedded setup, if any.
    pub setup: Option<TakeSetup>,
}

impl Take {
    /// Length from the first sample to the last, ns.
    #[must_use]
    pub fn length_ns(&self) -> u64 {
        match (self.samples.first(), self.samples.last()) {
            (Some(first), Some(last)) => last.time_ns - first.time_ns,
            _ => 0,
        }
    }

    /// Writes the take: whole under its name, or not at all.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), UserError> {
        write_whole(path, Kind::Take, |file| {
            self.write_to(file).map_err(std::io::Error::other)
        })
        .map_err(|error| UserError::writing(path, &error))
    }

    fn write_to(&self, file: &mut BufWriter<File>) -> mcap::McapResult<()> {
        let mut writer = mcap::WriteOptions::new()
            .profile("maulstick")
            .library(concat!("maulstick ", env!("CARGO_PKG_VERSION")))
            .compression(Some(mcap::Compression::Zstd))
            .compression_threads(0)
            .chunk_size(Some(CHUNK_BYTES))
            .create(file)?;
        if let Some(setup) = &self.setup {
            setup.write(&mut writer)?;
        }
        let fields = serde_json::to_vec(&StylusSample::schema().whole()).unwrap_or_default();
        let schema = writer.add_schema("StylusSample/1", SCHEMA_ENCODING, &fields)?;
        let topic = format!("stylus/{}/sample", self.device);
        let no_metadata = std::collections::BTreeMap::new();
        let channel_id = writer.add_channel(schema, &topic, MESSAGE_ENCODING, &no_metadata)?;
        let origin = Origin {
            source: name_hash(&self.device),
            epoch: 1,
        };
        for (number, TakeSample { time_ns, sample }) in self.samples.iter().enumerate() {
            let flags = if number == 0 {
                Flags::FIRST
            } else {
                Flags::NONE
            };
            let bytes = encode(&origin, flags, number as u64, *time_ns, *time_ns, sample)
                .map_err(|error| mcap::McapError::Io(std::io::Error::other(error)))?;
            let header = MessageHeader {
                channel_id,
                sequence: number as u32,
                log_time: *time_ns,
                publish_time: *time_ns,
            };
            writer.write_to_known_channel(&header, &bytes)?;
        }
        writer.finish()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use maulstick_streams::{FieldTable, RecordingWriter};
    use maulstick_types::{HEADER_BYTES, Header};

    use super::*;
    use crate::salvage::{Refusal, from_bytes, salvage};

    fn take() -> Take {
        let sample = |i: u64| TakeSample {
            time_ns: i * 8_000_000,
            sample: StylusSample {
                switches: i as u32,
                ..StylusSample::away()
            },
        };
        Take {
            device: "pen".into(),
            samples: (0..5000).map(sample).collect(),
            setup: None,
        }
    }

    #[test]
    fn what_is_written_is_read_and_twice_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths = [folder.path().join("a.mcap"), folder.path().join("b.mcap")];
        for path in &paths {
            take().write(path).expect("written");
        }
        assert_eq!(Take::read(&paths[0]), Ok(take()));
        let bytes = paths.map(|path| std::fs::read(path).expect("read"));
        assert!(bytes[0] == bytes[1]);
    }

    #[test]
    fn the_samples_of_a_recording_are_those_that_are_not_json() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("s.mcap");
        let mut writer =
            RecordingWriter::begin(File::create(&path).expect("created")).expect("begun");
        let table = FieldTable::of(StylusSample::schema()).expect("a table");
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        let samples = &take().samples[..3];
        for TakeSample { time_ns, sample } in samples {
            let at_ns = *time_ns;
            let bytes = encode(&origin, Flags::NONE, 0, at_ns, at_ns, sample).expect("encoded");
            let header = Header::from_bytes(&bytes).expect("a header");
            let value = table.decode(&bytes[HEADER_BYTES..]).expect("decoded");
            let topic = "stylus/pen/sample";
            let written = writer.write(topic, &header, &bytes, at_ns);
            written.expect("written");
            let written = writer.write_json(topic, &table, &header, &value, at_ns);
            written.expect("written");
        }
        writer.finish().expect("finished");
        assert_eq!(Take::read(&path).expect("read").samples, samples);
    }

    /// Writes the samples of a take in an order of their numbers, as another program may.
    fn write_in(path: &Path, options: mcap::WriteOptions, order: impl Iterator<Item = usize>) {
        let file = BufWriter::new(File::create(path).expect("created"));
        let mut writer = options.create(file).expect("begun");
        let no_metadata = std::collections::BTreeMap::new();
        let channel_id = writer
            .add_channel(0, "stylus/pen/sample", MESSAGE_ENCODING, &no_metadata)
            .expect("added");
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        let take = take();
        for number in order {
            let TakeSample { time_ns, sample } = &take.samples[number];
            let sequence = number as u64;
            let bytes = encode(&origin, Flags::NONE, sequence, *time_ns, *time_ns, sample);
            let header = MessageHeader {
                channel_id,
                sequence: number as u32,
                log_time: *time_ns,
                publish_time: *time_ns,
            };
            let bytes = bytes.expect("encoded");
            writer
                .write_to_known_channel(&header, &bytes)
                .expect("written");
        }
        writer.finish().expect("finished");
    }

    #[test]
    fn samples_are_read_in_the_order_of_their_numbers_wherever_they_stand() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.mcap");
        let count = take().samples.len();
        for options in [
            mcap::WriteOptions::new(),
            mcap::WriteOptions::new().chunk_size(Some(4096)),
            mcap::WriteOptions::new().use_chunks(false),
        ] {
            write_in(&path, options, (0..count).map(|place| place * 61 % count));
            assert_eq!(Take::read(&path), Ok(take()));
        }
    }

    #[test]
    fn a_sample_that_came_late_stands_where_it_was_sent() {
        let numbered = |number: u64, time_ns: u64| crate::salvage::Numbered {
            epoch: 1,
            number,
            sample: TakeSample {
                time_ns,
                sample: StylusSample::away(),
            },
        };
        let found = vec![
            numbered(0, 5),
            numbered(2, 7),
            numbered(1, 8),
            numbered(3, 9),
        ];
        let times = crate::salvage::in_order(found);
        let times: Vec<u64> = times.iter().map(|own| own.time_ns).collect();
        assert_eq!(times, [5, 7, 7, 9]);
    }

    fn with_a_setup() -> Take {
        let mut setup = TakeSetup::default();
        setup.add(b"paint".to_vec(), "csv");
        setup.settings = setup.add(b"[canvas]".to_vec(), "toml");
        setup.loads = vec!["Ultramarine Blue".into(), "Titanium White".into()];
        Take {
            setup: Some(setup),
            ..take()
        }
    }

    #[test]
    fn what_a_take_embeds_is_what_it_was_or_damaged() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.mcap");
        with_a_setup().write(&path).expect("written");
        assert_eq!(Take::read(&path), Ok(with_a_setup()));
        let mut bytes = std::fs::read(&path).expect("read");
        let at = bytes.windows(8).position(|found| found == b"[canvas]");
        bytes[at.expect("embedded as it is")] ^= 1;
        std::fs::write(&path, &bytes).expect("written");
        let fault = Take::read(&path).expect_err("damaged").to_string();
        assert!(
            fault.contains("embeds") && fault.contains("5000"),
            "{fault}"
        );
        let whole = salvage(&path).expect("its samples");
        assert_eq!(whole.take, take());
    }

    #[test]
    fn a_truncated_take_says_what_is_whole_wherever_it_ends() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.mcap");
        take().write(&path).expect("written");
        let whole = std::fs::read(&path).expect("read");
        for keep in (1..whole.len()).step_by(whole.len() / 97) {
            std::fs::write(&path, &whole[..keep]).expect("cut");
            let fault = Take::read(&path).expect_err("cut").to_string();
            assert!(
                fault.contains("a.mcap") && fault.contains("help"),
                "{keep}: {fault}"
            );
        }
    }

    #[test]
    fn other_files_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.mcap");
        std::fs::write(&path, "0.1 2 3 4\n".repeat(50)).expect("written");
        let bytes = std::fs::read(&path).expect("read");
        assert_eq!(from_bytes(&bytes), Err(Refusal::Foreign));
        assert!(Take::read(&path).is_err());
        std::fs::write(&path, "").expect("written");
        assert!(Take::read(&path).is_err());
        assert!(
            Take::read(&folder.path().join("none"))
                .expect_err("none")
                .what
                .contains("read")
        );
    }
}
