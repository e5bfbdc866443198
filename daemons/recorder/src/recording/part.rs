//! One file of a recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use maulstick_rig::UserError;
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_streams::catalogue::KnownTables;
use maulstick_streams::traffic::Arrived;
use maulstick_streams::{RateLimit, RecordingWriter};
use maulstick_types::HEADER_BYTES;
use mcap::{McapError, McapResult};

use crate::error::RecorderError;
use crate::listener::{Listener, ReceivedMessage};
use crate::session_file::{NEXT, PAINTING};

/// A file of a recording.
pub(super) struct Part {
    path: PathBuf,
    writer: RecordingWriter<BufWriter<File>>,
    /// Limit on what is written as JSON too; `None` where nothing is.
    json: Option<RateLimit>,
    tables: KnownTables,
    messages: u64,
    /// Bytes of its messages, before they are compressed.
    bytes: u64,
    has_painting: bool,
    begun: Instant,
}

impl Part {
    /// Begins a file, with what it takes to understand it later.
    pub(super) fn begin(
        path: &Path,
        create: fn(&Path) -> std::io::Result<File>,
        listener: &Listener,
        json_hz: u32,
    ) -> Result<Self, RecorderError> {
        let writing = |error: std::io::Error| UserError::writing(path, &error);
        let file = create(path).map_err(writing)?;
        // Other recorders respect the lock; some file systems have none.
        file.try_lock().ok();
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
            has_painting: false,
            begun: Instant::now(),
        })
    }

    pub(super) fn write(&mut self, received: &ReceivedMessage) -> Result<(), RecorderError> {
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
    pub(super) fn attach(&mut self, painting: &[u8]) -> Result<(), RecorderError> {
        self.writer
            .attach(PAINTING, "application/vnd.sqlite3", painting)
            .map_err(|error| fault(&self.path, error))?;
        self.has_painting = true;
        self.flush()
    }

    /// True once the painting is attached.
    pub(super) fn has_painting(&self) -> bool {
        self.has_painting
    }

    pub(super) fn flush(&mut self) -> Result<(), RecorderError> {
        self.writer
            .flush()
            .map_err(|error| fault(&self.path, error))
    }

    /// Its path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes of its messages, before they are compressed.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Time since its beginning.
    pub(super) fn age(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Ends it, with the numbers of messages that were lost, dropped and foreign, and the file in which the recording goes on;
    /// returns the number of messages that it holds.
    pub(super) fn finish(
        &mut self,
        missing: [u64; 3],
        next: Option<&Path>,
    ) -> Result<u64, RecorderError> {
        let [lost, dropped, foreign] = missing;
        let counts = [
            ("messages", self.messages),
            ("lost", lost),
            ("dropped", dropped),
            ("foreign", foreign),
        ];
        let counts = counts.map(|(name, count)| (name.to_owned(), count.to_string()));
        let next = next.and_then(Path::file_name);
        let next = next.map(|name| ("file".to_owned(), name.to_string_lossy().into_owned()));
        let end = || {
            if let Some(next) = next {
                self.writer.note(NEXT, BTreeMap::from([next]))?;
            }
            self.writer.note("counts", counts.into_iter().collect())?;
            self.writer.finish()
        };
        end().map_err(|error| fault(&self.path, error))?;
        Ok(self.messages)
    }
}

/// Error of a file that cannot be written.
fn fault(path: &Path, error: McapError) -> RecorderError {
    let error = match error {
        McapError::Io(error) => error,
        other => std::io::Error::other(other),
    };
    UserError::writing(path, &error).into()
}
