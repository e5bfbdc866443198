//! Sessions: recorded and played by processes that the window starts, as a user at a terminal would.
//!
//! | module | holds |
//! | --- | --- |
//! | [`recorder`] | `maulstick recording record` |
//! | [`player`] | `maulstick recording replay` |
//! | [`recording_mark`] | the red dot while a recording is written |
//! | [`transport_bar`] | the bar and the keys while one is played |

pub(crate) mod player;
pub(crate) mod recorder;
pub(crate) mod recording_mark;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod transport_bar;

use std::path::PathBuf;
use std::process::{Command, Stdio};

use eframe::egui::Context;
use maulstick_rig::program::{command, own_program};

use crate::rig::state::RigState;
use crate::sessions::player::{Player, TransportOrder};
use crate::sessions::recorder::Recorder;
use maulstick_ui_kit::notifications::Notifications;

/// File ending of a recording.
pub(crate) const RECORDING: &str = "mcap";
/// Name of the device whose strokes those of a motion are.
const MOTION: &str = "motion";

/// A request to recorder or player.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionOrder {
    /// Records the session from now on.
    Record,
    /// Ends the recording.
    StopRecording,
    /// Plays a recording.
    Play {
        /// Its file.
        recording: PathBuf,
        /// True if the painting on the easel may go, although it is in memory only.
        forget: bool,
    },
    /// Plays a take with its middle at a place of the desk.
    PutDown {
        /// Its file.
        take: PathBuf,
        /// The place, mm from the middle of the desk.
        at_mm: [f64; 2],
        /// Factor on its lengths.
        scale: f64,
        /// Turn, counter-clockwise, degrees.
        turn_deg: f64,
    },
    /// An order to what plays.
    Transport(TransportOrder),
}

/// The processes of recorder and player.
#[derive(Debug)]
pub(crate) struct SessionProcesses {
    program: PathBuf,
    recorder: Option<Recorder>,
    player: Option<Player>,
}

impl SessionProcesses {
    /// Runs `program`.
    pub(crate) fn new(program: PathBuf) -> Self {
        Self {
            program,
            recorder: None,
            player: None,
        }
    }

    /// Runs the program of this process.
    pub(crate) fn own() -> Self {
        Self::new(own_program())
    }

    /// Carries out orders, and takes in what the processes say.
    pub(crate) fn poll(
        &mut self,
        context: &Context,
        orders: Vec<SessionOrder>,
        (rig, notifications): (&mut RigState, &mut Notifications),
    ) {
        for order in orders {
            let begun = match order {
                SessionOrder::Record if self.recorder.is_none() => {
                    let command = self.command(["recording", "record"], rig);
                    Recorder::start(context, command, rig)
                        .map(|recorder| self.recorder = Some(recorder))
                }
                SessionOrder::Play { recording, forget } if self.player.is_none() => {
                    let command = self.command(["recording", "replay"], rig);
                    Player::start(context, command, (recording, forget), rig)
                        .map(|player| self.player = Some(player))
                }
                SessionOrder::PutDown {
                    take,
                    at_mm: [x, y],
                    scale,
                    turn_deg,
                } if self.player.is_none() => {
                    let mut command = self.command(["recording", "replay"], rig);
                    // Under a name of its own: the stylus that it was recorded of may be in the rig.
                    command.args(["--as", MOTION, "--at", &format!("{x:.4},{y:.4}")]);
                    command.args(["--scale", &format!("{scale:.6}")]);
                    command.args(["--turn", &format!("{turn_deg:.4}")]);
                    Player::start(context, command, (take, false), rig)
                        .map(|player| self.player = Some(player))
                }
                SessionOrder::StopRecording => {
                    self.recorder.iter().for_each(Recorder::stop);
                    Ok(())
                }
                SessionOrder::Transport(order) => {
                    if let Some(player) = &mut self.player {
                        player.send(order, rig);
                    }
                    Ok(())
                }
                SessionOrder::Record | SessionOrder::Play { .. } | SessionOrder::PutDown { .. } => {
                    Ok(())
                }
            };
            if let Err(error) = begun {
                notifications.fault(
                    tr!("maulstick cannot be started: {error}", error),
                    tr!("Start the rig again."),
                );
            }
        }
        if let Some(recorder) = &mut self.recorder
            && recorder.follow(context, rig, notifications)
        {
            self.recorder = None;
        }
        if let Some(player) = &mut self.player
            && player.follow(context, rig, notifications)
        {
            self.player = None;
        }
    }

    fn command(&self, words: [&str; 2], rig: &RigState) -> Command {
        let mut command = command(&self.program);
        command.args(words).args(["--name", &rig.live.name]);
        command.stdin(Stdio::null());
        command
    }
}

/// A time as clocks of players show it: minutes and seconds, with hours where there are any.
#[must_use]
pub(crate) fn clock(seconds: f64) -> String {
    let whole = seconds.max(0.0) as u64;
    let [hours, minutes, seconds] = [whole / 3600, whole / 60 % 60, whole % 60];
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}
