//! `maulstick recording`: making and replaying recordings; their contents, and their messages for other programs.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_streams::recording::{RecordedMessage, Topic};
use maulstick_streams::recording_writer::MESSAGE_ENCODING;
use maulstick_streams::topic_pattern::matches;
use maulstick_streams::{Recording, Value};

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

use super::foxglove_export;
use super::message_lines::{MessageLine, decoded, head};
use super::record::{self, RecordOptions};
use super::recording_info::info;
use crate::commands::replay::{self, ReplayOptions};
use crate::commands::say;

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
/// A [`UserError`] for a file that cannot be read or written, or an absent topic.
pub fn run(command: &RecordingCommand) -> Result<i32, UserError> {
    match command {
        RecordingCommand::Record(options) => record::run(options),
        RecordingCommand::Replay(options) => replay::run(options),
        RecordingCommand::Info { recording, json } => info(recording, *json),
        RecordingCommand::Export(options) => export(options),
    }
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

    /// The topics to export. Of several, those without a readable schema are skipped.
    fn topics(&self, recording: &mut Recording) -> Result<BTreeMap<u16, Topic>, UserError> {
        let chosen = recording.topics().iter();
        let chosen = chosen.filter(|(_, topic)| matches(&self.topic, &topic.name));
        let is_one = chosen.clone().count() == 1;
        let (topics, unread): (BTreeMap<u16, Topic>, _) = chosen
            .map(|(channel, topic)| (*channel, topic.clone()))
            .partition(|(_, topic)| is_one || topic.table.is_ok());
        for topic in unread.values() {
            say!(
                "without {}: the schema of its messages is not in this recording",
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
