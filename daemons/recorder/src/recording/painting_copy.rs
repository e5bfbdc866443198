//! The painting as it is at the beginning of a recording, so that what is accepted from then on can be painted again.

use std::collections::BTreeMap;
use std::future::pending;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use maulstick_document::{Checkpoint, record};
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::{NodeHandle, UserError, whole_path};
use maulstick_types::command::FileCommand;
use maulstick_types::decode;
use maulstick_types::paint::PaintStatus;
use tokio::task::{JoinHandle, spawn_blocking};
use tokio::time::Instant;

use super::event::CopyTrouble;
use super::on_the_way::{Brush, OnTheWay, Painted};
use crate::error::RecorderError;
use crate::listener::ReceivedMessage;
use crate::paintings::{open_begin, wrong};
use crate::session_file::PAINTING;
use crate::work::has_rig;

/// Where the credit does not say it, brush states that are on their way at the beginning are painted after this time.
const SETTLES: Duration = Duration::from_millis(500);
/// A brush whose states are not painted by then has ended before them.
const LONGEST_LAG: Duration = Duration::from_secs(10);
/// Time until the paint node is asked again, where it refused.
const AGAIN: Duration = Duration::from_secs(2);
/// Longest wait for the paint node.
const PATIENCE: Duration = Duration::from_secs(3600);
/// Topic of the paint's status, which has the painting's file.
const STATUS: &str = "paint/status";

/// Task that makes a copy: the painting's file.
type Copying = JoinHandle<Result<Vec<u8>, RecorderError>>;

/// A copy of the painting, made beside the recording.
#[derive(Debug)]
pub(super) struct PaintingCopy {
    /// When the paint node is asked at the latest, unless states are known to be on their way.
    at: Instant,
    on_the_way: OnTheWay,
    copying: Option<Copying>,
    /// A copy that is of no use any more. The paint node makes one at a time, so the next waits for its end.
    former: Option<Copying>,
    /// True once it was refused.
    is_refused: bool,
    /// True once that was said.
    is_told: bool,
}

impl PaintingCopy {
    /// A copy for a file that begins now, in the place of the copy `before`, with the brushes of whose states some are not
    /// painted.
    pub(super) fn new(before: Option<Self>, unpainted: BTreeMap<Brush, u64>) -> Self {
        let (former, is_told) = match before {
            Some(before) => (before.copying.or(before.former), before.is_told),
            None => (None, false),
        };
        Self {
            at: Instant::now() + SETTLES,
            on_the_way: OnTheWay::after(unpainted),
            copying: None,
            former,
            is_refused: false,
            is_told,
        }
    }

    /// Adds a message of the file; returned is a trouble that was not said yet.
    pub(super) fn note(&mut self, received: &ReceivedMessage) -> Option<CopyTrouble> {
        if self.copying.is_none() {
            self.on_the_way.note(received);
        }
        let is_homeless = received.topic == STATUS
            && !self.is_told
            && decode::<PaintStatus>(&received.bytes)
                .is_ok_and(|(_, status)| status.path.is_empty());
        if is_homeless {
            self.refused(CopyTrouble::InMemory)
        } else {
            None
        }
    }

    /// Notes a refusal; returns the trouble where none was reported yet.
    pub(super) fn refused(&mut self, trouble: CopyTrouble) -> Option<CopyTrouble> {
        self.at = Instant::now() + AGAIN;
        self.is_refused = true;
        let was_told = std::mem::replace(&mut self.is_told, true);
        (!was_told).then_some(trouble)
    }

    /// True if the painting has all that was sent before the file, and no other copy is being made.
    fn is_due(&self) -> bool {
        let is_first = self.former.as_ref().is_none_or(JoinHandle::is_finished);
        is_first && self.is_painted()
    }

    /// True if the painting has all that was sent before the file.
    fn is_painted(&self) -> bool {
        match self.on_the_way.painted() {
            Painted::No => Instant::now() >= self.at + LONGEST_LAG,
            Painted::Yes if !self.is_refused => true,
            Painted::Yes | Painted::Unknown => Instant::now() >= self.at,
        }
    }

    /// Asks the paint node for it once it may be made.
    pub(super) fn begin_if_due(&mut self, member: &NodeHandle) {
        if self.copying.is_none() && self.is_due() {
            let client = CommandClient::new(Arc::clone(&member.bus), &member.topics);
            let rig = member.folder.clone();
            self.copying = Some(spawn_blocking(move || copy(client, &rig)));
        }
    }

    /// Waits for the end of the copy that is being made: for ever where none is. Dropped before that, it loses nothing.
    pub(super) async fn made(copy: &mut Option<Self>) -> Result<Vec<u8>, RecorderError> {
        let Some(own) = copy else {
            return pending().await;
        };
        let Some(copying) = &mut own.copying else {
            return pending().await;
        };
        let made = copying.await;
        own.copying = None;
        made.unwrap_or(Err(RecorderError::Panicked("the copy")))
    }

    /// True while it is being made.
    pub(super) fn is_made(&self) -> bool {
        self.copying.is_some()
    }
}

/// A copy of the painting as it is now, without the record of what was painted before.
fn copy(mut client: CommandClient, rig: &Path) -> Result<Vec<u8>, RecorderError> {
    let failed = |error: std::io::Error| UserError::failure(error.to_string());
    let folder = tempfile::tempdir().map_err(failed)?;
    let copy = folder.path().join(PAINTING);
    let command = FileCommand::Copy {
        path: whole_path(&copy)?,
    };
    client.send(command, None, PATIENCE, &|| !has_rig(rig))?;
    // What its journal holds is of this version: another one could not read it.
    let (document, mut sequencer, since) = open_begin(&copy)?;
    document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    document.close().map_err(|error| wrong(&copy, &error))?;
    record::discard(&copy).map_err(|error| wrong(&copy, &error))?;
    Ok(std::fs::read(&copy).map_err(|error| UserError::reading(&copy, &error))?)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[tokio::test]
    async fn a_copy_waits_for_the_end_of_one_that_is_of_no_use_any_more() {
        let (end, ended) = channel::<()>();
        let mut copy = PaintingCopy::new(None, BTreeMap::new());
        copy.is_told = true;
        copy.copying = Some(spawn_blocking(move || {
            ended.recv().ok();
            Ok(Vec::new())
        }));
        // A second gap may come before the first copy has ended.
        for _ in 0..2 {
            copy = PaintingCopy::new(Some(copy), BTreeMap::new());
            copy.at = Instant::now();
            assert!(copy.is_painted() && !copy.is_due() && !copy.is_made());
            assert!(copy.is_told);
        }
        drop(end);
        let former = copy.former.as_mut().expect("the first one");
        former.await.expect("it ends").expect("copied");
        assert!(copy.is_due());
    }
}
