//! `maulstick take from`: a recorded session as a take, with what it takes to paint it again.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use maulstick_document::{Access, Checkpoint, Document, DocumentSettings};
use maulstick_painting::Sequencer;
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_streams::RecordingWriter;
use maulstick_streams::recording::RecordedMessage;
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::{Flags, Header, Message, Origin, encode, name_hash};

use super::session_file::{Event, JOURNAL, PAINTING, SessionFile};
use crate::commands::say;
use crate::document::wrong;
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::refused;

/// Options of `maulstick take from`.
#[derive(Args, Clone, Debug)]
pub struct FromOptions {
    /// Recording of a session, as `maulstick record` writes it
    recording: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// From so many seconds after its beginning: what was painted before is the painting's beginning
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    start: f64,
    /// To so many seconds after its beginning [default: its end]
    #[arg(long, value_name = "S")]
    end: Option<f64>,
}

/// Topics whose messages a take keeps beside what the painting accepted.
fn is_kept(topic: &str) -> bool {
    let mut parts = topic.split('/');
    match (parts.next(), parts.nth(1)) {
        (Some("stylus"), Some(kind)) => ["sample", "info"].contains(&kind),
        (Some("brush"), Some(kind)) => kind == "def",
        (first, _) => first == Some("scene"),
    }
}

/// Makes a take of a session.
///
/// # Errors
/// A [`UserError`] where the recording lacks something, or the take cannot be written.
pub(super) fn run(options: &FromOptions) -> Result<i32, UserError> {
    let path = &options.recording;
    let bounds = [options.start, options.end.unwrap_or(f64::MAX)];
    if !(bounds[0] >= 0.0 && bounds[1] > bounds[0]) {
        let what = format!("--start {} is not before --end", options.start);
        return Err(UserError::usage(what).help("choose seconds after the beginning"));
    }
    let Some(mut session) = SessionFile::open(path)? else {
        return Err(
            UserError::usage("the recording has no journal of a painting")
                .at(path.display().to_string())
                .help("record all topics: `maulstick record -o session.mcap`"),
        );
    };
    let length_s = session.length_ns() as f64 * 1e-9;
    if bounds[0] >= length_s {
        return Err(
            UserError::usage(format!("--start {} is behind its end", bounds[0]))
                .at(path.display().to_string())
                .help(format!("it is {length_s:.1} s long")),
        );
    }
    let output = UsedFile::new("the take", &options.output).of(Kind::Take);
    check_outputs(&[output], &[UsedFile::new("the recording", path)])?;
    let [start_ns, end_ns] = bounds.map(|seconds| match seconds {
        f64::MAX => u64::MAX,
        seconds => (seconds * 1e9) as u64,
    });
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let begin = folder.path().join(PAINTING);
    session.write_painting(&begin)?;
    let (document, mut sequencer, since) = open_begin(&begin)?;
    if start_ns > 0 {
        session.follow(&mut sequencer, start_ns, &mut |sequencer, _, event| {
            if let Event::Accepted(record) = event {
                sequencer.replay(record);
            }
            Ok(())
        })?;
        document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    }
    document.close().map_err(|error| wrong(&begin, &error))?;
    let painting = std::fs::read(&begin).map_err(|error| UserError::reading(&begin, &error))?;
    let mut counts = Counts::default();
    let fault = RefCell::new(None);
    let written = write_whole(&options.output, Kind::Take, |file| {
        let mut take = SessionWriter::begin(file, &session, &painting)?;
        // What is sent rarely, as it was at the start.
        let mut rare = BTreeMap::new();
        let followed = session.follow(&mut sequencer, end_ns, &mut |_, at_ns, event| {
            if at_ns < start_ns {
                if let Event::Other { topic, message } = event
                    && is_kept(topic)
                    && !topic.ends_with("/sample")
                {
                    rare.insert(topic.to_owned(), message.clone());
                }
                return Ok(());
            }
            let failed = |error| UserError::writing(&options.output, &error);
            for (topic, message) in std::mem::take(&mut rare) {
                take.as_it_was(&topic, &message, start_ns).map_err(failed)?;
            }
            match &event {
                Event::Accepted(record) => {
                    counts.note(record);
                    take.accepted(at_ns, record)
                }
                Event::Other { topic, message } if is_kept(topic) => {
                    take.as_it_was(topic, message, at_ns)
                }
                Event::Other { .. } => Ok(()),
            }
            .map_err(failed)
        });
        if let Err(error) = followed {
            let what = error.what.clone();
            fault.replace(Some(error));
            return Err(std::io::Error::other(what));
        }
        take.finish()
    });
    if let Some(fault) = fault.take() {
        return Err(fault);
    }
    written.map_err(|error| UserError::writing(&options.output, &error))?;
    say!("{}: {}", options.output.display(), counts.in_words());
    Ok(0)
}

/// The painting of a beginning, in the midst of its journal, and the tile versions that its file has.
pub(crate) fn open_begin(path: &Path) -> Result<(Document, Sequencer, u64), UserError> {
    let failed = |error| wrong(path, &error);
    let settings = DocumentSettings::new(path, Access::Paint);
    let (document, opened) = Document::open(&settings).map_err(failed)?;
    let opened = opened.ok_or_else(|| failed(maulstick_document::DocumentError::NoPainting))?;
    let since = opened.snapshot().versions;
    let sequencer = opened.in_its_midst().map_err(refused)?;
    Ok((document, sequencer, since))
}

