//! Content of a take, intact or damaged.
//!
//! Damage is reported, and skipped: reading continues with the next intact record. Checksums cover the chunks and all
//! before the summary, so a take without damage is the one that was written. In a chunk whose checksum is wrong a
//! sample counts if its message is valid by itself. Samples may stand in any order: their numbers tell in which they were
//! sent.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use maulstick_rig::UserError;
use maulstick_types::decode;
use maulstick_types::stylus::StylusSample;
use mcap::MAGIC;
use mcap::records::{MessageHeader, Record, op};

use maulstick_streams::json_channel;
use maulstick_streams::mcap_records::{Found, HEAD, records, unpack};

use crate::take::{Take, TakeSample};
use crate::take_setup::TakeSetup;

/// Name of a device whose channel record is lost.
const UNNAMED: &str = "recovered";

/// Content of a take that could be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Salvage {
    /// The samples that can be read.
    pub take: Take,
    /// The damage, if any.
    pub damage: Option<Damage>,
}

/// Damage of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// The first, with its place.
    pub first: String,
    /// Number of other places.
    pub more: usize,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.first)?;
        match self.more {
            0 => Ok(()),
            1 => f.write_str(", and in another place"),
            more => write!(f, ", and in {more} other places"),
        }
    }
}

/// Reads as much of a take as can be read.
///
/// # Errors
/// A [`UserError`] where the file cannot be read, is no MCAP file, or holds no sample.
pub fn salvage(path: &Path) -> Result<Salvage, UserError> {
    let bytes = std::fs::read(path).map_err(|error| UserError::reading(path, &error))?;
    from_bytes(&bytes).map_err(|refusal| {
        let (what, help) = match refusal {
            Refusal::Foreign => (
                "this is not an MCAP file".into(),
                "`maulstick take import` makes takes from tables of strokes",
            ),
            Refusal::Damaged(damage) => (
                format!("the take is damaged and no sample of it is left: {damage}"),
                "nothing of it can be recovered",
            ),
            Refusal::Empty => (
                "the file holds no stylus samples".into(),
                "a take has a topic stylus/<device>/sample",
            ),
            Refusal::Several(one, two) => (
                format!("the take holds samples of '{one}' and '{two}'"),
                "play takes of one stylus",
            ),
        };
        UserError::usage(what)
            .at(path.display().to_string())
            .help(help)
    })
}

impl Take {
    /// Reads a take.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be read, is damaged, or holds no samples of one stylus.
    pub fn read(path: &Path) -> Result<Self, UserError> {
        let salvage = salvage(path)?;
        match salvage.damage {
            None => Ok(salvage.take),
            Some(damage) => {
                let (count, name) = (salvage.take.samples.len(), path.display());
                Err(UserError::usage(format!("the take is damaged: {damage}"))
                    .at(name.to_string())
                    .help(format!(
                        "{count} samples can be read: `maulstick take recover {name} -o whole.mcap` keeps them, \
                         and `maulstick take embed` embeds again what they are painted with"
                    )))
            }
        }
    }
}

/// The reason why a file gives nothing.
#[derive(Debug, PartialEq)]
pub(crate) enum Refusal {
    Foreign,
    Damaged(Damage),
    Empty,
    Several(String, String),
}

/// As [`salvage`], from the bytes of the file.
pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Salvage, Refusal> {
    let begun = bytes.starts_with(MAGIC);
    let found: Vec<Found<'_>> = records(bytes, if begun { MAGIC.len() } else { 0 }).collect();
    if !begun && !found.iter().any(|record| record.whole) {
        return Err(Refusal::Foreign);
    }
    let mut reading = Reading::default();
    if !begun {
        reading.damaged(0, "the file does not begin as an MCAP file does");
    }
    let setup = TakeSetup::read(&found).unwrap_or_else(|damage| {
        reading.damaged(0, &damage.to_string());
        None
    });
    // The summary repeats the channels, and a damaged first chunk may have lost them.
    for record in found.iter().filter(|record| record.opcode == op::CHANNEL) {
        reading.channel(record, false);
    }
    for record in &found {
        reading.record(record, bytes);
    }
    let ended = found.last().is_some_and(|last| {
        let end = last.at + HEAD + last.body.len();
        last.whole && last.opcode == op::FOOTER && bytes[end..].starts_with(MAGIC)
    });
    if !ended {
        reading.damaged(bytes.len(), "the file ends before its closing record");
    }
    reading.finish(setup)
}

/// A sample with the epoch and the number of its message.
pub(crate) struct Numbered {
    pub(crate) epoch: u32,
    pub(crate) number: u64,
    pub(crate) sample: TakeSample,
}

/// Samples in the order in which they were sent. One that came late has the time of the next at the latest.
pub(crate) fn in_order(mut found: Vec<Numbered>) -> Vec<TakeSample> {
    let mut begins = BTreeMap::<u32, u64>::new();
    for own in &found {
        let begin = begins.entry(own.epoch).or_insert(u64::MAX);
        *begin = own.sample.time_ns.min(*begin);
    }
    found.sort_by_key(|own| {
        let begin = begins.get(&own.epoch);
        (begin.copied(), own.epoch, own.number, own.sample.time_ns)
    });
    let mut next_ns = u64::MAX;
    for own in found.iter_mut().rev() {
        next_ns = next_ns.min(own.sample.time_ns);
        own.sample.time_ns = next_ns;
    }
    found.into_iter().map(|own| own.sample).collect()
}

