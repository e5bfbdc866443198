//! Layout of a recording: its topics, messages, notes and files, as its summary says, or all of its records.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Result;

use mcap::MAGIC;
use mcap::records::{Record, op};

use super::attachment::Attachment;
use super::{Topic, time_of};
use crate::json_channel;
use crate::mcap_records::{Found, HEAD, after_texts, records, u64_at, unpack};
use crate::mcap_walk::{read_at, walk};
use crate::recording_writer::{MESSAGE_ENCODING, SCHEMA_ENCODING};
use crate::{FieldTable, TableError};

/// Length of a footer and the closing magic, bytes.
const END_BYTES: u64 = (HEAD + 20 + MAGIC.len()) as u64;
/// Messages outside of chunks that are read at once, bytes.
const STRETCH_BYTES: u64 = 1 << 20;

/// Records that are read at once: a chunk, or messages outside of chunks that follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    pub(super) at: u64,
    pub(super) bytes: u64,
    /// Least and greatest time of its messages, ns.
    pub(super) times_ns: [u64; 2],
    pub(super) is_chunk: bool,
}

impl Stretch {
    fn end(&self) -> u64 {
        self.at.saturating_add(self.bytes)
    }

    /// Its place among others: by time, then as in the file.
    pub(super) fn order(&self) -> (u64, u64) {
        (self.times_ns[0], self.at)
    }
}

/// Layout of a recording.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// Chunks and messages, in order of time.
    pub(super) stretches: Vec<Stretch>,
    pub(super) topics: BTreeMap<u16, Topic>,
    /// Topics whose messages are not those of the bus.
    pub(super) foreign: BTreeMap<u16, ForeignChannel>,
    /// Notes about the recording, by name.
    pub(super) notes: BTreeMap<String, BTreeMap<String, String>>,
    /// Files that it holds, by name.
    pub(super) attachments: BTreeMap<String, Attachment>,
    /// Damage, if there is any.
    pub(super) damage: Option<String>,
}

/// A channel of another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ForeignChannel {
    pub(super) name: String,
    /// Name of its schema, where it has one.
    pub(super) schema: Option<String>,
    /// Encoding of its messages.
    pub(super) encoding: String,
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
            Some((bytes, start)) => Self::of_summary(&bytes, start, file, length)?,
            None => Self::of_records(file, length)?,
        };
        layout.stretches.sort_by_key(Stretch::order);
        Ok(layout)
    }

    /// By the index, and by the records that it leaves out: what is in no chunk has no place in an index.
    fn of_summary(bytes: &[u8], start: u64, file: &File, length: u64) -> Result<Self> {
        let (mut layout, mut channels) = (Self::default(), Channels::default());
        let mut indexed = Vec::new();
        for record in records(bytes, 0).filter(|record| record.whole) {
            match record.opcode {
                op::CHUNK_INDEX => indexed.extend(layout.add_chunk(record.body, length)),
                op::ATTACHMENT_INDEX => {
                    let entry = Attachment::of_index(record.body, length);
                    if entry.is_none() {
                        layout.damage = Some("its index is not that of the file".into());
                    }
                    indexed.extend(entry.as_ref().map(|(_, attachment)| attachment.record()));
                    layout.attachments.extend(entry);
                }
                op::METADATA_INDEX => {
                    let [at, bytes] = [0, 8].map(|place| u64_at(record.body, place).unwrap_or(0));
                    let note = read_at(file, length, at, bytes)?;
                    records(&note, 0)
                        .take(1)
                        .for_each(|note| layout.add_note(&note));
                    indexed.push([at, at.saturating_add(bytes)]);
                }
                _ => channels.add(&record),
            }
        }
        for [from, to] in gaps(indexed, [MAGIC.len() as u64, start]) {
            layout.add_records(file, [from, to], &mut channels)?;
        }
        layout.name(channels);
        Ok(layout)
    }

    /// The times that a chunk states are no others than 0 before it is ended, so they are those of its messages.
    fn of_records(file: &File, length: u64) -> Result<Self> {
        let (mut layout, mut channels) = (Self::default(), Channels::default());
        let is_ended = footer(file, length)?.is_some_and(|start| start == 0);
        layout.damage = (!is_ended).then(|| "it has no index, as after a crash".into());
        layout.add_records(file, [MAGIC.len() as u64, length], &mut channels)?;
        layout.name(channels);
        Ok(layout)
    }

    /// Takes in the records of a part of the file.
    fn add_records(
        &mut self,
        file: &File,
        [from, to]: [u64; 2],
        channels: &mut Channels,
    ) -> Result<()> {
        walk(file, to, from, &mut |record| {
            let (at, bytes) = (record.at as u64, (HEAD + record.body.len()) as u64);
            match record.opcode {
                op::CHUNK => {
                    let unpacked = unpack(record.body);
                    let mut times_ns = NO_TIMES;
                    for own in records(&unpacked.bytes, 0).filter(|own| own.whole) {
                        channels.add(&own);
                        times_ns = with(times_ns, &own);
                    }
                    if times_ns[0] <= times_ns[1] {
                        let chunk = Stretch {
                            at,
                            bytes,
                            times_ns,
                            is_chunk: true,
                        };
                        self.stretches.push(chunk);
                    }
                }
                _ if !record.whole => {
                    self.damage.get_or_insert("a record is damaged".into());
                }
                op::MESSAGE => self.add_message(at, bytes, record),
                op::ATTACHMENT => self.attachments.extend(Attachment::of(record, to)),
                op::METADATA => self.add_note(record),
                _ => channels.add(record),
            }
        })
    }

    /// Adds a message outside of chunks.
    fn add_message(&mut self, at: u64, bytes: u64, record: &Found<'_>) {
        match self.stretches.last_mut() {
            Some(last) if !last.is_chunk && last.end() == at && last.bytes < STRETCH_BYTES => {
                last.bytes += bytes;
                last.times_ns = with(last.times_ns, record);
            }
            _ => self.stretches.push(Stretch {
                at,
                bytes,
                times_ns: with(NO_TIMES, record),
                is_chunk: false,
            }),
        }
    }

    /// Takes in an entry of the index; returns where the chunk and the index of its messages are.
    fn add_chunk(&mut self, entry: &[u8], length: u64) -> Option<[u64; 2]> {
        let [first, last, at, bytes] =
            [0, 8, 16, 24].map(|place| u64_at(entry, place).unwrap_or(0));
        let end = at.checked_add(bytes).filter(|end| *end <= length);
        let (Some(end), true) = (end, first <= last) else {
            self.damage = Some("its index is not that of the file".into());
            return None;
        };
        self.stretches.push(Stretch {
            at,
            bytes,
            times_ns: [first, last],
            is_chunk: true,
        });
        let own_index = after_texts(entry, 32, 1).and_then(|place| u64_at(entry, place));
        Some([at, end.saturating_add(own_index.unwrap_or(0))])
    }

    /// Names the topics, once all channels are known.
    fn name(&mut self, channels: Channels) {
        (self.topics, self.foreign) = channels.topics();
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
                if let Ok(Record::Channel(channel)) = mcap::parse_record(op::CHANNEL, record.body) {
                    self.channels.entry(channel.id).or_insert(channel);
                }
            }
            _ => {}
        }
    }

    /// The topics of the bus, and those of other programs. What a recording has as JSON beside the messages as they were sent
    /// is neither.
    fn topics(self) -> (BTreeMap<u16, Topic>, BTreeMap<u16, ForeignChannel>) {
        let Self { schemas, channels } = self;
        let (own, others): (BTreeMap<_, _>, BTreeMap<_, _>) = channels
            .into_iter()
            .partition(|(_, channel)| channel.message_encoding == MESSAGE_ENCODING);
        let known: BTreeSet<&str> = own.values().map(|own| own.topic.as_str()).collect();
        let is_copy = |other: &mcap::records::Channel| {
            other.message_encoding == json_channel::MESSAGE_ENCODING
                && known.contains(other.topic.as_str())
        };
        let foreign = others.iter().filter(|(_, other)| !is_copy(other));
        let foreign = foreign.map(|(id, channel)| {
            let schema = schemas.get(&channel.schema_id);
            let channel = ForeignChannel {
                name: channel.topic.clone(),
                schema: schema.map(|(name, _)| name.clone()),
                encoding: channel.message_encoding.clone(),
            };
            (*id, channel)
        });
        let foreign = foreign.collect();
        let topic = |(id, channel): (u16, mcap::records::Channel)| {
            let schema = schemas.get(&channel.schema_id).cloned();
            let unknown = || TableError::Type(format!("number {}", channel.schema_id));
            let topic = Topic {
                name: channel.topic,
                message: schema.as_ref().map(|(name, _)| name.clone()),
                table: schema.map_or_else(|| Err(unknown()), |(_, table)| table),
            };
            (id, topic)
        };
        (own.into_iter().map(topic).collect(), foreign)
    }
}

