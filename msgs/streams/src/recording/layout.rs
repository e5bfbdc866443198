//! Layout of a recording: its topics, chunks, notes and files, as its summary says, or all of its records.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Result;

use mcap::MAGIC;
use mcap::records::{Record, op};

use super::attachment::Attachment;
use super::{Topic, message};
use crate::field_table::{FieldTable, TableError};
use crate::json_channel;
use crate::mcap_records::{Found, HEAD, records, u64_at, unpack};
use crate::mcap_walk::{read_at, walk};
use crate::recording_writer::SCHEMA_ENCODING;

/// Length of a footer and the closing magic, bytes.
const END_BYTES: u64 = (HEAD + 20 + MAGIC.len()) as u64;

/// A chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    pub(super) at: u64,
    pub(super) bytes: u64,
    /// Times of its first and last message, ns.
    pub(super) times_ns: [u64; 2],
}

/// Layout of a recording.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// Its chunks, in order.
    pub(super) chunks: Vec<Chunk>,
    pub(super) topics: BTreeMap<u16, Topic>,
    /// What it says of itself, by name.
    pub(super) notes: BTreeMap<String, BTreeMap<String, String>>,
    /// Files that it holds, by name.
    pub(super) attachments: BTreeMap<String, Attachment>,
    /// What is wrong with it, if anything is.
    pub(super) damage: Option<String>,
}

/// Schemas and channels as they were found: schemas may come behind the channels that refer to them.
#[derive(Default)]
struct Channels {
    schemas: BTreeMap<u16, (String, std::result::Result<FieldTable, TableError>)>,
    channels: BTreeMap<u16, mcap::records::Channel>,
}

impl Layout {
    /// Reads the layout of a file.
    pub(super) fn read(file: &File, length: u64) -> Result<Self> {
        let mut layout = match summary(file, length)? {
            Some(bytes) => Self::of_summary(&bytes, file, length)?,
            None => Self::of_records(file, length)?,
        };
        layout.chunks.sort_by_key(|chunk| chunk.at);
        Ok(layout)
    }

    fn of_summary(bytes: &[u8], file: &File, length: u64) -> Result<Self> {
        let (mut layout, mut channels) = (Self::default(), Channels::default());
        for record in records(bytes, 0).filter(|record| record.whole) {
            match record.opcode {
                op::CHUNK_INDEX => layout.add_chunk(record.body, length),
                op::ATTACHMENT_INDEX => {
                    let entry = Attachment::of_index(record.body, length);
                    if entry.is_none() {
                        layout.damage = Some("its index is not that of the file".into());
                    }
                    layout.attachments.extend(entry);
                }
                op::METADATA_INDEX => {
                    let [at, bytes] = [0, 8].map(|place| u64_at(record.body, place).unwrap_or(0));
                    let note = read_at(file, length, at, bytes)?;
                    records(&note, 0)
                        .take(1)
                        .for_each(|note| layout.add_note(&note));
                }
                _ => channels.add(&record),
            }
        }
        layout.topics = channels.topics();
        Ok(layout)
    }

    /// The times that a chunk states are no others than 0 before it is ended, so they are those of its messages.
    fn of_records(file: &File, length: u64) -> Result<Self> {
        let (mut layout, mut channels) = (Self::default(), Channels::default());
        layout.damage = Some("it has no index, as after a crash".into());
        walk(
            file,
            length,
            MAGIC.len() as u64,
            &mut |record| match record.opcode {
                op::CHUNK => {
                    let unpacked = unpack(record.body);
                    let mut times_ns = [u64::MAX, 0];
                    for own in records(&unpacked.bytes, 0).filter(|own| own.whole) {
                        channels.add(&own);
                        if let Some(message) = message(&own) {
                            let at_ns = message.arrived_ns;
                            times_ns = [times_ns[0].min(at_ns), times_ns[1].max(at_ns)];
                        }
                    }
                    if times_ns[0] <= times_ns[1] {
                        layout.chunks.push(Chunk {
                            at: record.at as u64,
                            bytes: (HEAD + record.body.len()) as u64,
                            times_ns,
                        });
                    }
                }
                op::ATTACHMENT if record.whole => {
                    layout.attachments.extend(Attachment::of(record, length));
                }
                op::METADATA => layout.add_note(record),
                _ if record.whole => channels.add(record),
                _ => {}
            },
        )?;
        layout.topics = channels.topics();
        Ok(layout)
    }

