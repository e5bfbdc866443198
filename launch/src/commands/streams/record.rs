//! `maulstick record`: the streams of a running rig into a file, by a process of its own that no node waits for.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_streams::catalogue::KnownTables;
use maulstick_streams::topic_pattern::matches;
use maulstick_streams::traffic::Arrived;
use maulstick_streams::{RateLimit, RecordingWriter, Traffic};
use maulstick_types::HEADER_BYTES;
use mcap::McapResult;

use super::fault;
use super::listener::{Listener, ReceivedMessage};
use super::painting_copy::PaintingCopy;
use super::ring::{FILES, Ring};
use crate::commands::say;
use crate::commands::session::Target;
use crate::commands::takes::session_file::{JOURNAL, PAINTING};
use crate::outputs::{UsedFile, check_outputs};

/// Options of `maulstick record`.
#[derive(Args, Clone, Debug)]
pub struct RecordOptions {
    /// Recording to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Topics to record, such as stylus/**: * stands for one part, ** for any number
    #[arg(long, value_name = "TOPIC", default_value = "**")]
    topic: String,
    /// End after so long, s; otherwise at Ctrl-C, or with the rig
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Begin another file after so many megabytes
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    split_mb: Option<u64>,
    /// Begin another file after so long, s
    #[arg(long, value_name = "S")]
    split_seconds: Option<f64>,
    /// Keep only the newest so many seconds: the oldest of six files goes
    #[arg(long, value_name = "S", conflicts_with = "split_seconds")]
    last: Option<f64>,
    /// Keep at most so many megabytes on the disk: the oldest files go
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    quota_mb: Option<u64>,
    /// Most messages a second of each topic that are written as JSON too, for Foxglove; 0 for none
    #[arg(long, value_name = "HZ", default_value_t = 20, value_parser = clap::value_parser!(u32).range(..=1000))]
    json_hz: u32,
    #[command(flatten)]
    target: Target,
}

/// Shortest time of which the newest files are kept, s: each needs time for its painting.
const LEAST_LAST_S: f64 = 10.0;
/// Of a quota the part that one file has.
const QUOTA_FILES: u64 = 8;
/// At most so much is lost with this process.
const FLUSH: Duration = Duration::from_millis(500);

