//! A session is painted again in a running rig: in a painting of its own, which is as it was at the session's beginning, what
//! was accepted then is accepted again in the same order.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_document::journal;
use maulstick_painting::sequencer::Record;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_types::command::{RigCommand, SessionCommand};
use serde_bytes::ByteBuf;
use serde_json::json;

use super::events::Events;
use super::transport::Leap;
use super::{Deck, ReplayOptions, TURN, Turn, print_json};
use crate::commands::open::{LONGEST, whole};
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
        client: CommandClient::new(Arc::clone(&member.bus), &member.topics),
        rig: CommandClient::of(Arc::clone(&member.bus), &member.topics, "rig"),
        sent: Instant::now(),
    };
    player.open(&member, &path)?;
    let mut events = events(&options.recording, range_ns[1])?;
    let mut deck = Deck::new(options, range_ns)?;
    let mut turns = 0;
    while !member.stop.requested() {
        let next_ns = events.next_ns()?;
        match deck.turn(next_ns)? {
            Turn::End => break,
            Turn::Leap(Leap::Back) => {
                turns += 1;
                player.open_anew(&member, &path, turns)?;
                events = self::events(&options.recording, range_ns[1])?;
                continue;
            }
            // What is between is painted as fast as can be.
            Turn::On | Turn::Leap(_) => {}
        }
        let mut batch = Vec::new();
        while batch.len() < BATCH
            && let Some(at_ns) = events.next_ns()?
            && deck.transport.is_due(at_ns)
        {
            batch.extend(events.take());
        }
        if !batch.is_empty() || player.sent.elapsed() > ALIVE {
            player.send(&member, &batch)?;
            continue;
        }
        match events.next_ns()? {
            Some(_) => {
                member.wake.wait(TURN);
            }
            None if options.again => {
                deck.transport.rewind();
                turns += 1;
                player.open_anew(&member, &path, turns)?;
                events = self::events(&options.recording, range_ns[1])?;
            }
            None => break,
        }
    }
    player.command(&member, SessionCommand::End)?;
    if !options.json {
        say!("painted in {}", player.place(&path, turns).display());
    }
    let code = deck.end(&member);
    member.leave();
    Ok(code)
}

/// What was accepted, as it comes.
fn events(path: &Path, to_ns: u64) -> Result<Events<Record>, UserError> {
    let path = path.to_owned();
    Events::read(move |feed| {
        let Some(mut session) = SessionFile::open(&path)? else {
            return Ok(());
        };
        let folder = tempfile::tempdir().map_err(|error| UserError::failure(error.to_string()))?;
        let begin = folder.path().join(PAINTING);
        session.write_painting(&begin)?;
        let (document, mut sequencer, _) = open_begin(&begin)?;
        let mut wanted = true;
        session.follow(&mut sequencer, to_ns, &mut |_, at_ns, event| {
            if let Event::Accepted(record) = event {
                wanted = wanted && feed.push(at_ns, record);
            }
            Ok(())
        })?;
        document.close().map_err(|error| wrong(&begin, &error))
    })
}

/// `session-replay.maul` beside a recording, or the first further name that is not taken.
fn free_beside(recording: &Path) -> PathBuf {
    let stem = recording.file_stem().unwrap_or_default().to_string_lossy();
    let names = (1..).map(|number| match number {
        1 => recording.with_file_name(format!("{stem}-replay.maul")),
        number => recording.with_file_name(format!("{stem}-replay-{number}.maul")),
    });
    names
        .into_iter()
        .find(|path: &PathBuf| !path.exists())
        .unwrap_or_default()
}

struct Player<'a> {
    options: &'a ReplayOptions,
    session: &'a SessionFile,
    client: CommandClient,
    rig: CommandClient,
    /// When the paint node was told something last.
    sent: Instant,
}

impl Player<'_> {
    /// Has the rig go on in the painting as it was at the beginning.
    fn open(&mut self, member: &NodeHandle, path: &Path) -> Result<(), UserError> {
        self.session.write_painting(path)?;
        let command = RigCommand::Open {
            path: whole(path)?,
            forget: self.options.painting.forget,
        };
        let opened = self
            .rig
            .send(command, None, LONGEST, &|| member.stop.requested());
        if opened.is_err() {
            std::fs::remove_file(path).ok();
        }
        opened?;
        match self.options.json {
            true => print_json(&json!({"painting": path.display().to_string()})),
            false => Ok(()),
        }
    }

    /// The painting in which it is painted after so many returns to the beginning.
    fn place(&self, path: &Path, turns: u32) -> PathBuf {
        match turns % 2 {
            0 => path.to_owned(),
            _ => path.with_extension("again.maul"),
        }
    }

    /// The same once more, in the place of the painting that was painted until now.
    fn open_anew(&mut self, member: &NodeHandle, path: &Path, turns: u32) -> Result<(), UserError> {
        self.command(member, SessionCommand::End)?;
        self.open(member, &self.place(path, turns))?;
        let before = self.place(path, turns + 1);
        std::fs::remove_file(&before).map_err(|error| UserError::writing(&before, &error))
    }

    fn send(&mut self, member: &NodeHandle, batch: &[Record]) -> Result<(), UserError> {
        let records =
            journal::write(batch).map_err(|error| UserError::failure(error.to_string()))?;
        self.command(
            member,
            SessionCommand::Repeat {
                records: ByteBuf::from(records),
            },
        )
    }

    fn command(&mut self, member: &NodeHandle, command: SessionCommand) -> Result<(), UserError> {
        self.sent = Instant::now();
        let is_over = || member.stop.requested();
        self.client
            .send(command, None, PATIENCE, &is_over)
            .map(drop)
    }
}
