//! A session is painted again in a running rig: in a painting of its own, which is as it was at the session's beginning, what
//! was accepted then is accepted again in the same order.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::typed::random_u64;
use maulstick_document::{Checkpoint, journal};
use maulstick_painting::sequencer::Record;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::files::first_free;
use maulstick_rig::user_error::EXIT_FAILURE;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_session::RecordedSession;
use maulstick_types::command::{RIG_NODE, RigCommand, SessionCommand};
use serde_bytes::ByteBuf;
use serde_json::json;

use super::events::Events;
use super::{Leap, Playback, ReplayOptions, TURN, Turn};
use crate::commands::open::{LONGEST, whole};
use crate::commands::print_json_line;
use crate::commands::say;
use crate::commands::takes::from::open_begin;
use crate::commands::takes::session_file::{Event, PAINTING, SessionFile};
use crate::document::wrong;
use crate::outputs::{UsedFile, check_outputs};

/// Records that the paint node accepts at once: in between it serves the window.
const BATCH: usize = 16;
/// Time after which the paint node is told that the player is still there.
const ALIVE: Duration = Duration::from_secs(2);
/// Longest wait for the paint node.
const PATIENCE: Duration = Duration::from_secs(60);

/// Paints a session again.
///
/// # Errors
/// A [`UserError`] where the rig does not open its painting, or refuses a record.
pub(super) fn replay(options: &ReplayOptions, session: &SessionFile) -> Result<i32, UserError> {
    let range_ns = options.range_ns(session.length_ns())?;
    let path = match &options.painting.document {
        Some(path) => path.clone(),
        None => free_beside(&options.recording),
    };
    let recording = UsedFile::new("the recording", &options.recording);
    check_outputs(&[UsedFile::painting(&path)], &[recording])?;
    if path.exists() {
        return Err(UserError::usage("this painting is there already")
            .at(path.display().to_string())
            .help("name one that is not: the session is painted there from its beginning"));
    }
    let member = options.join()?;
    let mut player = Player {
        options,
        session,
        member: &member,
        client: CommandClient::new(Arc::clone(&member.bus), &member.topics),
        rig: CommandClient::of(Arc::clone(&member.bus), &member.topics, RIG_NODE),
        number: 0,
        batch: 0,
        sent: Instant::now(),
    };
    let events = player.events()?;
    player.open(&path, &|| member.stop.requested())?;
    let mut playback = Playback::new(options, range_ns)?;
    let played = player.play(&mut playback, &path, events);
    let ended = player.end();
    let code = playback.end(&member);
    if !member.stop.requested() {
        played.and(ended)?;
    }
    if !options.json {
        say!("painted in {}", path.display());
    }
    member.leave();
    Ok(code)
}

/// `session-replay.maul` beside a recording, or the first further name that is not taken.
fn free_beside(recording: &Path) -> PathBuf {
    let stem = recording.file_stem().unwrap_or_default().to_string_lossy();
    let named = |number: u32| match number {
        1 => recording.with_file_name(format!("{stem}-replay.maul")),
        number => recording.with_file_name(format!("{stem}-replay-{number}.maul")),
    };
    first_free(1, named).1
}

/// Marks a painting as one in which nobody paints until its player comes.
fn hold(path: &Path) -> Result<(), UserError> {
    let (document, mut sequencer, since) = open_begin(path)?;
    let mut checkpoint = Checkpoint::of(&mut sequencer, since);
    checkpoint.sequencer.held = true;
    document.write_checkpoint(checkpoint);
    document.close().map_err(|error| wrong(path, &error))
}

/// What paints a session again.
struct Player<'a> {
    options: &'a ReplayOptions,
    session: &'a SessionFile,
    member: &'a NodeHandle,
    client: CommandClient,
    rig: CommandClient,
    /// Number of this playing, for the paint node.
    number: u64,
    /// Number of the next batch.
    batch: u64,
    /// When the paint node was told something last.
    sent: Instant,
}