    fn add_chunk(&mut self, entry: &[u8], length: u64) {
        let [first, last, at, bytes] =
            [0, 8, 16, 24].map(|place| u64_at(entry, place).unwrap_or(0));
        let fits = at.checked_add(bytes).is_some_and(|end| end <= length);
        if !fits || first > last {
            self.damage = Some("its index is not that of the file".into());
            return;
        }
        self.chunks.push(Chunk {
            at,
            bytes,
            times_ns: [first, last],
        });
    }

    fn add_note(&mut self, record: &Found<'_>) {
        if record.whole
            && record.opcode == op::METADATA
            && let Ok(Record::Metadata(note)) = mcap::parse_record(op::METADATA, record.body)
        {
            self.notes.insert(note.name, note.metadata);
        }
    }
}

impl Channels {
    fn add(&mut self, record: &Found<'_>) {
        match record.opcode {
            op::SCHEMA => {
                if let Ok(Record::Schema { header, data }) =
                    mcap::parse_record(op::SCHEMA, record.body)
                {
                    self.schemas.entry(header.id).or_insert_with(|| {
                        let table = match header.encoding.as_str() {
                            SCHEMA_ENCODING => FieldTable::parse(&data),
                            other => Err(TableError::Json(format!("its encoding is '{other}'"))),
                        };
                        (header.name, table)
                    });
                }
            }
            op::CHANNEL => {
                if let Ok(Record::Channel(channel)) = mcap::parse_record(op::CHANNEL, record.body)
                    && channel.message_encoding != json_channel::MESSAGE_ENCODING
                {
                    self.channels.entry(channel.id).or_insert(channel);
                }
            }
            _ => {}
        }
    }

    fn topics(self) -> BTreeMap<u16, Topic> {
        let topic = |(id, channel): (u16, mcap::records::Channel)| {
            let schema = self.schemas.get(&channel.schema_id).cloned();
            let unknown = || TableError::Type(format!("number {}", channel.schema_id));
            let topic = Topic {
                name: channel.topic,
                message: schema.as_ref().map(|(name, _)| name.clone()),
                table: schema.map_or_else(|| Err(unknown()), |(_, table)| table),
            };
            (id, topic)
        };
        self.channels.into_iter().map(topic).collect()
    }
}

/// The summary, if the file has one.
fn summary(file: &File, length: u64) -> Result<Option<Vec<u8>>> {
    let Some(end) = length.checked_sub(END_BYTES) else {
        return Ok(None);
    };
    let footer = read_at(file, length, end, END_BYTES)?;
    let whole = footer[0] == op::FOOTER && footer.ends_with(MAGIC);
    let start = u64_at(&footer[HEAD..], 0).filter(|start| whole && *start < end);
    let Some(start) = start.filter(|start| *start >= MAGIC.len() as u64) else {
        return Ok(None);
    };
    // The checksum is of all up to itself, behind the footer's two numbers.
    let mut summary = read_at(file, length, start, end - start + HEAD as u64 + 16)?;
    let crc = footer[HEAD + 16..HEAD + 20].first_chunk();
    let crc = crc.copied().map_or(0, u32::from_le_bytes);
    let is_sound = crc == 0 || crc32fast::hash(&summary) == crc;
    summary.truncate((end - start) as usize);
    Ok(is_sound.then_some(summary))
}
