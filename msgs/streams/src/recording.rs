//! Reads a recording: by its index, or, where it has none as after a crash, by all of its records. JSON channels, which are
//! for viewers, are left alone.
//!
//! No length that the file states is believed before it is compared with the file.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;
use maulstick_types::wire::header::{HEADER_BYTES, Header};
use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::field_table::{FieldTable, TableError};
use crate::json_channel;
use crate::mcap_records::{Found, HEAD, records, unpack};
use crate::recording_writer::SCHEMA_ENCODING;
use crate::value::Value;

/// Length of a footer and the closing magic, bytes.
const END_BYTES: u64 = (HEAD + 20 + MAGIC.len()) as u64;
/// Largest chunk that is read, bytes; those of a recorder have a quarter of a megabyte before they are compressed.
const MOST_CHUNK: u64 = 256 << 20;

/// A recording on the disk.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    file: File,
    length: u64,
    /// Its chunks, in order.
    chunks: Vec<Chunk>,
    topics: BTreeMap<u16, Topic>,
    /// What it says of itself, by name.
    pub notes: BTreeMap<String, BTreeMap<String, String>>,
    /// Files that it holds, by name.
    pub files: BTreeMap<String, Vec<u8>>,
    /// What is wrong with it, if anything is.
    pub damage: Option<String>,
}

/// A chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chunk {
    at: u64,
    bytes: u64,
    /// Times of its first and last message, ns.
    times_ns: [u64; 2],
}

/// A topic.
#[derive(Clone, Debug)]
pub struct Topic {
    /// Its name, without a rig's prefix.
    pub name: String,
    /// Name and version of its messages, where they are known.
    pub message: Option<String>,
    /// How its messages are decoded, or why they cannot be.
    pub table: Result<FieldTable, TableError>,
}

/// A message of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedMessage {
    /// Number of its channel.
    pub channel: u16,
    /// When it arrived, rig clock, ns.
    pub arrived_ns: u64,
    /// Its header.
    pub header: Header,
    /// Header and body.
    pub bytes: Vec<u8>,
}

impl Topic {
    /// A topic of messages of a table.
    #[cfg(test)]
    pub(crate) fn of(table: FieldTable) -> Self {
        Self {
            name: String::new(),
            message: None,
            table: Ok(table),
        }
    }

    /// Name of its messages, where their table is known.
    pub(crate) fn message_name(&self) -> Option<&str> {
        self.table.as_ref().ok().map(FieldTable::name)
    }

    /// True if a message may have a value at a path.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        self.table.as_ref().is_ok_and(|table| table.has(path))
    }

    /// What a message holds.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn decode(&self, bytes: &[u8]) -> Result<Value, TableError> {
        let table = self.table.as_ref().map_err(Clone::clone)?;
        table.decode(bytes.get(HEADER_BYTES..).unwrap_or_default())
    }
}

impl Recording {
    /// Opens a recording.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, or is none.
    pub fn open(path: &Path) -> Result<Self, UserError> {
        let reading = |error: std::io::Error| UserError::reading(path, &error);
        let mut file = File::open(path).map_err(reading)?;
        let length = file.metadata().map_err(reading)?.len();
        let mut recording = Self {
            path: path.to_owned(),
            length,
            chunks: Vec::new(),
            topics: BTreeMap::new(),
            notes: BTreeMap::new(),
            files: BTreeMap::new(),
            damage: None,
            file: file.try_clone().map_err(reading)?,
        };
        let mut magic = [0; MAGIC.len()];
        let begun = file.read_exact(&mut magic).is_ok() && magic == *MAGIC;
        if !begun {
            return Err(UserError::usage("this is no MCAP file")
                .at(path.display().to_string())
                .help("`maulstick record` writes recordings"));
        }
        match recording.summary().map_err(reading)? {
            Some(summary) => recording.read_summary(&summary),
            None => {
                recording.damage = Some("it has no index, as after a crash".into());
                let bytes = std::fs::read(path).map_err(reading)?;
                recording.read_summary(&bytes[MAGIC.len()..]);
                recording.scan(&bytes);
            }
        }
        Ok(recording)
    }

