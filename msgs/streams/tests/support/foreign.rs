//! Files as other programs write them.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use maulstick_streams::recording_writer::MESSAGE_ENCODING;
use maulstick_types::Header;
use mcap::WriteOptions;
use mcap::records::MessageHeader;

use crate::sample::message;

/// Bytes of a picture.
pub(crate) const WIDE: usize = 200_000;

/// A message of a number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sample {
    /// One of the bus.
    Own(u64),
    /// The same as JSON, for viewers.
    Copy(u64),
    /// A plain picture of another program.
    Wide(u64),
}

/// Writes messages one a millisecond, by their numbers, in the order in which they come.
pub(crate) fn write_as(
    path: &Path,
    options: WriteOptions,
    samples: impl IntoIterator<Item = Sample>,
) {
    let file = BufWriter::new(File::create(path).expect("a file"));
    let mut writer = options.create(file).expect("begun");
    let mut numbers = BTreeMap::new();
    for sample in samples {
        let (topic, encoding, number, data) = match sample {
            Sample::Own(number) => {
                let bytes = message(number);
                assert_eq!(Header::from_bytes(&bytes).expect("a header").seq, number);
                ("stylus/pen/sample", MESSAGE_ENCODING, number, bytes)
            }
            Sample::Copy(number) => ("stylus/pen/sample", "json", number, b"{}".to_vec()),
            Sample::Wide(number) => ("camera", "json", number, vec![0; WIDE]),
        };
        let channel_id = *numbers.entry((topic, encoding)).or_insert_with(|| {
            let schema = writer
                .add_schema(topic, "jsonschema", b"{}")
                .expect("added");
            writer
                .add_channel(schema, topic, encoding, &BTreeMap::new())
                .expect("added")
        });
        let header = MessageHeader {
            channel_id,
            sequence: number as u32,
            log_time: number * 1_000_000,
            publish_time: number * 1_000_000,
        };
        writer
            .write_to_known_channel(&header, &data)
            .expect("written");
    }
    writer.finish().expect("finished");
}
