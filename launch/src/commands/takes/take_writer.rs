//! A take of a session: the painting at its beginning, the records accepted since, and the samples of the hands.

use std::collections::BTreeMap;
use std::io::{Error, Result, Seek, Write};

use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_recorder::session_file::JOURNAL;
use maulstick_streams::RecordingWriter;
use maulstick_streams::recording::RecordedMessage;
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::{Flags, Header, Message, Origin, encode, name_hash};

/// Beginning of a take.
#[derive(Clone, Debug, Default)]
pub(super) struct TakeOrigin {
    /// Notes by name.
    pub(super) notes: BTreeMap<String, BTreeMap<String, String>>,
    /// Files that it holds, by name, the painting among them.
    pub(super) files: BTreeMap<String, Vec<u8>>,
    /// Names of the brushes known at its beginning.
    pub(super) brushes: Vec<String>,
}

/// Writes a take of a session.
pub(super) struct TakeWriter<W: Write + Seek> {
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

impl<W: Write + Seek> TakeWriter<W> {
    /// Begins a take.
    pub(super) fn begin(to: W, origin: TakeOrigin) -> Result<Self> {
        let mut writer = RecordingWriter::begin(to).map_err(Error::other)?;
        for (name, facts) in origin.notes {
            writer.note(&name, facts).map_err(Error::other)?;
        }
        for (name, bytes) in &origin.files {
            writer
                .attach(name, "application/octet-stream", bytes)
                .map_err(Error::other)?;
        }
        let brushes = origin.brushes.into_iter();
        Ok(Self {
            writer,
            next: 0,
            newest_ns: 0,
            states: None,
            brushes: brushes.map(|name| (name_hash(&name), name)).collect(),
        })
    }

    /// Writes accepted records. One entry names consecutive states.
    pub(super) fn accepted(&mut self, at_ns: u64, record: &Record) -> Result<()> {
        let (header, state) = match &record.what {
            Accepted::State { header, state } => (header, state),
            Accepted::Entry(entry) => {
                if let Entry::Brush { brush, .. } = entry {
                    self.brushes.insert(name_hash(brush), brush.clone());
                }
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
    fn end_states(&mut self, at_ns: u64) -> Result<()> {
        match self.states.take() {
            Some((index, entry)) => self.entry(at_ns, index, entry),
            None => Ok(()),
        }
    }

    fn entry(&mut self, at_ns: u64, index: u64, entry: Entry) -> Result<()> {
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

    /// Writes a message as recorded.
    pub(super) fn as_it_was(
        &mut self,
        topic: &str,
        message: &RecordedMessage,
        at_ns: u64,
    ) -> Result<()> {
        self.writer
            .write(topic, &message.header, &message.bytes, at_ns)
            .map_err(Error::other)
    }

    fn message<M: Message>(
        &mut self,
        topic: &str,
        header: &Header,
        message: &M,
        at_ns: u64,
    ) -> Result<()> {
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
        .map_err(Error::other)?;
        let header = Header {
            schema: M::schema().hash,
            ..*header
        };
        self.writer
            .write(topic, &header, &bytes, at_ns)
            .map_err(Error::other)
    }

    pub(super) fn finish(mut self) -> Result<()> {
        self.end_states(self.newest_ns)?;
        let counts = BTreeMap::from([("messages".to_owned(), self.next.to_string())]);
        self.writer
            .note("counts", counts)
            .and_then(|()| self.writer.finish())
            .map_err(Error::other)
    }
}
