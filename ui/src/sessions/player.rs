//! The player: `maulstick recording replay`, a process beside the window.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use eframe::egui::Context;
use maulstick_ui_kit::notifications::Notifications;
use serde::Deserialize;

use crate::dialogs::paths;
use crate::rig::child_process::{ChildProcess, Ended, Refused};
use crate::rig::state::RigState;

/// Interval at which the end of the process is looked for.
const LOOK: Duration = Duration::from_millis(200);

/// A replay in progress.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ReplayProgress {
    /// The recording.
    pub recording: PathBuf,
    /// Where it is; `None` until the player has begun.
    pub position: Option<Position>,
    /// The painting in which a session is painted again; `None` if streams alone are sent.
    pub painting: Option<PathBuf>,
    /// True while the rig goes over to that painting: its nodes leave and come back.
    pub opens: bool,
}

/// Where a replay is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) struct Position {
    /// Time since the beginning of the recording, s.
    pub position_s: f64,
    /// Length of the recording, s.
    pub length_s: f64,
    /// Rate: a number (1 = real time), or `max`.
    pub rate: String,
    /// True while it stands still.
    pub paused: bool,
}

/// A line of `maulstick recording replay --json`.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum PlayerLine {
    Position(Position),
    Painting { painting: PathBuf },
    Opens { opens: PathBuf },
}

/// An order to the player.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TransportOrder {
    /// Stand still, or go on.
    Pause,
    /// Go on by one event, then stand still.
    Step,
    /// Go so far, s; back where it is negative.
    Skip(f64),
    /// Go to a time since the beginning, s.
    Seek(f64),
    /// Play at this rate: a number, or `max`.
    Rate(String),
    /// End.
    End,
}

impl fmt::Display for TransportOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pause => f.write_str("pause"),
            Self::Step => f.write_str("step"),
            Self::Skip(seconds) => write!(f, "skip {seconds}"),
            Self::Seek(seconds) => write!(f, "seek {seconds:.3}"),
            Self::Rate(rate) => write!(f, "rate {rate}"),
            Self::End => f.write_str("end"),
        }
    }
}

impl ReplayProgress {
    /// Of a recording that is about to be played.
    #[must_use]
    pub(crate) fn new(recording: &Path) -> Self {
        Self {
            recording: recording.to_owned(),
            position: None,
            painting: None,
            opens: false,
        }
    }

    /// Takes in a line; one that is no [`PlayerLine`] says nothing.
    fn read(&mut self, line: &str) {
        match serde_json::from_str(line) {
            Ok(PlayerLine::Position(position)) => self.position = Some(position),
            Ok(PlayerLine::Painting { painting }) => {
                (self.painting, self.opens) = (Some(painting), false);
            }
            Ok(PlayerLine::Opens { opens }) => {
                (self.painting, self.opens) = (Some(opens), true);
            }
            Err(_) => {}
        }
    }
}

/// The process.
#[derive(Debug)]
pub(crate) struct Player {
    child: ChildProcess,
}

impl Player {
    /// Plays a recording by `command`, which lacks it; `forget` lets a painting go that is in memory only.
    ///
    /// # Errors
    /// The system's, where the process cannot be started.
    pub(crate) fn start(
        context: &Context,
        mut command: Command,
        (recording, forget): (PathBuf, bool),
        rig: &mut RigState,
    ) -> std::io::Result<Self> {
        command.arg("--json").stdin(Stdio::piped());
        if forget {
            command.arg("--forget");
        }
        command.arg(&recording);
        let child = ChildProcess::start(context, command)?;
        rig.replay = Some(ReplayProgress::new(&recording));
        Ok(Self { child })
    }

    /// Sends an order; the slider stays where it was let go until the player says where it is.
    pub(crate) fn send(&mut self, order: TransportOrder, rig: &mut RigState) {
        self.child.send(&order.to_string());
        if let (TransportOrder::Seek(seconds), Some(replay)) = (order, &mut rig.replay)
            && let Some(position) = &mut replay.position
        {
            position.position_s = seconds;
        }
    }

    /// Takes in what the player says, and tells its end; true then.
    pub(crate) fn follow(
        &mut self,
        context: &Context,
        rig: &mut RigState,
        notifications: &mut Notifications,
    ) -> bool {
        let Some(replay) = &mut rig.replay else {
            return true;
        };
        self.child.lines().for_each(|line| replay.read(&line));
        let Some(Ended { lines, result }) = self.child.ended() else {
            context.request_repaint_after(LOOK);
            return false;
        };
        lines.iter().for_each(|line| replay.read(line));
        match (result, &replay.painting) {
            (Ok(()), Some(painting)) => {
                let file = paths::shown(painting);
                notifications.note(tr!("The recording is painted in {file}.", file));
            }
            (Ok(()), None) => {
                let name = paths::name(&replay.recording);
                notifications.note(tr!("{name} has been played.", name));
            }
            (Err(Refused { what, help }), _) if !what.is_empty() => notifications.fault(what, help),
            (Err(_), _) => notifications.fault(
                tr!("The player ended by itself"),
                tr!("Play the recording again."),
            ),
        }
        rig.replay = None;
        true
    }
}
