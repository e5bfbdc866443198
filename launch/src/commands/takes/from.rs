//! `maulstick take from`: makes a take of a recorded session, or of a painting's record.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use maulstick_document::Checkpoint;
use maulstick_painting::Sequencer;
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_recorder::paintings::open_begin;
use maulstick_recorder::session_file::{COUNTS, Event, NEXT, PAINTING, STATES, SessionFile};
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, is_painting, write_whole};
use maulstick_session::RecordedSession;
use maulstick_streams::recording::Topic;
use maulstick_streams::topic_pattern::{matches, parts};
use maulstick_types::paint::Entry;

use maulstick_painting_setup::document::wrong;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

use super::painting_record::PaintingRecord;
use super::take_writer::{TakeOrigin, TakeWriter};
use crate::commands::say;

/// Options of `maulstick take from`.
#[derive(Args, Clone, Debug)]
pub struct FromOptions {
    /// Recording of a session, as `maulstick recording record` writes it, or a painting
    #[arg(value_name = "RECORDING|PAINTING")]
    recording: PathBuf,
    /// Take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// From so many seconds after its beginning: what was painted before is the painting's beginning. Of a painting they
    /// are seconds of work: brushes in contact, and pauses of up to a second
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    start: f64,
    /// To so many seconds after its beginning [default: its end]
    #[arg(long, value_name = "S")]
    end: Option<f64>,
}

/// Topics whose last message stays valid until the next, among those of a take beside the accepted records.
const RARE: [&str; 3] = ["stylus/*/info", "brush/*/def", "scene"];
/// Topics of the hands, which a take keeps too.
const HANDS: &str = "stylus/*/sample";

fn is_rare(topic: &str) -> bool {
    RARE.iter().any(|pattern| matches(pattern, topic))
}