impl Player<'_> {
    /// Plays until the end, or until it is told to end.
    fn play(
        &mut self,
        playback: &mut Playback,
        path: &Path,
        mut events: Events<Record>,
    ) -> Result<(), UserError> {
        let mut played_ns = 0;
        while !self.member.stop.requested() {
            let next_ns = events.next_ns()?;
            let turn = playback.turn(next_ns, played_ns)?;
            let has_ended = next_ns.is_none() && turn == Turn::On;
            let is_over = has_ended && (!self.options.again || playback.transport.is_over());
            if turn == Turn::Leap(Leap::Back) || (is_over && self.options.again) {
                if is_over {
                    playback.transport.rewind();
                }
                events = self.events()?;
                self.open_anew(path)?;
                played_ns = 0;
                continue;
            }
            if turn == Turn::End || is_over {
                break;
            }
            let mut batch = Vec::new();
            while batch.len() < BATCH
                && let Some(at_ns) = events.next_ns()?
                && playback.transport.is_due(at_ns)
            {
                played_ns = at_ns;
                batch.extend(events.take());
            }
            if !batch.is_empty() || self.sent.elapsed() > ALIVE {
                self.send(&batch)?;
            } else {
                self.member.wake.wait(TURN);
            }
        }
        Ok(())
    }

    /// What was accepted, as it comes, once the first of it has come: reading may take longer than the paint node waits.
    fn events(&self) -> Result<Events<Record>, UserError> {
        let mut session = self.session.clone();
        let to_ns = match self.options.end {
            Some(end_s) => (end_s * 1e9) as u64,
            None => u64::MAX,
        };
        let mut events = Events::read(move |feed| {
            let folder =
                tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
            let begin = folder.path().join(PAINTING);
            session.write_painting(&begin)?;
            let (document, mut sequencer, _) = open_begin(&begin)?;
            let recorded = RecordedSession::after(&sequencer);
            session.follow(recorded, &mut sequencer, to_ns, &mut |_, at_ns, event| {
                let is_wanted = match event {
                    Event::Accepted(record) => feed.push(at_ns, record),
                    Event::Other { .. } => true,
                };
                // Nobody hears why it ends early.
                match is_wanted {
                    true => Ok(()),
                    false => Err(UserError::failure("the player reads anew")),
                }
            })?;
            document.close().map_err(|error| wrong(&begin, &error))
        })?;
        events.next_ns()?;
        Ok(events)
    }

    /// Has the rig go on in the painting as it was at the beginning, and the hands wait.
    fn open(&mut self, path: &Path, stop: &dyn Fn() -> bool) -> Result<(), UserError> {
        self.tell("opens", path)?;
        self.go_on_in(path, self.options.painting.forget, stop)?;
        (self.number, self.batch) = (random_u64(), 0);
        self.command(SessionCommand::Begin {
            session: self.number,
        })?;
        self.tell("painting", path)
    }

    /// Says with `--json` which painting it opens, or has opened.
    fn tell(&self, what: &str, path: &Path) -> Result<(), UserError> {
        match self.options.json {
            true => print_json_line(&json!({what: path.display().to_string()})),
            false => Ok(()),
        }
    }

    fn go_on_in(
        &mut self,
        path: &Path,
        forget: bool,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), UserError> {
        self.session.write_painting(path)?;
        hold(path)?;
        let command = RigCommand::Open {
            path: whole(path)?,
            forget,
        };
        let opened = self.rig.send(command, None, LONGEST, stop);
        // Without an answer the rig may be about to open it.
        if opened
            .as_ref()
            .is_err_and(|fault| fault.code != EXIT_FAILURE)
        {
            std::fs::remove_file(path).ok();
        }
        opened.map(drop)
    }

    /// The same once more. A file cannot be written anew while it is open: the rig goes on in another one meanwhile.
    fn open_anew(&mut self, path: &Path) -> Result<(), UserError> {
        self.end()?;
        self.tell("opens", path)?;
        let failed = |error: std::io::Error| UserError::writing(path, &error);
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = tempfile::tempdir_in(folder.unwrap_or(Path::new("."))).map_err(failed)?;
        // While the rig may be in it, it stays.
        let folder = folder.keep();
        let never = || false;
        self.go_on_in(&folder.join(PAINTING), false, &never)?;
        std::fs::remove_file(path).map_err(failed)?;
        self.open(path, &never)?;
        std::fs::remove_dir_all(&folder).map_err(|error| UserError::writing(&folder, &error))
    }

    fn send(&mut self, batch: &[Record]) -> Result<(), UserError> {
        let records =
            journal::write(batch).map_err(|error| UserError::failure(error.to_string()))?;
        self.batch += 1;
        self.command(SessionCommand::Repeat {
            session: self.number,
            batch: self.batch - 1,
            records: ByteBuf::from(records),
        })
    }

    fn end(&mut self) -> Result<(), UserError> {
        self.command(SessionCommand::End {
            session: self.number,
        })
    }

    fn command(&mut self, command: SessionCommand) -> Result<(), UserError> {
        self.sent = Instant::now();
        let stop = &self.member.stop;
        self.client
            .send(command, None, PATIENCE, &|| stop.requested())
            .map(drop)
    }
}
