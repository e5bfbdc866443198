//! The painting as it is at the beginning of a recording, so that what is accepted from then on can be painted again.

use std::collections::BTreeMap;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use maulstick_document::{Checkpoint, record};
use maulstick_rig::UserError;
use maulstick_types::command::FileCommand;
use maulstick_types::decode;
use maulstick_types::paint::PaintStatus;

use super::on_the_way::{Brush, OnTheWay, Painted};
use super::voice::{RecorderNews, Voice};
use crate::commands::client::{Client, Target};
use crate::commands::open::{LONGEST, whole};
use crate::commands::streams::listener::ReceivedMessage;
use crate::commands::takes::from::open_begin;
use crate::commands::takes::session_file::PAINTING;
use crate::document::wrong;

/// Where the credit does not say it, brush states that are on their way at the beginning are painted after this time.
const SETTLES: Duration = Duration::from_millis(500);
/// A brush whose states are not painted by then has ended before them.
const LONGEST_LAG: Duration = Duration::from_secs(10);
/// Time until the paint node is asked again, where it refused.
const AGAIN: Duration = Duration::from_secs(2);
/// Topic of the paint's status, which has the painting's file.
const STATUS: &str = "paint/status";
/// Why a painting without a file is not copied, as the paint node says it.
const IN_MEMORY: &str = "a painting in memory only cannot be copied";
/// Interval at which a copy that is waited for is looked at.
const LOOK: Duration = Duration::from_millis(20);

/// Thread that makes a copy: the painting's file.
type Copying = JoinHandle<Result<Vec<u8>, UserError>>;

/// A copy of the painting, made by a thread of its own while the recording goes on.
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

    /// Takes in a message of the file. That the painting is in no file is said at once.
    ///
    /// # Errors
    /// A [`UserError`] where nothing can be said.
    pub(super) fn note(
        &mut self,
        received: &ReceivedMessage,
        voice: Voice,
    ) -> Result<(), UserError> {
        if self.copying.is_none() {
            self.on_the_way.note(received);
        }
        let is_homeless = received.topic == STATUS
            && !self.is_told
            && decode::<PaintStatus>(&received.bytes)
                .is_ok_and(|(_, status)| status.path.is_empty());
        match is_homeless {
            true => self.refused(IN_MEMORY, voice),
            false => Ok(()),
        }
    }

    /// Takes in that it was refused, which is said once.
    fn refused(&mut self, why: &str, voice: Voice) -> Result<(), UserError> {
        self.at = Instant::now() + AGAIN;
        self.is_refused = true;
        match std::mem::replace(&mut self.is_told, true) {
            true => Ok(()),
            false => voice.say(&RecorderNews::LacksPainting { why }),
        }
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

    /// The painting's file, once it is there. That it is refused is said once.
    ///
    /// # Errors
    /// A [`UserError`] where nothing can be said.
    pub(super) fn look(
        &mut self,
        target: &Target,
        voice: Voice,
    ) -> Result<Option<Vec<u8>>, UserError> {
        let Some(copying) = self.copying.take_if(|copying| copying.is_finished()) else {
            if self.copying.is_none() && self.is_due() {
                let target = target.clone();
                self.copying = Some(std::thread::spawn(move || copy(&target)));
            }
            return Ok(None);
        };
        let fault = match copying.join() {
            Ok(Ok(painting)) => return Ok(Some(painting)),
            Ok(Err(fault)) => fault.what,
            Err(_) => "internal error: the copy panicked".into(),
        };
        self.refused(&fault, voice)?;
        Ok(None)
    }

    /// True while it is being made.
    pub(super) fn is_made(&self) -> bool {
        self.copying.is_some()
    }

    /// Waits for a copy that is being made, unless it comes to nothing.
    pub(super) fn wait(self, is_gone: &dyn Fn() -> bool) -> Option<Vec<u8>> {
        let copying = self.copying?;
        while !copying.is_finished() {
            if is_gone() {
                return None;
            }
            // Nothing signals that the rig has gone, so both are looked at.
            std::thread::sleep(LOOK);
        }
        copying.join().ok()?.ok()
    }
}

/// A copy of the painting as it is now, without the record of what was painted before.
fn copy(target: &Target) -> Result<Vec<u8>, UserError> {
    let failed = |error: std::io::Error| UserError::failure(error.to_string());
    let folder = tempfile::tempdir().map_err(failed)?;
    let copy = folder.path().join(PAINTING);
    let command = FileCommand::Copy {
        path: whole(&copy)?,
    };
    Client::open(target)?.send_within(command, LONGEST)?;
    // What its journal holds is of this version: another one could not read it.
    let (document, mut sequencer, since) = open_begin(&copy)?;
    document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    document.close().map_err(|error| wrong(&copy, &error))?;
    record::discard(&copy).map_err(|error| wrong(&copy, &error))?;
    std::fs::read(&copy).map_err(|error| UserError::reading(&copy, &error))
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn a_copy_waits_for_the_end_of_one_that_is_of_no_use_any_more() {
        let (end, ended) = channel::<()>();
        let mut copy = PaintingCopy::new(None, BTreeMap::new());
        copy.is_told = true;
        copy.copying = Some(std::thread::spawn(move || {
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
        let runs = |former: &Copying| !former.is_finished();
        while copy.former.as_ref().is_some_and(runs) {
            std::thread::yield_now();
        }
        assert!(copy.is_due());
    }
}