    /// The summary, if the file has one.
    fn summary(&mut self) -> std::io::Result<Option<Vec<u8>>> {
        let Some(end) = self.length.checked_sub(END_BYTES) else {
            return Ok(None);
        };
        let footer = self.read(end, END_BYTES)?;
        let whole = footer[0] == op::FOOTER && footer.ends_with(MAGIC);
        let start = number(&footer[HEAD..], 0).filter(|start| whole && *start < end);
        let Some(start) = start.filter(|start| *start >= MAGIC.len() as u64) else {
            return Ok(None);
        };
        // The checksum is of all up to itself, behind the footer's two numbers.
        let mut summary = self.read(start, end - start + HEAD as u64 + 16)?;
        let crc = footer[HEAD + 16..HEAD + 20].first_chunk();
        let crc = crc.copied().map_or(0, u32::from_le_bytes);
        let is_sound = crc == 0 || crc32fast::hash(&summary) == crc;
        summary.truncate((end - start) as usize);
        Ok(is_sound.then_some(summary))
    }

    /// Bytes of the file that it has.
    fn read(&mut self, at: u64, bytes: u64) -> std::io::Result<Vec<u8>> {
        let bytes = bytes.min(self.length.saturating_sub(at));
        self.file.seek(SeekFrom::Start(at))?;
        let mut read = vec![0; usize::try_from(bytes).unwrap_or(0)];
        self.file.read_exact(&mut read)?;
        Ok(read)
    }

    /// Reads schemas, channels, indexes, notes and files; schemas first, for channels refer to them.
    fn read_summary(&mut self, bytes: &[u8]) {
        let found: Vec<Found<'_>> = records(bytes, 0).filter(|record| record.whole).collect();
        let mut schemas = BTreeMap::new();
        let all = |inner: &mut dyn FnMut(&Found<'_>)| {
            for record in &found {
                inner(record);
                if record.opcode == op::CHUNK {
                    let unpacked = unpack(record.body);
                    records(&unpacked.bytes, 0)
                        .filter(|own| own.whole)
                        .for_each(|own| inner(&own));
                }
            }
        };
        all(&mut |record| {
            if record.opcode == op::SCHEMA
                && let Ok(Record::Schema { header, data }) =
                    mcap::parse_record(op::SCHEMA, record.body)
            {
                let table = match header.encoding.as_str() {
                    SCHEMA_ENCODING => FieldTable::parse(&data),
                    other => Err(TableError::Json(format!("its encoding is '{other}'"))),
                };
                schemas.insert(header.id, (header.name, table));
            }
        });
        let mut topics = BTreeMap::new();
        all(&mut |record| {
            if record.opcode == op::CHANNEL
                && let Ok(Record::Channel(channel)) = mcap::parse_record(op::CHANNEL, record.body)
                && channel.message_encoding != json_channel::MESSAGE_ENCODING
            {
                let schema = schemas.get(&channel.schema_id).cloned();
                let unknown = || TableError::Type(format!("number {}", channel.schema_id));
                let topic = Topic {
                    name: channel.topic.clone(),
                    message: schema.as_ref().map(|(name, _)| name.clone()),
                    table: schema.map_or_else(|| Err(unknown()), |(_, table)| table),
                };
                topics.entry(channel.id).or_insert(topic);
            }
        });
        self.topics = topics;
        for record in &found {
            let numbers = [0, 1, 2, 3].map(|place| number(record.body, place).unwrap_or(0));
            match record.opcode {
                op::CHUNK_INDEX => {
                    let [first, last, at, bytes] = numbers;
                    let fits = at.checked_add(bytes).is_some_and(|end| end <= self.length);
                    if !fits || first > last {
                        self.damage = Some("its index is not that of the file".into());
                        continue;
                    }
                    self.chunks.push(Chunk {
                        at,
                        bytes,
                        times_ns: [first, last],
                    });
                }
                op::METADATA_INDEX | op::ATTACHMENT_INDEX => {
                    let [at, bytes, ..] = numbers;
                    let side = self.read(at, bytes).unwrap_or_default();
                    records(&side, 0)
                        .take(1)
                        .for_each(|side| self.read_aside(&side));
                }
                _ => self.read_aside(record),
            }
        }
        self.chunks.sort_by_key(|chunk| chunk.at);
    }