/// Records until Ctrl-C, the end of the time, or that of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the file cannot be written: what was written until then can be read.
pub fn run(options: &RecordOptions) -> Result<i32, UserError> {
    let bounded = |name: &str, seconds: Option<f64>| match seconds {
        Some(s) if !(0.1..=1e7).contains(&s) => {
            Err(UserError::usage(format!("--{name} {s} is out of range"))
                .help("choose .1 s to 10,000,000 s"))
        }
        seconds => Ok(seconds.map(Duration::from_secs_f64)),
    };
    let lasts = bounded("seconds", options.seconds)?;
    if options.last.is_some_and(|last| last < LEAST_LAST_S) {
        let what = format!("--last {} is out of range", options.last.unwrap_or(0.0));
        return Err(UserError::usage(what).help(format!("choose {LEAST_LAST_S} s or more")));
    }
    let last = bounded("last", options.last)?.map(|last| last / FILES);
    let split_after = bounded("split-seconds", options.split_seconds)?.or(last);
    let bytes = |mb: u64| mb.saturating_mul(1_000_000);
    let quota = options.quota_mb.map(bytes);
    let of_quota = quota.map(|quota| quota / QUOTA_FILES);
    let most = options
        .split_mb
        .map(bytes)
        .into_iter()
        .chain(of_quota)
        .min();
    let mut ring = Ring::new(&options.output, last.is_some(), quota);
    let output = UsedFile::new("the recording", &options.output).of(Kind::Take);
    check_outputs(&[output], &[])?;
    let mut listener = Listener::open(&options.target, &options.topic)?;
    say!(
        "recording into {}; Ctrl-C ends it",
        options.output.display()
    );
    let begun = Instant::now();
    let end = lasts.map(|lasts| begun + lasts);
    let mut state = State::default();
    let begin = |path: &Path, create: Create, listener: &Listener| {
        Part::begin(path, create, listener, options.json_hz)
    };
    let mut part = begin(&options.output, |path| File::create(path), &listener)?;
    let mut flush_at = begun + FLUSH;
    let paints = matches(&options.topic, JOURNAL);
    let mut copy = paints.then(PaintingCopy::default);
    while !listener.is_over() && end.is_none_or(|end| Instant::now() < end) {
        if let Some(received) = listener.next(end.map_or(flush_at, |end| end.min(flush_at))) {
            part.write(&received)?;
            state.add(received);
        }
        if Instant::now() < flush_at {
            continue;
        }
        flush_at = Instant::now() + FLUSH;
        part.flush()?;
        if let Some(own) = &mut copy
            && let Some(painting) = own.look(&options.target)?
        {
            part.attach(&painting)?;
            copy = None;
        }
        if !listener.has_rig() {
            break;
        }
        let is_full = most.is_some_and(|most| part.bytes >= most)
            || split_after.is_some_and(|after| part.begun.elapsed() >= after);
        // A copy belongs to the file at whose beginning it was asked for.
        if is_full && !copy.as_ref().is_some_and(PaintingCopy::is_made) {
            part.finish(&mut state, &listener)?;
            part = begin(&ring.next(), |path| File::create_new(path), &listener)?;
            ring.trim()?;
            // What is sent rarely is in each file, from its beginning on.
            let now_ns = listener.member.bus.now_ns();
            for received in state.kept.values() {
                let mut again = received.clone();
                again.message.arrived_ns = now_ns;
                part.write(&again)?;
            }
            copy = paints.then(PaintingCopy::default);
        }
    }
    if let Some(painting) = copy.and_then(PaintingCopy::wait) {
        part.attach(&painting)?;
    }
    part.finish(&mut state, &listener)?;
    Ok(0)
}

/// What was received so far, over all files.
#[derive(Default)]
struct State {
    traffic: Traffic,
    /// The last message of each topic that is kept for late joiners.
    kept: BTreeMap<String, ReceivedMessage>,
    /// Messages that were lost, dropped and foreign before this file.
    before: [u64; 3],
}

impl State {
    fn add(&mut self, received: ReceivedMessage) {
        self.traffic.add(&received.topic, &received.message);
        if Listener::is_cached(&received.topic) {
            self.kept.insert(received.topic.clone(), received);
        }
    }

    /// Messages that were lost, dropped and foreign since the last question.
    fn missing(&mut self, listener: &Listener) -> [u64; 3] {
        let lost = self.traffic.streams().map(|(_, _, stream)| stream.lost);
        let all = [lost.sum(), listener.dropped(), listener.foreign];
        let before = std::mem::replace(&mut self.before, all);
        // One that came late after all was lost in the file before.
        std::array::from_fn(|place| all[place].saturating_sub(before[place]))
    }
}

/// How a file is created.
type Create = fn(&Path) -> std::io::Result<File>;

/// A file of a recording.
struct Part {
    path: PathBuf,
    writer: RecordingWriter<BufWriter<File>>,
    /// Limit on what is written as JSON too; `None` where nothing is.
    json: Option<RateLimit>,
    tables: KnownTables,
    messages: u64,
    /// Bytes of its messages, before they are compressed.
    bytes: u64,
    begun: Instant,
}

