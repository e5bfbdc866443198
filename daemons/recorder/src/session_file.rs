//! A session in a file: a recording that holds the painting as it was, what was accepted since, and the samples of the
//! hands.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use maulstick_painting::Sequencer;
use maulstick_painting::sequencer::Record;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_session::RecordedSession;
use maulstick_session::recorded::SessionFault;
use maulstick_streams::Recording;
use maulstick_streams::recording::{RecordedMessage, Topic};
use maulstick_streams::topic_pattern::matches;
use maulstick_types::brush::BrushState;
use maulstick_types::paint::JournalEntry;
use maulstick_types::{Header, Message};

/// Name of the attached painting.
pub const PAINTING: &str = "painting.maul";
/// Topic of the painting's journal.
pub const JOURNAL: &str = "paint/journal";
/// Name of the note that a recording has once it was ended.
pub const COUNTS: &str = "counts";
/// Name of the note with the file in which a recording goes on.
pub const NEXT: &str = "next";
/// Topics of the brush states.
pub const STATES: &str = "brush/*/state";

/// A session in a file.
#[derive(Clone, Debug)]
pub struct SessionFile {
    path: PathBuf,
    /// The recording.
    pub recording: Recording,
}

/// What happens in a session, in the order of time.
pub enum Event<'a> {
    /// A record that the painting accepts.
    Accepted(Record),
    /// A message of another topic than the journal and the brush states.
    Other {
        /// Its topic.
        topic: &'a str,
        /// The message.
        message: &'a RecordedMessage,
    },
}

impl SessionFile {
    /// Opens a session; `None` if the file is no recording of a painting's journal.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, or lacks the painting.
    pub fn open(path: &Path) -> Result<Option<Self>, UserError> {
        Self::of(Recording::open(path)?)
    }

    /// As [`Self::open`]; `None` also if the file is no recording at all: a take that is damaged is told of as a take.
    ///
    /// # Errors
    /// A [`UserError`] where it lacks the painting.
    pub fn find(path: &Path) -> Result<Option<Self>, UserError> {
        Recording::open(path).map_or(Ok(None), Self::of)
    }

    /// The session of a recording; `None` if it has no journal of a painting.
    ///
    /// # Errors
    /// A [`UserError`] where it lacks the painting.
    pub fn of(recording: Recording) -> Result<Option<Self>, UserError> {
        let path = recording.path();
        let mut topics = recording.topics().values();
        if !topics.any(|topic| topic.name == JOURNAL) {
            return Ok(None);
        }
        if !recording.attachments().contains_key(PAINTING) {
            return Err(UserError::usage(
                "the recording lacks the painting as it was at its beginning",
            )
            .at(path.display().to_string())
            .help("record a painting that is in a file, such as `maulstick up sea.maul`"));
        }
        Ok(Some(Self {
            path: path.to_owned(),
            recording,
        }))
    }

    /// Writes the painting as it was at the beginning to a file that is not there yet.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be written.
    pub fn write_painting(&self, to: &Path) -> Result<(), UserError> {
        let written = write_whole(to, Kind::Own, |file| {
            self.recording.copy_attachment(PAINTING, file)
        });
        written.map_err(|error| match error.kind() {
            ErrorKind::InvalidData => {
                UserError::usage("the painting as it was at its beginning is damaged")
                    .at(self.path.display().to_string())
                    .help("nothing can be painted again from this recording")
            }
            _ => UserError::writing(to, &error),
        })
    }

    /// Name of the file in which the recording goes on, if it does.
    pub fn next(&self) -> Option<&str> {
        let note = self.recording.notes().get(NEXT)?;
        note.get("file").map(String::as_str)
    }

    /// Length of the session, ns.
    pub fn length_ns(&self) -> u64 {
        let [first, last] = self.recording.times_ns().unwrap_or_default();
        last.saturating_sub(first)
    }

