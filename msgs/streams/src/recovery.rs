//! Recovery: the intact part of a damaged recording, as a whole one.
//!
//! Messages, files and notes are copied as they are, with the schemas that they have, whichever version wrote them. In a
//! chunk whose checksum is wrong a message counts if it is valid by itself.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{Seek, Write};
use std::path::Path;

use maulstick_rig::UserError;
use maulstick_types::wire::header::Header;
use mcap::records::{Metadata, Record, op};
use mcap::{MAGIC, McapResult, Writer};

use crate::json_channel;
use crate::mcap_records::{Found, HEAD, records, unpack};
use crate::mcap_walk::{read_at, walk};
use crate::recording::Attachment;
use crate::recording_writer::{MESSAGE_ENCODING, options};

/// Name of the note that a recovered recording has.
const NOTE: &str = "recovered";

/// A recording that may be damaged.
#[derive(Debug)]
pub struct DamagedRecording {
    file: File,
    length: u64,
    /// Where its first record begins.
    from: u64,
    /// Name, encoding and data of each schema.
    schemas: BTreeMap<u16, (String, String, Vec<u8>)>,
    channels: BTreeMap<u16, mcap::records::Channel>,
    notes: BTreeSet<String>,
    damage: Damage,
}

/// Counts of a recovery.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recovered {
    /// Messages.
    pub messages: u64,
    /// Attached files.
    pub files: u64,
    /// The damage, if any.
    pub damage: Option<String>,
}

/// The first damage, and how many more places there are.
#[derive(Clone, Debug, Default)]
struct Damage(Option<(String, usize)>);

impl Damage {
    fn add(&mut self, at: u64, what: &str) {
        match &mut self.0 {
            Some((_, more)) => *more += 1,
            none => *none = Some((format!("{what} (byte {at})"), 0)),
        }
    }

    fn in_words(self) -> Option<String> {
        self.0.map(|(first, more)| match more {
            0 => first,
            1 => format!("{first}, and in another place"),
            more => format!("{first}, and in {more} other places"),
        })
    }
}

impl DamagedRecording {
    /// Looks through a file.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, or holds no record of MCAP.
    pub fn open(path: &Path) -> Result<Self, UserError> {
        let reading = |error: std::io::Error| UserError::reading(path, &error);
        let file = File::open(path).map_err(reading)?;
        let length = file.metadata().map_err(reading)?.len();
        let magic = read_at(&file, length, 0, MAGIC.len() as u64).map_err(reading)?;
        let begins = magic == MAGIC;
        let mut recording = Self {
            length,
            from: if begins { MAGIC.len() as u64 } else { 0 },
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            notes: BTreeSet::new(),
            damage: Damage::default(),
            file,
        };
        if !begins {
            recording
                .damage
                .add(0, "the file does not begin as an MCAP file does");
        }
        let is_mcap = recording.look().map_err(reading)? || begins;
        if is_mcap {
            Ok(recording)
        } else {
            Err(UserError::usage("this is not an MCAP file")
                .at(path.display().to_string())
                .help("`maulstick recording record` writes recordings"))
        }
    }

    /// Finds schemas, channels and damage; true if there is a whole record.
    fn look(&mut self) -> std::io::Result<bool> {
        let Self {
            file,
            length,
            from,
            schemas,
            channels,
            notes,
            damage,
        } = self;
        let (mut any, mut end) = (false, None);
        let mut define = |found: &Found<'_>| match mcap::parse_record(found.opcode, found.body) {
            Ok(Record::Schema { header, data }) => {
                let schema = (header.name, header.encoding, data.into_owned());
                schemas.entry(header.id).or_insert(schema);
            }
            Ok(Record::Channel(channel)) => {
                channels.entry(channel.id).or_insert(channel);
            }
            Ok(Record::Metadata(note)) => drop(notes.insert(note.name)),
            _ => {}
        };
        walk(file, *length, *from, &mut |record| {
            let at = record.at as u64;
            any |= record.whole;
            end = Some((record.opcode, at + (HEAD + record.body.len()) as u64));
            match record.opcode {
                op::CHUNK => {
                    let unpacked = unpack(record.body);
                    match unpacked.damage {
                        Some(what) => damage.add(at, &what),
                        None if !record.whole => damage.add(at, "a chunk is damaged"),
                        None => {}
                    }
                    let whole = records(&unpacked.bytes, 0).filter(|own| own.whole);
                    whole.filter(defines).for_each(|own| define(&own));
                }
                _ if !record.whole => damage.add(at, "a record is damaged"),
                _ if defines(record) => define(record),
                _ => {}
            }
        })?;
        let ends_with =
            |at: u64| Ok::<bool, std::io::Error>(read_at(file, *length, at, 8)? == MAGIC);
        let is_ended = match end {
            Some((op::FOOTER, at)) => ends_with(at)?,
            _ => false,
        };
        if !is_ended {
            damage.add(*length, "the file ends before its closing record");
        }
        Ok(any)
    }

    /// Topics of the messages of the bus.
    pub fn topics(&self) -> impl Iterator<Item = &str> {
        let own = |channel: &&mcap::records::Channel| {
            channel.message_encoding != json_channel::MESSAGE_ENCODING
        };
        let channels = self.channels.values().filter(own);
        channels.map(|channel| channel.topic.as_str())
    }

    /// True if it says of itself that a recorder wrote it, or is a recording that was recovered.
    #[must_use]
    pub fn is_of_a_recorder(&self) -> bool {
        ["recording", NOTE]
            .iter()
            .any(|name| self.notes.contains(*name))
    }

    /// Writes all that can be read, and says what was wrong.
    ///
    /// # Errors
    /// The error of the files.
    pub fn recover(self, to: impl Write + Seek) -> McapResult<Recovered> {
        let mut copy = Copy {
            writer: options().create(to)?,
            recording: &self,
            numbers: BTreeMap::new(),
            damage: self.damage.clone(),
            recovered: Recovered::default(),
            fault: None,
        };
        walk(&self.file, self.length, self.from, &mut |record| {
            if copy.fault.is_none() {
                copy.fault = copy.record(record).err();
            }
        })?;
        if let Some(fault) = copy.fault {
            return Err(fault);
        }
        let Copy {
            mut writer,
            damage,
            recovered,
            ..
        } = copy;
        let damage = damage.in_words();
        if let Some(damage) = &damage {
            writer.write_metadata(&Metadata {
                name: NOTE.to_owned(),
                metadata: BTreeMap::from([("damage".to_owned(), damage.clone())]),
            })?;
        }
        writer.finish()?;
        Ok(Recovered {
            damage,
            ..recovered
        })
    }
}