/// Content read so far.
#[derive(Default)]
struct Reading {
    /// Topics by the numbers of their channels.
    topics: BTreeMap<u16, String>,
    devices: Vec<(String, Vec<Numbered>)>,
    last_ns: u64,
    damage: Option<Damage>,
}

impl Reading {
    fn damaged(&mut self, at: usize, what: &str) {
        match &mut self.damage {
            Some(damage) => damage.more += 1,
            none => {
                let first = format!("{what} (byte {at})");
                *none = Some(Damage { first, more: 0 });
            }
        }
    }

    fn channel(&mut self, record: &Found<'_>, certain: bool) {
        if record.whole
            && let Ok(Record::Channel(channel)) = mcap::parse_record(op::CHANNEL, record.body)
            && (certain || !self.topics.contains_key(&channel.id))
        {
            // A recording has topics as JSON too, for viewers.
            let is_json = channel.message_encoding == json_channel::MESSAGE_ENCODING;
            let topic = Some(channel.topic).filter(|_| !is_json);
            self.topics.insert(channel.id, topic.unwrap_or_default());
        }
    }

    /// Takes in a record of the file.
    fn record(&mut self, record: &Found<'_>, bytes: &[u8]) {
        if !record.whole {
            self.damaged(record.at, "a record is damaged");
        }
        match record.opcode {
            op::CHUNK => {
                let unpacked = unpack(record.body);
                let certain = unpacked.damage.is_none();
                if let Some(damage) = unpacked.damage {
                    self.damaged(record.at, &damage);
                }
                for inner in records(&unpacked.bytes, 0) {
                    if !inner.whole && certain {
                        self.damaged(record.at, "a record of a chunk is damaged");
                    }
                    self.content(&inner, record.at, certain);
                }
            }
            op::DATA_END => {
                let saved = record
                    .body
                    .first_chunk()
                    .copied()
                    .map_or(0, u32::from_le_bytes);
                if saved != 0 && saved != crc32fast::hash(&bytes[..record.at]) {
                    self.damaged(
                        record.at,
                        "the checksum of the data is not that of the file",
                    );
                }
            }
            _ => self.content(record, record.at, true),
        }
    }

    /// Takes in a channel or a message; `certain` if a checksum says that it is what was written.
    fn content(&mut self, record: &Found<'_>, at: usize, certain: bool) {
        match record.opcode {
            op::CHANNEL => self.channel(record, certain),
            op::MESSAGE if record.whole => {
                if let Ok(Record::Message { header, data }) =
                    mcap::parse_record(op::MESSAGE, record.body)
                {
                    self.message(&header, &data, at, certain);
                }
            }
            _ => {}
        }
    }

    fn message(&mut self, header: &MessageHeader, data: &[u8], at: usize, certain: bool) {
        let topic = self.topics.get(&header.channel_id);
        let number = header.sequence;
        let device = match topic.map(|topic| device_of(topic)) {
            Some(None) => return,
            Some(Some(device)) => device,
            None if self.topics.is_empty() => UNNAMED,
            None => return self.damaged(at, &format!("message {number} is of no channel")),
        };
        let (bus, sample) = match decode::<StylusSample>(data) {
            Ok(decoded) => decoded,
            Err(error) => return self.damaged(at, &format!("message {number}: {error}")),
        };
        let wrong = if !certain && header.log_time < self.last_ns {
            Some("time runs backward")
        } else if !certain && header.log_time != bus.event_ns {
            Some("it has two times")
        } else {
            sample.fault()
        };
        if let Some(what) = wrong {
            return self.damaged(at, &format!("message {number}: {what}"));
        }
        self.last_ns = self.last_ns.max(header.log_time);
        let sample = Numbered {
            epoch: bus.epoch,
            number: bus.seq,
            sample: TakeSample {
                time_ns: header.log_time,
                sample,
            },
        };
        match self.devices.iter_mut().find(|(name, _)| name == device) {
            Some((_, samples)) => samples.push(sample),
            None => self.devices.push((device.to_owned(), vec![sample])),
        }
    }

    fn finish(self, setup: Option<TakeSetup>) -> Result<Salvage, Refusal> {
        let damage = self.damage;
        let mut devices = self.devices.into_iter();
        match (devices.next(), devices.next()) {
            (Some((device, samples)), None) => Ok(Salvage {
                take: Take {
                    device,
                    samples: in_order(samples),
                    setup,
                },
                damage,
            }),
            (None, _) => Err(damage.map_or(Refusal::Empty, Refusal::Damaged)),
            (Some((one, _)), Some((two, _))) => Err(Refusal::Several(one, two)),
        }
    }
}

/// `pen` of `stylus/pen/sample`, with or without a rig's prefix.
fn device_of(topic: &str) -> Option<&str> {
    let mut parts = topic.rsplit('/');
    match (parts.next(), parts.next(), parts.next()) {
        (Some("sample"), Some(device), Some("stylus")) => Some(device),
        _ => None,
    }
}