    /// Has `each` see what happened since the place of `session`, where the painting of `sequencer` is, up to so many ns
    /// after the beginning: the time since then, ns, and the event.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be read, is damaged, or something is missing in it; that of `each`.
    pub fn follow(
        &mut self,
        mut session: RecordedSession,
        sequencer: &mut Sequencer,
        to_ns: u64,
        each: &mut dyn FnMut(&mut Sequencer, u64, Event<'_>) -> Result<(), UserError>,
    ) -> Result<(), UserError> {
        let topics = self.recording.topics().clone();
        let [first_ns, _] = self.recording.times_ns().unwrap_or_default();
        let place = self.path.display().to_string();
        let broken = |fault: &SessionFault, at_ns: u64| {
            let [at_s, end_s] = [0, 1].map(|less| {
                let tenths = (at_ns / 100_000_000)
                    .saturating_sub(less * u64::from(at_ns.is_multiple_of(100_000_000)));
                tenths as f64 * 0.1
            });
            if let SessionFault::Before { .. } | SessionFault::Behind { .. } = fault {
                return UserError::usage(fault.to_string())
                    .at(&place)
                    .help("`maulstick snapshot` says at which place of the journal it was made");
            }
            UserError::usage(format!("at {at_s:.1} s: {fault}"))
                .at(&place)
                .help(format!(
                    "`maulstick take from {place} --end {end_s:.1} -o TAKE` keeps what is before it"
                ))
        };
        let (mut newest_ns, mut done) = (0, Ok(()));
        let range = [first_ns, first_ns.saturating_add(to_ns)];
        let mut take_in = |topic: &Topic, message: &RecordedMessage| -> Result<(), UserError> {
            let at_ns = message.arrived_ns.saturating_sub(first_ns);
            let name = topic.name.as_str();
            if matches(STATES, name) {
                let (header, state) = typed::<BrushState>(topic, message, &place)?;
                session.state(header, state);
            } else if name == JOURNAL {
                let (header, entry) = typed::<JournalEntry>(topic, message, &place)?;
                let known = session.entry(&header, entry);
                known.map_err(|fault| broken(&fault, at_ns))?;
            } else {
                let topic = name;
                return each(sequencer, at_ns, Event::Other { topic, message });
            }
            loop {
                let next = session.next_record();
                let Some(record) = next.map_err(|fault| broken(&fault, at_ns))? else {
                    return Ok(());
                };
                newest_ns = at_ns;
                each(sequencer, at_ns, Event::Accepted(record))?;
            }
        };
        self.recording.messages(range, &mut |message| {
            if let Some(topic) = topics.get(&message.channel) {
                done = take_in(topic, &message);
            }
            done.is_ok()
        })?;
        done?;
        // Of a recording that was cut off the last message may be anywhere.
        match session.end() {
            Err(fault @ (SessionFault::Before { .. } | SessionFault::Behind { .. })) => {
                return Err(broken(&fault, newest_ns));
            }
            Err(fault) if to_ns == u64::MAX && !self.is_cut_off() => {
                return Err(broken(&fault, newest_ns));
            }
            _ => {}
        }
        match self.recording.damage() {
            Some(damage) if to_ns == u64::MAX && !self.is_cut_off() => {
                Err(UserError::usage(format!("the recording is damaged: {damage}")).at(place))
            }
            _ => Ok(()),
        }
    }

    /// True if it has no index, as after a crash: what it holds is whole.
    fn is_cut_off(&self) -> bool {
        !self.recording.notes().contains_key(COUNTS)
    }
}

/// Header and body of a message, whatever version recorded it.
fn typed<M: Message>(
    topic: &Topic,
    message: &RecordedMessage,
    place: &str,
) -> Result<(Header, M), UserError> {
    topic.read::<M>(message).map_err(|error| {
        UserError::usage(format!("{}: {error}", topic.name))
            .at(place)
            .help("paint it with the version of Maulstick that recorded it: `maulstick recording info` names it")
    })
}