    /// Reads a note or a file that stands beside the messages.
    fn read_aside(&mut self, record: &Found<'_>) {
        if !record.whole || ![op::METADATA, op::ATTACHMENT].contains(&record.opcode) {
            return;
        }
        match mcap::parse_record(record.opcode, record.body) {
            Ok(Record::Metadata(note)) => drop(self.notes.insert(note.name, note.metadata)),
            Ok(Record::Attachment { header, data, .. }) => {
                self.files.insert(header.name, data.into_owned());
            }
            _ => {}
        }
    }

    /// Finds the chunks of a file without an index. The times that a chunk states are no others than 0 before it is ended.
    fn scan(&mut self, bytes: &[u8]) {
        self.chunks.clear();
        for record in records(bytes, MAGIC.len()).filter(|record| record.opcode == op::CHUNK) {
            let unpacked = unpack(record.body);
            let arrived = || {
                let inner = records(&unpacked.bytes, 0).filter(|own| own.whole);
                inner.filter_map(|own| Some(message(&own)?.arrived_ns))
            };
            if let (Some(first), Some(last)) = (arrived().min(), arrived().max()) {
                self.chunks.push(Chunk {
                    at: record.at as u64,
                    bytes: (HEAD + record.body.len()) as u64,
                    times_ns: [first, last],
                });
            }
        }
    }

    /// Its topics, by the numbers of their channels.
    #[must_use]
    pub fn topics(&self) -> &BTreeMap<u16, Topic> {
        &self.topics
    }

    /// Times of its first and last message, rig clock, ns; `None` if it has none.
    #[must_use]
    pub fn times_ns(&self) -> Option<[u64; 2]> {
        let first = self.chunks.iter().map(|chunk| chunk.times_ns[0]).min()?;
        let last = self.chunks.iter().map(|chunk| chunk.times_ns[1]).max()?;
        Some([first, last])
    }

    /// Has `each` see the messages that arrived in a range of times, in the order of the file, until it says false.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be read. What is damaged is left out, and noted in [`Self::damage`].
    pub fn messages(
        &mut self,
        [from_ns, to_ns]: [u64; 2],
        each: &mut dyn FnMut(RecordedMessage) -> bool,
    ) -> Result<(), UserError> {
        for chunk in self.chunks.clone() {
            let [first, last] = chunk.times_ns;
            if last < from_ns || first > to_ns {
                continue;
            }
            if chunk.bytes > MOST_CHUNK {
                self.damage
                    .get_or_insert("a chunk is too large to be read".into());
                continue;
            }
            let bytes = self.read(chunk.at, chunk.bytes);
            let bytes = bytes.map_err(|error| UserError::reading(&self.path, &error))?;
            let unpacked = unpack(bytes.get(HEAD..).unwrap_or_default());
            if let Some(damage) = unpacked.damage {
                self.damage.get_or_insert(damage);
            }
            for record in records(&unpacked.bytes, 0).filter(|own| own.whole) {
                let Some(message) = message(&record) else {
                    continue;
                };
                let is_meant = (from_ns..=to_ns).contains(&message.arrived_ns);
                if is_meant && !each(message) {
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}

/// The number at a place among the first of a record, u64 each.
fn number(body: &[u8], place: usize) -> Option<u64> {
    let bytes = body.get(8 * place..)?.first_chunk()?;
    Some(u64::from_le_bytes(*bytes))
}

/// The message of a record, if it is one of the bus.
fn message(record: &Found<'_>) -> Option<RecordedMessage> {
    if record.opcode != op::MESSAGE {
        return None;
    }
    let Ok(Record::Message { header, data }) = mcap::parse_record(op::MESSAGE, record.body) else {
        return None;
    };
    Some(RecordedMessage {
        channel: header.channel_id,
        arrived_ns: header.log_time,
        header: Header::from_bytes(&data).ok()?,
        bytes: data.into_owned(),
    })
}
