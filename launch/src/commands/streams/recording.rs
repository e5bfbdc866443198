//! `maulstick recording`: recordings made and replayed; what one holds, and its messages for other programs.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_streams::recording::{ForeignTopic, RecordedMessage, Topic};
use maulstick_streams::recording_writer::MESSAGE_ENCODING;
use maulstick_streams::topic_pattern::matches;
use maulstick_streams::traffic::Arrived;
use maulstick_streams::{Recording, Traffic, Value};
use maulstick_types::plain;
use serde_json::json;

use super::foxglove_export;
use super::message_lines::{MessageLine, head};
use super::record::{self, RecordOptions};
use crate::commands::replay::{self, ReplayOptions};
use crate::commands::table::table;
use crate::commands::{print_json, print_text, say};
use crate::outputs::{UsedFile, check_outputs};

/// Subcommands of `maulstick recording`.
#[derive(Subcommand, Clone, Debug)]
pub enum RecordingCommand {
    /// Record what a rig sends
    Record(RecordOptions),
    /// Play a recording into a running rig
    Replay(ReplayOptions),
    /// Show what a recording holds
    Info {
        /// Recording
        recording: PathBuf,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Write messages as a table, as JSON, or for Foxglove
    Export(ExportOptions),
}

impl RecordingCommand {
    /// True for one that ends its own work at a signal.
    #[must_use]
    pub fn handles_signals(&self) -> bool {
        matches!(self, Self::Record(_) | Self::Replay(_))
    }
}

/// Options of `maulstick recording export`.
#[derive(Args, Clone, Debug)]
pub struct ExportOptions {
    /// Recording
    recording: PathBuf,
    /// Topics, such as stylus/*/sample: * stands for one part, ** for any number
    #[arg(long, value_name = "TOPIC", default_value = "**")]
    topic: String,
    /// Form of the file
    #[arg(long, value_enum, default_value_t = Form::Csv)]
    format: Form,
    /// File to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Only this field, such as pose.Contact.pressure; may be given several times
    #[arg(long, value_name = "PATH")]
    field: Vec<String>,
    /// From so many seconds after its beginning
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    start: f64,
    /// To so many seconds after its beginning
    #[arg(long, value_name = "S")]
    end: Option<f64>,
}

/// Forms of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Comma-separated values, a row for each message
    Csv,
    /// A line of JSON for each message
    Json,
    /// An MCAP file of JSON channels with their schemas
    Foxglove,
}

/// Runs the subcommand.
///
/// # Errors
/// A [`UserError`] for a file that cannot be read or written, a topic that it does not hold.
pub fn run(command: &RecordingCommand) -> Result<i32, UserError> {
    match command {
        RecordingCommand::Record(options) => record::run(options),
        RecordingCommand::Replay(options) => replay::run(options),
        RecordingCommand::Info { recording, json } => info(recording, *json),
        RecordingCommand::Export(options) => export(options),
    }
}

/// The whole of a recording.
const WHOLE: [u64; 2] = [0, u64::MAX];

fn info(path: &std::path::Path, as_json: bool) -> Result<i32, UserError> {
    let mut recording = Recording::open(path)?;
    let facts = recording.notes().get("recording").cloned();
    let fact = |name: &str| facts.as_ref().and_then(|facts| facts.get(name));
    let begun_ns = fact("rig_ns").and_then(|ns| ns.parse::<u64>().ok());
    let mut traffic = Traffic::since(begun_ns.unwrap_or(0));
    let topics = recording.topics().clone();
    recording.messages(WHOLE, &mut |message| {
        if let Some(topic) = topics.get(&message.channel) {
            let arrived = Arrived {
                header: message.header,
                bytes: message.bytes.len(),
                arrived_ns: message.arrived_ns,
            };
            traffic.add(&topic.name, &arrived);
        }
        true
    })?;
    let foreign = recording.foreign()?;
    let [first, last] = recording.times_ns().unwrap_or_default();
    let seconds = last.saturating_sub(first) as f64 * 1e-9;
    let known: BTreeMap<&str, &str> = topics
        .values()
        .map(|topic| {
            (
                topic.name.as_str(),
                topic.message.as_deref().unwrap_or("unknown"),
            )
        })
        .collect();
    let message = |topic: &str| known.get(topic).copied().unwrap_or("unknown");
    if as_json {
        let streams = streams(&traffic, message);
        print_json(&json!({
            "seconds": seconds,
            "notes": recording.notes(),
            "files": recording.attachments().keys().collect::<Vec<_>>(),
            "damage": recording.damage(),
            "streams": streams,
            "foreign": foreign.iter().map(foreign_entry).collect::<Vec<_>>(),
        }))?;
        return Ok(0);
    }
    match fact("rig").zip(fact("version")) {
        Some((rig, version)) => say!("{seconds:.1} s of {rig}, by maulstick {version}"),
        None => say!("{seconds:.1} s"),
    }
    if let Some(damage) = recording.damage() {
        say!("damaged: {damage}; what is shown can be read, and `maulstick take recover` mends it");
    }
    let rows: Vec<_> = rows(&traffic, message)
        .chain(foreign.iter().map(foreign_row))
        .collect();
    let head = [
        "topic", "message", "senders", "messages", "a second", "kB", "lost",
    ];
    print_text(&table(head, &rows))?;
    if rows.is_empty() {
        say!("it has no messages");
    } else if !foreign.is_empty() {
        say!(
            "topics of another program have their encoding in brackets: Maulstick lists them, and reads them not"
        );
    }
    Ok(0)
}