/// Times of no message.
const NO_TIMES: [u64; 2] = [u64::MAX, 0];

/// Times with that of a record, if it is a message.
fn with([first, last]: [u64; 2], record: &Found<'_>) -> [u64; 2] {
    match time_of(record) {
        Some(at_ns) => [first.min(at_ns), last.max(at_ns)],
        None => [first, last],
    }
}

/// Rest of a range of bytes beside the parts of it that are known.
fn gaps(mut known: Vec<[u64; 2]>, [from, to]: [u64; 2]) -> Vec<[u64; 2]> {
    known.sort_unstable();
    known.push([to, to]);
    let (mut gaps, mut at) = (Vec::new(), from);
    for [begin, end] in known {
        if at < begin.min(to) {
            gaps.push([at, begin.min(to)]);
        }
        at = at.max(end);
    }
    gaps
}

/// Where the footer says that the summary begins, 0 without one; none where there is no footer.
fn footer(file: &File, length: u64) -> Result<Option<u64>> {
    let Some(end) = length.checked_sub(END_BYTES) else {
        return Ok(None);
    };
    let footer = read_at(file, length, end, END_BYTES)?;
    let is_whole = footer[0] == op::FOOTER && footer.ends_with(MAGIC);
    Ok(u64_at(&footer, HEAD).filter(|_| is_whole))
}

/// The summary with its place, if the file has one.
fn summary(file: &File, length: u64) -> Result<Option<(Vec<u8>, u64)>> {
    let end = length.saturating_sub(END_BYTES);
    let begins = MAGIC.len() as u64..end;
    let Some(start) = footer(file, length)?.filter(|start| begins.contains(start)) else {
        return Ok(None);
    };
    // The checksum is of all up to itself, behind the footer's two numbers.
    let mut summary = read_at(file, length, start, end - start + HEAD as u64 + 16)?;
    let crc = read_at(file, length, end + HEAD as u64 + 16, 4)?;
    let crc = crc.first_chunk().copied().map_or(0, u32::from_le_bytes);
    let is_sound = crc == 0 || crc32fast::hash(&summary) == crc;
    summary.truncate((end - start) as usize);
    Ok(is_sound.then_some((summary, start)))
}