/// True for records that give others a meaning.
fn defines(record: &Found<'_>) -> bool {
    record.whole && [op::SCHEMA, op::CHANNEL, op::METADATA].contains(&record.opcode)
}

/// A whole recording that is being written.
struct Copy<'a, W: Write + Seek> {
    writer: Writer<W>,
    recording: &'a DamagedRecording,
    /// Numbers of the channels in the copy, by those in the file.
    numbers: BTreeMap<u16, u16>,
    damage: Damage,
    recovered: Recovered,
    fault: Option<mcap::McapError>,
}

impl<W: Write + Seek> Copy<'_, W> {
    fn record(&mut self, record: &Found<'_>) -> McapResult<()> {
        match record.opcode {
            op::CHUNK => {
                let unpacked = unpack(record.body);
                let certain = unpacked.damage.is_none() && record.whole;
                for own in records(&unpacked.bytes, 0).filter(|own| own.whole) {
                    self.message(&own, record.at, certain)?;
                }
                Ok(())
            }
            op::ATTACHMENT if record.whole => self.attachment(record),
            op::METADATA if record.whole => match mcap::parse_record(op::METADATA, record.body) {
                Ok(Record::Metadata(note)) if note.name != NOTE => {
                    self.writer.write_metadata(&note)
                }
                _ => Ok(()),
            },
            _ if record.whole => self.message(record, record.at, true),
            _ => Ok(()),
        }
    }

    /// Copies a message; `certain` if a checksum says that it is what was written.
    fn message(&mut self, record: &Found<'_>, at: usize, certain: bool) -> McapResult<()> {
        if record.opcode != op::MESSAGE {
            return Ok(());
        }
        let Ok(Record::Message { mut header, data }) = mcap::parse_record(op::MESSAGE, record.body)
        else {
            return Ok(());
        };
        let Some(channel) = self.recording.channels.get(&header.channel_id) else {
            self.damage.add(at as u64, "a message is of no channel");
            return Ok(());
        };
        let is_valid = match channel.message_encoding.as_str() {
            MESSAGE_ENCODING => Header::from_bytes(&data).is_ok(),
            json_channel::MESSAGE_ENCODING => {
                serde_json::from_slice::<serde_json::Value>(&data).is_ok()
            }
            _ => false,
        };
        if !certain && !is_valid {
            self.damage.add(at as u64, "a message is damaged");
            return Ok(());
        }
        header.channel_id = self.channel(channel)?;
        self.writer.write_to_known_channel(&header, &data)?;
        self.recovered.messages += 1;
        Ok(())
    }

    /// Number of a channel in the copy.
    fn channel(&mut self, channel: &mcap::records::Channel) -> McapResult<u16> {
        if let Some(number) = self.numbers.get(&channel.id) {
            return Ok(*number);
        }
        let schema = match self.recording.schemas.get(&channel.schema_id) {
            Some((name, encoding, data)) => self.writer.add_schema(name, encoding, data)?,
            None => 0,
        };
        let (topic, encoding) = (&channel.topic, &channel.message_encoding);
        let number = self
            .writer
            .add_channel(schema, topic, encoding, &channel.metadata)?;
        self.numbers.insert(channel.id, number);
        Ok(number)
    }

    fn attachment(&mut self, record: &Found<'_>) -> McapResult<()> {
        let DamagedRecording { file, length, .. } = self.recording;
        let Some((name, attachment)) = Attachment::of(record, *length) else {
            return Ok(());
        };
        let mut data = Vec::new();
        if let Err(error) = attachment.copy(file, &mut data) {
            let what = format!("the attached file {name}: {error}");
            self.damage.add(record.at as u64, &what);
            return Ok(());
        }
        self.recovered.files += 1;
        self.writer.attach(&mcap::Attachment {
            log_time: 0,
            create_time: 0,
            media_type: attachment.media_type,
            name,
            data: data.into(),
        })
    }
}
