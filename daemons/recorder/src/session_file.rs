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

use crate::error::{RecorderError, is_of_its_place};

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

/// Event of a session, in the order of time.
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
    /// A [`RecorderError`] where it cannot be read, or lacks the painting.
    pub fn open(path: &Path) -> Result<Option<Self>, RecorderError> {
        Self::of(Recording::open(path)?)
    }

    /// As [`Self::open`]; `None` also if the file is no recording at all: a damaged take is reported as a take.
    ///
    /// # Errors
    /// A [`RecorderError`] where it lacks the painting.
    pub fn find(path: &Path) -> Result<Option<Self>, RecorderError> {
        Recording::open(path).map_or(Ok(None), Self::of)
    }

    /// The session of a recording; `None` if it has no journal of a painting.
    ///
    /// # Errors
    /// A [`RecorderError`] where it lacks the painting.
    pub fn of(recording: Recording) -> Result<Option<Self>, RecorderError> {
        let path = recording.path();
        let mut topics = recording.topics().values();
        if !topics.any(|topic| topic.name == JOURNAL) {
            return Ok(None);
        }
        if !recording.attachments().contains_key(PAINTING) {
            return Err(RecorderError::NoPainting(path.to_owned()));
        }
        Ok(Some(Self {
            path: path.to_owned(),
            recording,
        }))
    }

    /// Writes the painting as it was at the beginning to a file that is not there yet.
    ///
    /// # Errors
    /// A [`RecorderError`] where it cannot be written.
    pub fn write_painting(&self, to: &Path) -> Result<(), RecorderError> {
        let written = write_whole(to, Kind::Own, |file| {
            self.recording.copy_attachment(PAINTING, file)
        });
        written.map_err(|error| match error.kind() {
            ErrorKind::InvalidData => RecorderError::PaintingDamaged(self.path.clone()),
            _ => UserError::writing(to, &error).into(),
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

    /// Gives `each` the events since the place of `session`, where the painting of `sequencer` is, up to `to_ns` after the
    /// beginning, with the time of each since then, ns.
    ///
    /// # Errors
    /// A [`RecorderError`] where the file cannot be read, is damaged, or lacks something; that of `each`.
    pub fn follow(
        &mut self,
        session: RecordedSession,
        sequencer: &mut Sequencer,
        to_ns: u64,
        each: &mut dyn FnMut(&mut Sequencer, u64, Event<'_>) -> Result<(), UserError>,
    ) -> Result<(), RecorderError> {
        let topics = self.recording.topics().clone();
        let [first_ns, _] = self.recording.times_ns().unwrap_or_default();
        let mut reader = SessionReader {
            file: self.path.clone(),
            session,
            sequencer,
            each,
            newest_ns: 0,
        };
        let mut done = Ok(());
        let range = [first_ns, first_ns.saturating_add(to_ns)];
        self.recording.messages(range, &mut |message| {
            if let Some(topic) = topics.get(&message.channel) {
                let at_ns = message.arrived_ns.saturating_sub(first_ns);
                done = reader.add(topic, &message, at_ns);
            }
            done.is_ok()
        })?;
        done?;
        // Of a recording that was cut off the last message may be anywhere.
        let is_complete = to_ns == u64::MAX && !self.is_cut_off();
        if let Err(fault) = reader.session.end()
            && (is_complete || is_of_its_place(&fault))
        {
            return Err(reader.broken(fault, reader.newest_ns));
        }
        match self.recording.damage() {
            Some(damage) if is_complete => Err(RecorderError::Damaged {
                damage: damage.to_owned(),
                file: self.path.clone(),
            }),
            _ => Ok(()),
        }
    }

    /// True if it has no index, as after a crash: what it holds is whole.
    fn is_cut_off(&self) -> bool {
        !self.recording.notes().contains_key(COUNTS)
    }
}

/// A session that is read, message by message.
struct SessionReader<'a> {
    file: PathBuf,
    session: RecordedSession,
    sequencer: &'a mut Sequencer,
    each: &'a mut dyn FnMut(&mut Sequencer, u64, Event<'_>) -> Result<(), UserError>,
    /// Time of the newest record, ns.
    newest_ns: u64,
}

impl SessionReader<'_> {
    /// Adds a message, and gives on the records that are complete with it.
    fn add(
        &mut self,
        topic: &Topic,
        message: &RecordedMessage,
        at_ns: u64,
    ) -> Result<(), RecorderError> {
        let name = topic.name.as_str();
        if matches(STATES, name) {
            let (header, state) = self.typed::<BrushState>(topic, message)?;
            self.session.state(header, state);
        } else if name == JOURNAL {
            let (header, entry) = self.typed::<JournalEntry>(topic, message)?;
            let known = self.session.entry(&header, entry);
            known.map_err(|fault| self.broken(fault, at_ns))?;
        } else {
            let other = Event::Other {
                topic: name,
                message,
            };
            return Ok((self.each)(self.sequencer, at_ns, other)?);
        }
        loop {
            let next = self.session.next_record();
            let Some(record) = next.map_err(|fault| self.broken(fault, at_ns))? else {
                return Ok(());
            };
            self.newest_ns = at_ns;
            (self.each)(self.sequencer, at_ns, Event::Accepted(record))?;
        }
    }

    fn broken(&self, fault: SessionFault, at_ns: u64) -> RecorderError {
        RecorderError::Session {
            fault,
            at_ns,
            file: self.file.clone(),
        }
    }

    /// Header and body of a message, whatever version recorded it.
    fn typed<M: Message>(
        &self,
        topic: &Topic,
        message: &RecordedMessage,
    ) -> Result<(Header, M), RecorderError> {
        let read = topic.read::<M>(message);
        read.map_err(|error| RecorderError::Unreadable {
            what: topic.name.clone(),
            error,
            file: Some(self.file.clone()),
        })
    }
}
