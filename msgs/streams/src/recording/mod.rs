//! Reads a recording: by its index, or, where it has none as after a crash, by all of its records. Messages in chunks and
//! outside of them are read alike, in order of time wherever they stand. JSON channels, which are for viewers, are left
//! alone, and attached files stay on the disk until they are asked for.
//!
//! No length that the file states is believed before it is compared with the file.

mod attachment;
mod in_order;
mod layout;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use maulstick_rig::UserError;
use maulstick_types::wire::header::{HEADER_BYTES, Header};
use mcap::MAGIC;
use mcap::records::{Record, op};

pub use self::attachment::Attachment;
use self::in_order::InOrder;
use self::layout::{Layout, Stretch};
use crate::Value;
use crate::mcap_records::{Found, HEAD, records, u64_at, unpack};
use crate::mcap_walk::read_at;
use crate::{FieldTable, TableError};

/// Largest chunk that is read, bytes; those of a recorder have a quarter of a megabyte before they are compressed.
const MOST_CHUNK: u64 = 256 << 20;

/// A recording on the disk.
#[derive(Clone, Debug)]
pub struct Recording {
    path: PathBuf,
    file: Arc<File>,
    length: u64,
    layout: Layout,
}

/// A topic.
#[derive(Clone, Debug)]
pub struct Topic {
    /// Its name, without a rig's prefix.
    pub name: String,
    /// Name and version of its messages, where they are known.
    pub message: Option<String>,
    /// Field table of its messages, or the reason why they cannot be decoded.
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

/// A topic of another program, whose messages are not those of the bus.
#[derive(Clone, Debug, PartialEq)]
pub struct ForeignTopic {
    /// Its name.
    pub name: String,
    /// Name of the schema of its messages, where it has one.
    pub schema: Option<String>,
    /// Encoding of its messages, such as `json` or `cdr`.
    pub encoding: String,
    /// Number of its messages.
    pub messages: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Messages a second; 0 of fewer than two.
    pub rate_hz: f64,
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

    /// Decodes a message.
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
        let file = File::open(path).map_err(reading)?;
        let length = file.metadata().map_err(reading)?.len();
        if read_at(&file, length, 0, MAGIC.len() as u64).map_err(reading)? != MAGIC {
            return Err(UserError::usage("this is not an MCAP file")
                .at(path.display().to_string())
                .help("`maulstick recording record` writes recordings"));
        }
        Ok(Self {
            path: path.to_owned(),
            layout: Layout::read(&file, length).map_err(reading)?,
            file: Arc::new(file),
            length,
        })
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Notes about the recording, by name.
    #[must_use]
    pub fn notes(&self) -> &BTreeMap<String, BTreeMap<String, String>> {
        &self.layout.notes
    }

    /// Files that it holds, by name.
    #[must_use]
    pub fn attachments(&self) -> &BTreeMap<String, Attachment> {
        &self.layout.attachments
    }

    /// Writes one of its files to `to`.
    ///
    /// # Errors
    /// The error of the file system; [`ErrorKind::InvalidData`] where the file is damaged, [`ErrorKind::NotFound`] where
    /// there is none of this name.
    pub fn copy_attachment(&self, name: &str, to: &mut dyn Write) -> std::io::Result<()> {
        match self.layout.attachments.get(name) {
            Some(attachment) => attachment.copy(&self.file, to),
            None => Err(ErrorKind::NotFound.into()),
        }
    }