/// Makes a take of a session.
///
/// # Errors
/// A [`UserError`] where the recording is incomplete, or the take cannot be written.
pub(super) fn run(options: &FromOptions) -> Result<i32, UserError> {
    let path = &options.recording;
    let mut session = Source::open(path)?;
    let range_ns = options.range_ns(&session)?;
    let output = UsedFile::new("the take", &options.output).of(Kind::Take);
    check_outputs(&[output], &[session.used(path)])?;
    let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
    let begin = folder.path().join(PAINTING);
    let (origin, mut sequencer) = begin_at(&mut session, &begin, range_ns[0])?;
    let mut counts = Counts::default();
    let fault = RefCell::new(None);
    let written = write_whole(&options.output, Kind::Take, |file| {
        let mut take = TakeWriter::begin(file, origin)?;
        let failed = |error| UserError::writing(&options.output, &error);
        // What is sent rarely, as it was at the start.
        let mut rare = BTreeMap::new();
        let followed = session.follow(&mut sequencer, range_ns[1], &mut |_, at_ns, event| {
            if at_ns < range_ns[0] {
                if let Event::Other { topic, message } = event
                    && is_rare(topic)
                {
                    rare.insert(topic.to_owned(), message.clone());
                }
                return Ok(());
            }
            for (topic, message) in std::mem::take(&mut rare) {
                let written = take.as_it_was(&topic, &message, range_ns[0]);
                written.map_err(failed)?;
            }
            match &event {
                Event::Accepted(record) => {
                    counts.note(record);
                    take.accepted(at_ns, record)
                }
                Event::Other { topic, message } if is_rare(topic) || matches(HANDS, topic) => {
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

impl FromOptions {
    /// The part of a session that the take has, ns.
    fn range_ns(&self, session: &Source) -> Result<[u64; 2], UserError> {
        let bounds = [self.start, self.end.unwrap_or(f64::MAX)];
        if !(bounds[0] >= 0.0 && bounds[1] > bounds[0]) {
            let what = format!("--start {} is not before --end", self.start);
            return Err(UserError::usage(what).help("choose seconds after the beginning"));
        }
        let at = self.recording.display().to_string();
        let length_s = session.length_ns() as f64 * 1e-9;
        if length_s == 0.0 {
            let what = "nothing was painted in it since its beginning";
            return Err(UserError::usage(what).at(at));
        }
        if bounds[0] >= length_s {
            let what = format!("--start {} is behind its end", bounds[0]);
            let help = session.length_in_words();
            return Err(UserError::usage(what).at(at).help(help));
        }
        Ok(bounds.map(|seconds| match seconds {
            f64::MAX => u64::MAX,
            seconds => (seconds * 1e9) as u64,
        }))
    }
}

/// What a take of a session begins with, and its painting, in a file, at that time, ns.
fn begin_at(
    session: &mut Source,
    begin: &Path,
    start_ns: u64,
) -> Result<(TakeOrigin, Sequencer), UserError> {
    session.write_painting(begin)?;
    let (document, mut sequencer, since) = open_begin(begin)?;
    let mut brushes = Vec::new();
    if start_ns > 0 {
        session.follow(&mut sequencer, start_ns, &mut |sequencer, _, event| {
            if let Event::Accepted(record) = event {
                if let Accepted::Entry(Entry::Brush { brush, .. }) = &record.what {
                    brushes.push(brush.clone());
                }
                sequencer.replay(record);
            }
            Ok(())
        })?;
        document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    }
    document.close().map_err(|error| wrong(begin, &error))?;
    let painting = std::fs::read(begin).map_err(|error| UserError::reading(begin, &error))?;
    let mut origin = session.origin()?;
    origin.files.insert(PAINTING.to_owned(), painting);
    origin.brushes.extend(brushes);
    Ok((origin, sequencer))
}

/// Where a take comes from.
enum Source {
    Session(SessionFile),
    Painting(PaintingRecord),
}

impl Source {
    fn open(path: &Path) -> Result<Self, UserError> {
        if is_painting(path) {
            return Ok(Self::Painting(PaintingRecord::open(path)?));
        }
        let session = SessionFile::open(path)?;
        session.map(Self::Session).ok_or_else(|| {
            UserError::usage("the recording has no journal of a painting")
                .at(path.display().to_string())
                .help("record all topics: `maulstick recording record -o session.mcap`")
        })
    }

    fn used(&self, path: &Path) -> UsedFile {
        match self {
            Self::Session(_) => UsedFile::new("the recording", path),
            Self::Painting(_) => UsedFile::painting(path),
        }
    }

    fn length_ns(&self) -> u64 {
        match self {
            Self::Session(session) => session.length_ns(),
            Self::Painting(painting) => painting.length_ns(),
        }
    }

    /// Text of its length, and of its continuation.
    fn length_in_words(&self) -> String {
        let length_s = self.length_ns() as f64 * 1e-9;
        let next = match self {
            Self::Session(session) => session.next(),
            Self::Painting(_) => None,
        };
        match next {
            Some(next) => {
                format!("it is {length_s:.1} s long, and the recording continues in {next}")
            }
            None => format!("it is {length_s:.1} s long"),
        }
    }

    fn write_painting(&self, to: &Path) -> Result<(), UserError> {
        match self {
            Self::Session(session) => Ok(session.write_painting(to)?),
            Self::Painting(painting) => painting.write_painting(to),
        }
    }

    fn follow(
        &mut self,
        sequencer: &mut Sequencer,
        to_ns: u64,
        each: &mut dyn FnMut(&mut Sequencer, u64, Event<'_>) -> Result<(), UserError>,
    ) -> Result<(), UserError> {
        match self {
            Self::Session(session) => {
                let recorded = RecordedSession::after(sequencer);
                Ok(session.follow(recorded, sequencer, to_ns, each)?)
            }
            Self::Painting(painting) => painting.follow(sequencer, to_ns, each),
        }
    }

    /// Beginning of its take, without the painting.
    fn origin(&self) -> Result<TakeOrigin, UserError> {
        match self {
            Self::Session(session) => origin_of(session),
            Self::Painting(painting) => Ok(painting.origin()),
        }
    }
}

/// Beginning of a session's take, without the painting.
fn origin_of(session: &SessionFile) -> Result<TakeOrigin, UserError> {
    let recording = &session.recording;
    let mut notes = recording.notes().clone();
    notes.remove(COUNTS);
    notes.remove(NEXT);
    let mut files = BTreeMap::new();
    for name in recording.attachments().keys() {
        if name != PAINTING
            && let Some(bytes) = recording.attachment(name)?
        {
            files.insert(name.clone(), bytes);
        }
    }
    let topics = recording.topics().values();
    let brush = |topic: &Topic| Some(parts(STATES, &topic.name)?.first()?.to_string());
    Ok(TakeOrigin {
        notes,
        files,
        brushes: topics.filter_map(brush).collect(),
    })
}

/// Contents of a session.
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