/// Streams of a recording as JSON; `message` names the messages of a topic.
fn streams<'a>(traffic: &Traffic, message: impl Fn(&str) -> &'a str) -> Vec<serde_json::Value> {
    let stream = traffic.streams().map(|(topic, origin, stream)| {
        json!({
            "topic": topic,
            "source": origin.source,
            "epoch": origin.epoch,
            "message": message(topic),
            "messages": stream.messages,
            "bytes": stream.bytes,
            "rate_hz": stream.rate_hz(),
            "lost": stream.lost,
        })
    });
    stream.collect()
}

/// Rows of the topics of a recording.
fn rows<'a>(
    traffic: &Traffic,
    message: impl Fn(&str) -> &'a str,
) -> impl Iterator<Item = [String; 7]> {
    totals(traffic).into_iter().map(move |(topic, total)| {
        [
            topic.to_owned(),
            message(topic).to_owned(),
            total.senders.to_string(),
            total.messages.to_string(),
            format!("{:.1}", total.rate_hz),
            format!("{:.1}", total.bytes as f64 * 1e-3),
            total.lost.to_string(),
        ]
    })
}

fn foreign_entry(topic: &ForeignTopic) -> serde_json::Value {
    json!({
        "topic": topic.name,
        "message": topic.schema,
        "encoding": topic.encoding,
        "messages": topic.messages,
        "bytes": topic.bytes,
        "rate_hz": topic.rate_hz,
    })
}

fn foreign_row(topic: &ForeignTopic) -> [String; 7] {
    let schema = topic.schema.as_deref().unwrap_or("unknown");
    [
        plain(&topic.name).into_owned(),
        plain(&format!("{schema} [{}]", topic.encoding)).into_owned(),
        "-".to_owned(),
        topic.messages.to_string(),
        format!("{:.1}", topic.rate_hz),
        format!("{:.1}", topic.bytes as f64 * 1e-3),
        "-".to_owned(),
    ]
}

/// A topic, whoever sent it: a process that was started again counts as another sender.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct TopicTotal {
    senders: u64,
    messages: u64,
    /// While each sent, in the mean.
    rate_hz: f64,
    bytes: u64,
    lost: u64,
}

/// Each topic once.
fn totals(traffic: &Traffic) -> BTreeMap<&str, TopicTotal> {
    let mut totals: BTreeMap<&str, TopicTotal> = BTreeMap::new();
    for (topic, _, stream) in traffic.streams() {
        let total = totals.entry(topic).or_default();
        let messages = total.messages + stream.messages;
        let rates =
            total.rate_hz * total.messages as f64 + stream.rate_hz() * stream.messages as f64;
        *total = TopicTotal {
            senders: total.senders + 1,
            messages,
            rate_hz: rates / messages.max(1) as f64,
            bytes: total.bytes + stream.bytes,
            lost: total.lost + stream.lost,
        };
    }
    totals
}