impl Part {
    /// Begins a file, with what it takes to understand it later.
    fn begin(
        path: &Path,
        create: Create,
        listener: &Listener,
        json_hz: u32,
    ) -> Result<Self, UserError> {
        let writing = |error: std::io::Error| UserError::writing(path, &error);
        let file = create(path).map_err(writing)?;
        let member = &listener.member;
        let settings = std::fs::read(member.folder.join(CONFIG_FILE)).unwrap_or_default();
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let facts = [
            (
                "rig",
                member.topics.prefix().trim_end_matches('/').to_owned(),
            ),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("unix_ns", now.as_nanos().to_string()),
            ("rig_ns", member.bus.now_ns().to_string()),
        ];
        let facts: BTreeMap<String, String> = facts
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text))
            .collect();
        let begin = || {
            let mut writer = RecordingWriter::begin(BufWriter::new(file))?;
            writer.note("recording", facts)?;
            writer.attach("rig.toml", "application/toml", &settings)?;
            Ok(writer)
        };
        Ok(Self {
            writer: begin().map_err(|error| fault(path, error))?,
            path: path.to_owned(),
            json: (json_hz > 0).then(|| RateLimit::new(json_hz)),
            tables: KnownTables::default(),
            messages: 0,
            bytes: 0,
            begun: Instant::now(),
        })
    }

    fn write(&mut self, received: &ReceivedMessage) -> Result<(), UserError> {
        self.write_as_sent(received)
            .and_then(|()| self.write_as_json(received))
            .map_err(|error| fault(&self.path, error))?;
        self.messages += 1;
        self.bytes += received.bytes.len() as u64;
        Ok(())
    }

    fn write_as_sent(&mut self, received: &ReceivedMessage) -> McapResult<()> {
        let ReceivedMessage { topic, bytes, .. } = received;
        let Arrived {
            header, arrived_ns, ..
        } = &received.message;
        self.writer.write(topic, header, bytes, *arrived_ns)
    }

    /// Writes what of a message its topic's limit lets through.
    fn write_as_json(&mut self, received: &ReceivedMessage) -> McapResult<()> {
        let Arrived {
            header, arrived_ns, ..
        } = &received.message;
        let (topic, arrived_ns) = (&received.topic, *arrived_ns);
        let passes = |limit: &mut RateLimit| limit.admits(topic, arrived_ns);
        if !self.json.as_mut().is_some_and(passes) {
            return Ok(());
        }
        let body = received.bytes.get(HEADER_BYTES..).unwrap_or_default();
        let Some(table) = self.tables.of(header.schema) else {
            return Ok(());
        };
        match table.decode(body) {
            Ok(value) => self
                .writer
                .write_json(topic, table, header, &value, arrived_ns),
            // As it was sent it is in the recording.
            Err(_) => Ok(()),
        }
    }

    /// Attaches the painting as it was at the beginning.
    fn attach(&mut self, painting: &[u8]) -> Result<(), UserError> {
        self.writer
            .attach(PAINTING, "application/vnd.sqlite3", painting)
            .map_err(|error| fault(&self.path, error))?;
        self.flush()
    }

    fn flush(&mut self) -> Result<(), UserError> {
        self.writer
            .flush()
            .map_err(|error| fault(&self.path, error))
    }

    /// Ends it, with what is missing in it.
    fn finish(mut self, state: &mut State, listener: &Listener) -> Result<(), UserError> {
        let [lost, dropped, foreign] = state.missing(listener);
        let counts = [
            ("messages", self.messages),
            ("lost", lost),
            ("dropped", dropped),
            ("foreign", foreign),
        ];
        let counts = counts.map(|(name, count)| (name.to_owned(), count.to_string()));
        let path = self.path;
        let end = || {
            self.writer.note("counts", counts.into_iter().collect())?;
            self.writer.finish()
        };
        end().map_err(|error| fault(&path, error))?;
        let on_disk = std::fs::metadata(&path).map_or(0, |data| data.len());
        say!(
            "{}: {} messages in {:.1} s, {:.1} MB; {lost} lost, {dropped} dropped here",
            path.display(),
            self.messages,
            self.begun.elapsed().as_secs_f64(),
            on_disk as f64 * 1e-6
        );
        Ok(())
    }
}
