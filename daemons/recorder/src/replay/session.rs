//! A session is painted again in a running rig: in a painting of its own, which is as it was at the session's beginning, what
//! was accepted then is accepted again in the same order.

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::typed::random_u64;
use maulstick_document::journal;
use maulstick_painting::sequencer::Record;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_session::RecordedSession;
use maulstick_types::command::SessionCommand;
use serde_bytes::ByteBuf;
use tokio::task::block_in_place;
use tokio::time::Instant;

use super::events::Events;
use super::playback::{Controls, Leap, Next, Playback};
use super::report::ReplayReport;
use super::session_painting::{SessionPainting, free_name};
use super::settings::{Call, ReplaySettings};
use crate::error::RecorderError;
use crate::paintings::{open_begin, wrong};
use crate::session_file::{Event, PAINTING, SessionFile};

/// Records that the paint node accepts at once: in between it serves the window.
const BATCH: usize = 16;
/// Time after which the paint node hears from a player that has nothing to paint.
const ALIVE: Duration = Duration::from_secs(2);
/// Longest wait for the paint node.
const PATIENCE: Duration = Duration::from_secs(60);

/// Paints a session again.
///
/// # Errors
/// A [`RecorderError`] where the rig does not open its painting, or refuses a record.
pub(super) async fn replay(
    call: &Call,
    session: &SessionFile,
    controls: Controls,
) -> Result<(), RecorderError> {
    let settings = &call.settings;
    let range_ns = settings.range_ns(session.length_ns())?;
    let path = free_name(settings.document.as_deref(), &settings.recording)?;
    let member = block_in_place(|| call.join())?;
    let playback = Playback::new(settings, range_ns, controls);
    let done = paint(settings, session, (playback, path), &member).await;
    block_in_place(|| member.leave());
    done
}

/// Paints as a member of the rig.
async fn paint(
    settings: &ReplaySettings,
    session: &SessionFile,
    (mut playback, path): (Playback, PathBuf),
    member: &NodeHandle,
) -> Result<(), RecorderError> {
    let mut painter = SessionPainter {
        settings,
        session,
        member,
        client: CommandClient::new(Arc::clone(&member.bus), &member.topics),
        painting: SessionPainting::new(path, member),
        number: None,
        batch: 0,
        sent: Instant::now(),
    };
    let events = painter.events().await?;
    let opened = block_in_place(|| painter.open(&mut playback.controls));
    if opened.is_err() && is_ended(member, &mut playback.controls) {
        return Ok(());
    }
    opened?;
    let played = painter.play(&mut playback, events).await;
    let ended = block_in_place(|| painter.end());
    if is_ended(member, &mut playback.controls) {
        return Ok(());
    }
    played.and(ended)
}

/// True once the owner of the player, or the rig, has it end.
fn is_ended(member: &NodeHandle, controls: &mut Controls) -> bool {
    member.stop.requested() || controls.is_end_ordered()
}

/// Painter of a session.
struct SessionPainter<'a> {
    settings: &'a ReplaySettings,
    session: &'a SessionFile,
    member: &'a NodeHandle,
    client: CommandClient,
    painting: SessionPainting,
    /// Number of this playing, for the paint node; `None` while its painting is not open.
    number: Option<u64>,
    /// Number of the next batch.
    batch: u64,
    /// Time of the newest command to the paint node.
    sent: Instant,
}

impl SessionPainter<'_> {
    /// Plays until the end, or until it is asked to stop.
    async fn play(
        &mut self,
        playback: &mut Playback,
        mut events: Events<Record>,
    ) -> Result<(), RecorderError> {
        let mut played_ns = 0;
        while !self.member.stop.requested() {
            let next_ns = events.next_ns().await?;
            let next = playback.follow(next_ns, played_ns);
            let has_ended = next_ns.is_none() && next == Next::On;
            let repeats = self.settings.repeats;
            let is_over = has_ended && (!repeats || playback.transport.is_over());
            if next == Next::Leap(Leap::Back) || (is_over && repeats) {
                if is_over {
                    playback.transport.rewind();
                }
                events = self.events().await?;
                block_in_place(|| self.open_anew(&mut playback.controls))?;
                played_ns = 0;
                continue;
            }
            if next == Next::End || is_over {
                break;
            }
            let mut batch = Vec::new();
            while batch.len() < BATCH
                && let Some(at_ns) = events.next_ns().await?
                && playback.transport.is_due(at_ns)
            {
                played_ns = at_ns;
                batch.extend(events.take());
            }
            if !batch.is_empty() || self.sent.elapsed() > ALIVE {
                block_in_place(|| self.send(&batch))?;
            } else {
                playback.wait(next_ns, &self.member.wake, ALIVE).await;
            }
        }
        Ok(())
    }

    /// Records that were accepted, once the first of them has come: reading may take longer than the paint node waits.
    async fn events(&self) -> Result<Events<Record>, RecorderError> {
        let mut session = self.session.clone();
        let end_s = self.settings.end_s;
        let to_ns = end_s.map_or(u64::MAX, |end_s| (end_s * 1e9) as u64);
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
                // Nobody learns why it ends early.
                if is_wanted {
                    Ok(())
                } else {
                    Err(RecorderError::ReadsAnew.into())
                }
            })?;
            Ok(document.close().map_err(|error| wrong(&begin, &error))?)
        });
        events.next_ns().await?;
        Ok(events)
    }

    /// Has the rig go on in the painting as it was at the beginning, and the hands wait.
    fn open(&mut self, controls: &mut Controls) -> Result<(), RecorderError> {
        self.report(controls, |painting| ReplayReport::Opening { painting });
        let (member, ordered) = (self.member, RefCell::new(&mut *controls));
        let stop = || is_ended(member, &mut ordered.borrow_mut());
        self.painting
            .open(self.session, self.settings.forget, &stop)?;
        self.begin(controls)
    }

    /// The same once more.
    fn open_anew(&mut self, controls: &mut Controls) -> Result<(), RecorderError> {
        self.end()?;
        self.report(controls, |painting| ReplayReport::Opening { painting });
        let (member, ordered) = (self.member, RefCell::new(&mut *controls));
        let stop = || is_ended(member, &mut ordered.borrow_mut());
        self.painting
            .open_anew(self.session, self.settings.forget, &stop)?;
        self.begin(controls)
    }

    fn begin(&mut self, controls: &Controls) -> Result<(), RecorderError> {
        let session = random_u64();
        (self.number, self.batch) = (Some(session), 0);
        self.command(SessionCommand::Begin { session })?;
        self.report(controls, |painting| ReplayReport::Painting { painting });
        Ok(())
    }

    fn report(&self, controls: &Controls, report: fn(PathBuf) -> ReplayReport) {
        controls.report(report(self.painting.path.clone()));
    }

    fn send(&mut self, batch: &[Record]) -> Result<(), RecorderError> {
        let records =
            journal::write(batch).map_err(|error| UserError::failure(error.to_string()))?;
        self.batch += 1;
        let Some(session) = self.number else {
            return Ok(());
        };
        self.command(SessionCommand::Repeat {
            session,
            batch: self.batch - 1,
            records: ByteBuf::from(records),
        })
    }

    fn end(&mut self) -> Result<(), RecorderError> {
        let session = self.number.take();
        session.map_or(Ok(()), |session| {
            self.command(SessionCommand::End { session })
        })
    }

    fn command(&mut self, command: SessionCommand) -> Result<(), RecorderError> {
        self.sent = Instant::now();
        let stop = &self.member.stop;
        self.client
            .send(command, None, PATIENCE, &|| stop.requested())?;
        Ok(())
    }
}