fn export(options: &ExportOptions) -> Result<i32, UserError> {
    let mut recording = Recording::open(&options.recording)?;
    let place = options.recording.display().to_string();
    let output = UsedFile::new("the export", &options.output).of(options.kind()?);
    check_outputs(
        &[output],
        &[UsedFile::new("the recording", &options.recording)],
    )?;
    let topics = options
        .topics(&mut recording)
        .map_err(|fault| fault.at(&place))?;
    let range = options
        .range(&recording)
        .map_err(|fault| fault.at(&place))?;
    if options.format == Form::Foxglove {
        let count = foxglove_export::write(&mut recording, &topics, range, &options.output)?;
        say!("{count} messages in {}", options.output.display());
        return Ok(0);
    }
    let is_known = |path: &&String| topics.values().any(|own| own.has(path));
    if let Some(path) = options.field.iter().find(|path| !is_known(path)) {
        let what = format!("the messages of {} have no field '{path}'", options.topic);
        let columns = columns(&mut recording, &topics, range)?;
        let names = columns.iter().map(String::as_str);
        return Err(UserError::unknown(what, path, names).at(place));
    }
    let columns = if options.field.is_empty() {
        columns(&mut recording, &topics, range)?
    } else {
        options.field.clone()
    };
    let mut lines = Lines {
        options,
        topics: &topics,
        text: match options.format {
            Form::Csv => head(&columns),
            Form::Json | Form::Foxglove => String::new(),
        },
        columns,
        messages: 0,
    };
    lines.write(&mut recording, range)?;
    let path = options.output.display();
    say!("{} messages in {path}", lines.messages);
    Ok(0)
}

impl ExportOptions {
    /// Kind of the file that is written.
    fn kind(&self) -> Result<Kind, UserError> {
        match self.format {
            Form::Csv | Form::Json => Ok(Kind::Messages),
            Form::Foxglove if self.field.is_empty() => Ok(Kind::Take),
            Form::Foxglove => Err(UserError::usage(
                "messages for Foxglove have all of their fields",
            )
            .help("leave out --field, or choose --format csv or json")),
        }
    }

    /// The topics that are exported. Among others, messages that nobody can read are passed by.
    fn topics(&self, recording: &mut Recording) -> Result<BTreeMap<u16, Topic>, UserError> {
        let chosen = recording.topics().iter();
        let chosen = chosen.filter(|(_, topic)| matches(&self.topic, &topic.name));
        let is_one = chosen.clone().count() == 1;
        let (topics, unread): (BTreeMap<u16, Topic>, _) = chosen
            .map(|(channel, topic)| (*channel, topic.clone()))
            .partition(|(_, topic)| is_one || topic.table.is_ok());
        for topic in unread.values() {
            say!(
                "without {}: nothing here tells how its messages are read",
                topic.name
            );
        }
        if topics.is_empty() {
            return Err(self.no_topic(recording)?);
        }
        Ok(topics)
    }

    /// The error where no topic is exported.
    fn no_topic(&self, recording: &mut Recording) -> Result<UserError, UserError> {
        let foreign = recording.foreign()?;
        let mut own = foreign.iter();
        if let Some(topic) = own.find(|own| matches(&self.topic, &own.name)) {
            let what = format!(
                "the messages of {} are those of another program, encoded as '{}'",
                topic.name, topic.encoding
            );
            let help = format!(
                "Maulstick exports what it has recorded, whose encoding is {MESSAGE_ENCODING}"
            );
            return Ok(UserError::usage(what).help(help));
        }
        let topics = recording.topics().values();
        let names: BTreeSet<&str> = topics.map(|topic| topic.name.as_str()).collect();
        let what = format!("the recording has no topic '{}'", self.topic);
        Ok(UserError::unknown(what, &self.topic, names))
    }

    /// First and last time that are exported, ns.
    fn range(&self, recording: &Recording) -> Result<[u64; 2], UserError> {
        let [first, last] = recording.times_ns().unwrap_or_default();
        let after = |seconds: f64| first.saturating_add((seconds * 1e9) as u64);
        let end = self.end.unwrap_or(f64::INFINITY);
        let range = [after(self.start), after(end)];
        let is_range = self.start >= 0.0 && end >= self.start;
        if is_range && range[0] <= last {
            return Ok(range);
        }
        let long = last.saturating_sub(first) as f64 * 1e-9;
        let what = format!("nothing was recorded from {} s to {end} s", self.start);
        Err(UserError::usage(what).help(format!("the recording is {long:.3} s long")))
    }
}