    /// One of its files; `None` if there is none of this name.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, or is damaged.
    pub fn attachment(&self, name: &str) -> Result<Option<Vec<u8>>, UserError> {
        let mut bytes = Vec::new();
        match self.copy_attachment(name, &mut bytes) {
            Ok(()) => Ok(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(UserError::reading(&self.path, &error)),
        }
    }

    /// Damage, if any is known.
    #[must_use]
    pub fn damage(&self) -> Option<&str> {
        self.layout.damage.as_deref()
    }

    /// Its topics, by the numbers of their channels.
    #[must_use]
    pub fn topics(&self) -> &BTreeMap<u16, Topic> {
        &self.layout.topics
    }

    /// Times of its first and last message, rig clock, ns; `None` if it has none.
    #[must_use]
    pub fn times_ns(&self) -> Option<[u64; 2]> {
        let times = self.layout.stretches.iter().map(|own| own.times_ns);
        times.reduce(|[first, last], [from, to]| [first.min(from), last.max(to)])
    }

    /// Has `each` see the messages that arrived in a range of times, in order of time, until it says false. Those of one time
    /// come in the order of the file.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be read. What is damaged is left out, and noted in [`Self::damage`].
    pub fn messages(
        &mut self,
        [from_ns, to_ns]: [u64; 2],
        each: &mut dyn FnMut(RecordedMessage) -> bool,
    ) -> Result<(), UserError> {
        let mut in_order = InOrder::default();
        for number in 0..self.layout.stretches.len() {
            let stretch = self.layout.stretches[number];
            let [first, last] = stretch.times_ns;
            if last < from_ns || first > to_ns {
                continue;
            }
            if !in_order.take_before(stretch.order(), each) {
                return Ok(());
            }
            self.records_of(&stretch, &mut |record| {
                if let Some(message) = message(record)
                    && (from_ns..=to_ns).contains(&message.arrived_ns)
                {
                    in_order.add(stretch.at, message);
                }
            })?;
        }
        in_order.take_rest(each);
        Ok(())
    }

    /// Topics of other programs, with what is in the file of each.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be read.
    pub fn foreign(&mut self) -> Result<Vec<ForeignTopic>, UserError> {
        let mut counts = BTreeMap::<u16, (u64, u64, [u64; 2])>::new();
        let channels = self.layout.foreign.clone();
        let stretches = if channels.is_empty() {
            Vec::new()
        } else {
            self.layout.stretches.clone()
        };
        for stretch in &stretches {
            self.records_of(stretch, &mut |record| {
                let Some((channel, at_ns)) = channel_of(record).zip(time_of(record)) else {
                    return;
                };
                let (messages, bytes, times) =
                    counts.entry(channel).or_insert((0, 0, [u64::MAX, 0]));
                *messages += 1;
                *bytes += record.body.len().saturating_sub(MESSAGE_HEAD) as u64;
                *times = [times[0].min(at_ns), times[1].max(at_ns)];
            })?;
        }
        let topic = |(id, channel): (u16, layout::ForeignChannel)| {
            let (messages, bytes, [first, last]) = counts.get(&id).copied().unwrap_or_default();
            let passed_s = last.saturating_sub(first) as f64 * 1e-9;
            ForeignTopic {
                name: channel.name,
                schema: channel.schema,
                encoding: channel.encoding,
                messages,
                bytes,
                rate_hz: if messages >= 2 && passed_s > 0.0 {
                    (messages - 1) as f64 / passed_s
                } else {
                    0.0
                },
            }
        };
        Ok(channels.into_iter().map(topic).collect())
    }

    /// Has `each` see the records of a stretch, those of a chunk unpacked.
    fn records_of(
        &mut self,
        stretch: &Stretch,
        each: &mut dyn FnMut(&Found<'_>),
    ) -> Result<(), UserError> {
        let damage = &mut self.layout.damage;
        if stretch.bytes > MOST_CHUNK {
            damage.get_or_insert("a chunk is too large to be read".into());
            return Ok(());
        }
        let bytes = read_at(&self.file, self.length, stretch.at, stretch.bytes);
        let bytes = bytes.map_err(|error| UserError::reading(&self.path, &error))?;
        if !stretch.is_chunk {
            records(&bytes, 0).for_each(|record| each(&record));
            return Ok(());
        }
        let unpacked = unpack(bytes.get(HEAD..).unwrap_or_default());
        if let Some(found) = unpacked.damage {
            damage.get_or_insert(found);
        }
        records(&unpacked.bytes, 0).for_each(|record| each(&record));
        Ok(())
    }
}

/// Channel, number and two times before the data of a message, bytes.
const MESSAGE_HEAD: usize = 22;

/// The channel of a message.
fn channel_of(record: &Found<'_>) -> Option<u16> {
    let is_message = record.opcode == op::MESSAGE && record.whole;
    let channel = record.body.first_chunk().filter(|_| is_message)?;
    Some(u16::from_le_bytes(*channel))
}

/// When a message arrived, ns.
fn time_of(record: &Found<'_>) -> Option<u64> {
    let is_message = record.opcode == op::MESSAGE && record.whole;
    u64_at(record.body, 6).filter(|_| is_message)
}

/// The message of a record, if it is one of the bus.
fn message(record: &Found<'_>) -> Option<RecordedMessage> {
    if record.opcode != op::MESSAGE || !record.whole {
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
