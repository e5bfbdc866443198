//! Writes a recording: an MCAP file with a channel for each topic, whose messages are those of the bus, header and all;
//! and, for viewers, channels of the same topics whose messages are JSON.
//! `log_time` is the time of arrival, `publish_time` that of sending, both on the rig's clock.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use maulstick_types::wire::header::Header;
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapResult, WriteOptions, Writer};

use crate::FieldTable;
use crate::Value;
use crate::catalogue::message_of;
use crate::json_channel;

/// Encoding of the messages: the bus's own header and body.
pub const MESSAGE_ENCODING: &str = "x-maulstick";
/// Encoding of the schemas: header and field table as JSON, with how they are encoded.
pub const SCHEMA_ENCODING: &str = "x-maulstick-fields+json";
/// Profile of the files.
pub const PROFILE: &str = "maulstick";
/// Bytes of records that are compressed together, and read together for one message.
const CHUNK_BYTES: u64 = 256 << 10;

/// Options of the MCAP writer.
pub(crate) fn options() -> WriteOptions {
    WriteOptions::new()
        .profile(PROFILE)
        .library(concat!("maulstick ", env!("CARGO_PKG_VERSION")))
        .compression(Some(mcap::Compression::Zstd))
        .compression_threads(0)
        .chunk_size(Some(CHUNK_BYTES))
}

/// A recording that is being written.
pub struct RecordingWriter<W: Write + Seek> {
    writer: Writer<W>,
    /// Numbers of the channels, by topic and hash of the field table.
    channels: BTreeMap<(String, u32), u16>,
    /// The same of the JSON channels.
    json_channels: BTreeMap<(String, u32), u16>,
}

impl<W: Write + Seek> RecordingWriter<W> {
    /// Begins a recording.
    ///
    /// # Errors
    /// The error of the file.
    pub fn begin(to: W) -> McapResult<Self> {
        Ok(Self {
            writer: options().create(to)?,
            channels: BTreeMap::new(),
            json_channels: BTreeMap::new(),
        })
    }

    /// Attaches a file.
    ///
    /// # Errors
    /// The error of the file.
    pub fn attach(&mut self, name: &str, media_type: &str, data: &[u8]) -> McapResult<()> {
        self.writer.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: data.into(),
        })
    }

    /// Notes what the recording says of itself.
    ///
    /// # Errors
    /// The error of the file.
    pub fn note(&mut self, name: &str, metadata: BTreeMap<String, String>) -> McapResult<()> {
        let name = name.to_owned();
        self.writer.write_metadata(&Metadata { name, metadata })
    }

    /// Writes a message of a topic; its header has been read from its bytes.
    ///
    /// # Errors
    /// The error of the file.
    pub fn write(
        &mut self,
        topic: &str,
        header: &Header,
        bytes: &[u8],
        arrived_ns: u64,
    ) -> McapResult<()> {
        let channel_id = self.channel(topic, header.schema)?;
        let header = MessageHeader {
            channel_id,
            sequence: header.seq as u32,
            log_time: arrived_ns,
            publish_time: header.sent_ns,
        };
        self.writer.write_to_known_channel(&header, bytes)
    }

    /// Writes a message of a topic as JSON, into a channel beside that of [`Self::write`].
    ///
    /// # Errors
    /// The error of the file.
    pub fn write_json(
        &mut self,
        topic: &str,
        table: &FieldTable,
        header: &Header,
        value: &Value,
        arrived_ns: u64,
    ) -> McapResult<()> {
        let key = (topic.to_owned(), table.hash());
        let channel_id = match self.json_channels.get(&key) {
            Some(channel) => *channel,
            None => {
                let (name, encoding) = (table.name(), json_channel::SCHEMA_ENCODING);
                let schema = json_channel::schema(table);
                let schema_id = self.writer.add_schema(name, encoding, &schema)?;
                let encoding = json_channel::MESSAGE_ENCODING;
                let metadata = BTreeMap::new();
                let channel = self
                    .writer
                    .add_channel(schema_id, topic, encoding, &metadata)?;
                *self.json_channels.entry(key).or_insert(channel)
            }
        };
        let message = json_channel::message(header, arrived_ns, value);
        let header = MessageHeader {
            channel_id,
            sequence: header.seq as u32,
            log_time: arrived_ns,
            publish_time: header.sent_ns,
        };
        self.writer
            .write_to_known_channel(&header, message.to_string().as_bytes())
    }

    /// The channel of a topic; without a schema where this program does not know its messages.
    fn channel(&mut self, topic: &str, schema: u32) -> McapResult<u16> {
        let key = (topic.to_owned(), schema);
        if let Some(channel) = self.channels.get(&key) {
            return Ok(*channel);
        }
        let schema_id = match message_of(schema) {
            Some(entry) => {
                let name = format!("{}/{}", entry.name, entry.version);
                let whole = (entry.schema)().whole();
                let table = serde_json::to_vec(&whole).unwrap_or_default();
                self.writer.add_schema(&name, SCHEMA_ENCODING, &table)?
            }
            None => 0,
        };
        // Channels of one topic with other messages differ in their metadata alone.
        let metadata = BTreeMap::from([("schema".to_owned(), format!("{schema:#010x}"))]);
        let channel = self
            .writer
            .add_channel(schema_id, topic, MESSAGE_ENCODING, &metadata)?;
        self.channels.insert(key, channel);
        Ok(channel)
    }

    /// Ends the chunk: what was written so far outlasts this process.
    ///
    /// # Errors
    /// The error of the file.
    pub fn flush(&mut self) -> McapResult<()> {
        self.writer.flush()
    }

    /// Ends the recording, with its index.
    ///
    /// # Errors
    /// The error of the file.
    pub fn finish(&mut self) -> McapResult<()> {
        self.writer.finish().map(drop)
    }
}