/// What a message holds.
///
/// # Errors
/// A [`UserError`] where it cannot be decoded.
pub(super) fn decoded(topic: &Topic, message: &RecordedMessage) -> Result<Value, UserError> {
    topic.decode(&message.bytes).map_err(|error| {
        let seq = message.header.seq;
        UserError::failure(format!("{}, message {seq}: {error}", topic.name))
            .help("a newer version of Maulstick may know it")
    })
}

/// Columns of the messages of topics: those of all alternatives and lists that are there, in the order in which they come.
fn columns(
    recording: &mut Recording,
    topics: &BTreeMap<u16, Topic>,
    range: [u64; 2],
) -> Result<Vec<String>, UserError> {
    let (mut known, mut columns) = (BTreeSet::new(), Vec::new());
    recording.messages(range, &mut |message| {
        let topic = topics.get(&message.channel);
        let value = topic.and_then(|topic| topic.decode(&message.bytes).ok());
        for column in value.iter().flat_map(Value::columns) {
            if known.insert(column.clone()) {
                columns.push(column);
            }
        }
        true
    })?;
    Ok(columns)
}

/// Lines of an export.
struct Lines<'a> {
    options: &'a ExportOptions,
    topics: &'a BTreeMap<u16, Topic>,
    columns: Vec<String>,
    text: String,
    messages: u64,
}

impl Lines<'_> {
    /// Writes the messages of a range of times.
    fn write(&mut self, recording: &mut Recording, range: [u64; 2]) -> Result<(), UserError> {
        let (path, mut wrong) = (&self.options.output, None);
        let place = self.options.recording.display().to_string();
        let written = write_whole(path, Kind::Messages, |file| {
            file.write_all(std::mem::take(&mut self.text).as_bytes())?;
            let mut done = Ok(());
            let read = recording.messages(range, &mut |message| {
                if let Err(fault) = self.add(&message) {
                    wrong = Some(fault.at(&place));
                    return false;
                }
                done = file.write_all(std::mem::take(&mut self.text).as_bytes());
                done.is_ok()
            });
            wrong = wrong.take().or(read.err());
            if wrong.is_some() {
                return Err(std::io::ErrorKind::InvalidData.into());
            }
            done
        });
        match wrong {
            Some(fault) => Err(fault),
            None => written.map_err(|error| UserError::writing(path, &error)),
        }
    }

    /// Adds a message of one of the topics.
    fn add(&mut self, message: &RecordedMessage) -> Result<(), UserError> {
        let Some(topic) = self.topics.get(&message.channel) else {
            return Ok(());
        };
        let value = decoded(topic, message)?;
        self.messages += 1;
        let line = MessageLine {
            topic: &topic.name,
            header: &message.header,
            arrived_ns: message.arrived_ns,
            value: &value,
        };
        self.text += &match self.options.format {
            Form::Csv => line.row(&self.columns),
            Form::Json | Form::Foxglove => line.json(&self.options.field),
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::{Flags, Header};

    use super::*;

    #[test]
    fn a_topic_is_listed_once_however_many_sent_it() {
        let mut traffic = Traffic::default();
        let mut send = |topic: &str, epoch: u32, seq: u64| {
            let sent_ns = u64::from(epoch) * 1_000_000_000 + seq * 10_000_000;
            let header = Header {
                version: 1,
                schema: 1,
                source: 7,
                epoch,
                flags: Flags::default(),
                length: 0,
                seq,
                event_ns: 0,
                sent_ns,
            };
            let arrived = Arrived {
                header,
                bytes: 100,
                arrived_ns: sent_ns,
            };
            traffic.add(topic, &arrived);
        };
        for epoch in 1..=3 {
            (0..10)
                .filter(|seq| *seq != 4)
                .for_each(|seq| send("a", epoch, seq));
        }
        send("b", 1, 0);
        let totals = totals(&traffic);
        assert_eq!(totals.keys().copied().collect::<Vec<_>>(), ["a", "b"]);
        let a = totals["a"];
        assert_eq!((a.senders, a.messages, a.bytes, a.lost), (3, 27, 2700, 3));
        assert!((a.rate_hz - 100.0).abs() < 15.0, "{a:?}");
        assert_eq!(traffic.streams().count(), 4, "a fault would pass");
    }
}
