//! The painting in which a session is painted again: as it was at the session's beginning.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use maulstick_document::Checkpoint;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::files::{Kind, check_writable, first_free, is_companion};
use maulstick_rig::user_error::EXIT_FAILURE;
use maulstick_rig::{NodeHandle, UserError, whole_path};
use maulstick_types::command::{RIG_NODE, RigCommand};

use crate::error::RecorderError;
use crate::paintings::{open_begin, wrong};
use crate::session_file::{PAINTING, SessionFile};

/// Longest wait for a painting to be open: its last journal records may have to be done again.
const LONGEST: Duration = Duration::from_secs(3600);

/// A name for it that is free and can be written; without `chosen` that of the recording with `-replay` behind it.
///
/// # Errors
/// A [`RecorderError`] where the chosen name is taken, or cannot be written.
pub(super) fn free_name(chosen: Option<&Path>, recording: &Path) -> Result<PathBuf, RecorderError> {
    let path = chosen.map_or_else(|| free_beside(recording), Path::to_owned);
    if is_companion(&path) {
        return Err(RecorderError::CompanionName(path));
    }
    check_writable(&path, Kind::Own).map_err(|error| UserError::writing(&path, &error))?;
    if path.exists() {
        return Err(RecorderError::Exists(path));
    }
    Ok(path)
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
fn hold(path: &Path) -> Result<(), RecorderError> {
    let (document, mut sequencer, since) = open_begin(path)?;
    let mut checkpoint = Checkpoint::of(&mut sequencer, since);
    checkpoint.sequencer.held = true;
    document.write_checkpoint(checkpoint);
    Ok(document.close().map_err(|error| wrong(path, &error))?)
}

/// The painting of a replay.
pub(super) struct SessionPainting {
    /// Its file.
    pub(super) path: PathBuf,
    rig: CommandClient,
}

impl SessionPainting {
    pub(super) fn new(path: PathBuf, member: &NodeHandle) -> Self {
        let rig = CommandClient::of(Arc::clone(&member.bus), &member.topics, RIG_NODE);
        Self { path, rig }
    }

    /// Has the rig go on in it as it was at the beginning; the painting before may go where it is `forget`.
    pub(super) fn open(
        &mut self,
        session: &SessionFile,
        forget: bool,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), RecorderError> {
        go_on_in(&mut self.rig, session, (&self.path, forget), stop)
    }

    /// The same once more. A file cannot be written anew while it is open: the rig goes on in another one meanwhile.
    pub(super) fn open_anew(
        &mut self,
        session: &SessionFile,
        forget: bool,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), RecorderError> {
        let failed = |error: std::io::Error| UserError::writing(&self.path, &error);
        let folder = self.path.parent();
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
        let folder = tempfile::tempdir_in(folder.unwrap_or(Path::new("."))).map_err(failed)?;
        // While the rig may be in it, it stays.
        let folder = folder.keep();
        let between = folder.join(PAINTING);
        go_on_in(&mut self.rig, session, (&between, false), stop)?;
        std::fs::remove_file(&self.path).map_err(failed)?;
        self.open(session, forget, stop)?;
        std::fs::remove_dir_all(&folder).map_err(|error| UserError::writing(&folder, &error))?;
        Ok(())
    }
}

fn go_on_in(
    rig: &mut CommandClient,
    session: &SessionFile,
    (path, forget): (&Path, bool),
    stop: &dyn Fn() -> bool,
) -> Result<(), RecorderError> {
    session.write_painting(path)?;
    hold(path)?;
    let command = RigCommand::Open {
        path: whole_path(path)?,
        forget,
    };
    let opened = rig.send(command, None, LONGEST, stop);
    // Without an answer the rig may be about to open it.
    if opened
        .as_ref()
        .is_err_and(|fault| fault.code != EXIT_FAILURE)
    {
        std::fs::remove_file(path).ok();
    }
    Ok(opened.map(drop)?)
}