/// What a session holds.
#[derive(Clone, Debug, Default)]
pub(super) struct Counts {
    states: u64,
    commands: u64,
}

impl Counts {
    pub(super) fn note(&mut self, record: &Record) {
        match &record.what {
            Accepted::State { .. } => self.states += 1,
            Accepted::Entry(Entry::Command { .. }) => self.commands += 1,
            Accepted::Entry(_) => {}
        }
    }

    pub(super) fn in_words(&self) -> String {
        format!("{} brush states, {} commands", self.states, self.commands)
    }

    pub(super) fn in_json(&self) -> serde_json::Value {
        serde_json::json!({"states": self.states, "commands": self.commands})
    }
}

/// Writes a take of a session.
struct SessionWriter<W: std::io::Write + std::io::Seek> {
    writer: RecordingWriter<W>,
    /// Number of the next message of the journal.
    next: u64,
    /// Time of the newest one, ns.
    newest_ns: u64,
    /// Index of the entry of the newest states, which are written, and the entry, which is not.
    states: Option<(u64, Entry)>,
    /// Names of the brushes, by the source of their states.
    brushes: BTreeMap<u32, String>,
}

impl<W: std::io::Write + std::io::Seek> SessionWriter<W> {
    fn begin(to: W, session: &SessionFile, painting: &[u8]) -> std::io::Result<Self> {
        let failed = std::io::Error::other;
        let mut writer = RecordingWriter::begin(to).map_err(failed)?;
        for (name, facts) in &session.recording.notes {
            if name != "counts" {
                writer.note(name, facts.clone()).map_err(failed)?;
            }
        }
        for (name, bytes) in &session.recording.files {
            let bytes = match name == PAINTING {
                true => painting,
                false => bytes,
            };
            writer
                .attach(name, "application/octet-stream", bytes)
                .map_err(failed)?;
        }
        let topics = session.recording.topics().values();
        let brush = |topic: &maulstick_streams::recording::Topic| {
            let name = topic.name.strip_prefix("brush/")?.strip_suffix("/state")?;
            Some((name_hash(name), name.to_owned()))
        };
        Ok(Self {
            writer,
            next: 0,
            newest_ns: 0,
            states: None,
            brushes: topics.filter_map(brush).collect(),
        })
    }

    /// Writes what the painting accepted. One entry names states that follow each other.
    fn accepted(&mut self, at_ns: u64, record: &Record) -> std::io::Result<()> {
        let (header, state) = match &record.what {
            Accepted::State { header, state } => (header, state),
            Accepted::Entry(entry) => {
                self.end_states(at_ns)?;
                return self.entry(at_ns, record.index, entry.clone());
            }
        };
        let brush = self.brushes.get(&header.source).cloned();
        let brush = brush.unwrap_or_default();
        if self
            .states
            .as_ref()
            .is_some_and(|(index, _)| *index != record.index)
        {
            self.end_states(at_ns)?;
        }
        self.message(&format!("brush/{brush}/state"), header, state, at_ns)?;
        let first = || {
            let (epoch, from, to) = (header.epoch, header.seq, header.seq);
            let entry = Entry::States {
                brush,
                epoch,
                from,
                to,
            };
            (record.index, entry)
        };
        if let (_, Entry::States { to, .. }) = self.states.get_or_insert_with(first) {
            *to = header.seq;
        }
        Ok(())
    }

    /// Writes the entry that names the newest states.
    fn end_states(&mut self, at_ns: u64) -> std::io::Result<()> {
        match self.states.take() {
            Some((index, entry)) => self.entry(at_ns, index, entry),
            None => Ok(()),
        }
    }

    fn entry(&mut self, at_ns: u64, index: u64, entry: Entry) -> std::io::Result<()> {
        let header = Header {
            version: JournalEntry::VERSION,
            schema: JournalEntry::schema().hash,
            source: name_hash("paint"),
            epoch: 1,
            flags: Flags::NONE,
            length: 0,
            seq: self.next,
            event_ns: at_ns,
            sent_ns: at_ns,
        };
        self.next += 1;
        self.newest_ns = at_ns;
        self.message(JOURNAL, &header, &JournalEntry { index, entry }, at_ns)
    }

    /// Writes a message as it was recorded.
    fn as_it_was(
        &mut self,
        topic: &str,
        message: &RecordedMessage,
        at_ns: u64,
    ) -> std::io::Result<()> {
        self.writer
            .write(topic, &message.header, &message.bytes, at_ns)
            .map_err(std::io::Error::other)
    }

    fn message<M: Message>(
        &mut self,
        topic: &str,
        header: &Header,
        message: &M,
        at_ns: u64,
    ) -> std::io::Result<()> {
        let origin: Origin = header.origin();
        let [event_ns, sent_ns] = [header.event_ns, header.sent_ns];
        let bytes = encode(
            &origin,
            header.flags,
            header.seq,
            event_ns,
            sent_ns,
            message,
        )
        .map_err(std::io::Error::other)?;
        let header = Header {
            schema: M::schema().hash,
            ..*header
        };
        self.writer
            .write(topic, &header, &bytes, at_ns)
            .map_err(std::io::Error::other)
    }

    fn finish(mut self) -> std::io::Result<()> {
        self.end_states(self.newest_ns)?;
        let counts = BTreeMap::from([("messages".to_owned(), self.next.to_string())]);
        self.writer
            .note("counts", counts)
            .and_then(|()| self.writer.finish())
            .map_err(std::io::Error::other)
    }
}
