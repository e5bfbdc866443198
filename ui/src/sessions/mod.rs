//! Sessions: recorded and played by tasks beside the window.
//!
//! | module | content |
//! | --- | --- |
//! | [`recorder`], [`player`] | start and end of a recording and of a replay |
//! | [`cut_off`] | recordings that ended early |
//! | [`progress`] | where they are |
//! | [`recording_mark`] | the red dot while a recording is written |
//! | [`transport_bar`] | the bar and the keys while one is played |

mod cut_off;
pub(crate) mod player;
pub(crate) mod progress;
pub(crate) mod recorder;
pub(crate) mod recording_mark;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod transport_bar;

use std::path::PathBuf;
use std::time::Duration;

use eframe::egui::Context;
use maulstick_recorder::{Order, Player, Recorder, RecorderError, ReplaySettings, TakePlace};
use maulstick_ui_kit::notifications::Notifications;
use tokio::runtime::{Builder, Runtime};
use tokio::time::timeout;

use crate::dialogs::paths;
use crate::rig::state::RigState;
use crate::sessions::cut_off::CutOffRecordings;

/// File ending of a recording.
pub(crate) const RECORDING: &str = "mcap";
/// Name of the device whose strokes those of a motion are.
const MOTION: &str = "motion";
/// Threads of recorder and player.
const THREADS: usize = 2;
/// Longest wait for the end of a recording or a replay when the window ends.
const LONGEST_END: Duration = Duration::from_millis(400);

/// A request to recorder or player.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionOrder {
    /// Records the session from now on.
    Record,
    StopRecording,
    Play {
        recording: PathBuf,
        /// True if the painting on the easel may go, although it is in memory only.
        forget: bool,
    },
    /// Plays a take with its middle at a place of the desk.
    PutDown {
        take: PathBuf,
        /// The place, mm from the middle of the desk.
        at_mm: [f64; 2],
        /// Factor on its lengths.
        scale: f64,
        /// Turn, counter-clockwise, degrees.
        turn_deg: f64,
    },
    /// An order to what plays.
    Transport(Order),
}

/// Recorder and player, on threads of their own from the first order on.
#[derive(Debug, Default)]
pub(crate) struct Sessions {
    runtime: Option<Runtime>,
    recorder: Option<Recorder>,
    player: Option<Player>,
    cut_off: CutOffRecordings,
}

impl Sessions {
    /// Carries out orders, and takes what recorder and player report.
    pub(crate) fn poll(
        &mut self,
        context: &Context,
        orders: Vec<SessionOrder>,
        (rig, notifications): (&mut RigState, &mut Notifications),
    ) {
        self.cut_off
            .poll(context, &recorder::painting(rig), notifications);
        if let Some(recorder) = &mut self.recorder
            && recorder::poll(recorder, context, rig, notifications)
        {
            self.recorder = None;
        }
        if let Some(player) = &mut self.player
            && player::poll(player, context, rig, notifications)
        {
            self.player = None;
        }
        // What begins now is shown for a frame, even if it ends at once.
        for order in orders {
            if let Err(error) = self.carry_out(order, rig, notifications) {
                notifications.fault(
                    tr!("Recorder and player cannot be started: {error}", error),
                    tr!("Start the rig again."),
                );
            }
        }
    }

    fn carry_out(
        &mut self,
        order: SessionOrder,
        rig: &mut RigState,
        notifications: &mut Notifications,
    ) -> std::io::Result<()> {
        let is_playing = self.player.is_some();
        match order {
            SessionOrder::Play {
                recording: file, ..
            }
            | SessionOrder::PutDown { take: file, .. }
                if is_playing =>
            {
                let name = paths::name(&file);
                notifications.fault(
                    tr!("{name} is not played: another replay is in progress.", name),
                    tr!("End that one first."),
                );
            }
            SessionOrder::Record if self.recorder.is_none() => {
                self.recorder = Some(recorder::start(self.runtime()?, rig));
            }
            SessionOrder::StopRecording => self.recorder.iter().for_each(Recorder::stop),
            SessionOrder::Play { recording, forget } => {
                let settings = ReplaySettings {
                    forget,
                    ..ReplaySettings::new(recording)
                };
                self.play(settings, rig)?;
            }
            SessionOrder::PutDown {
                take,
                at_mm,
                scale,
                turn_deg,
            } => self.play(put_down(take, at_mm, scale, turn_deg), rig)?,
            SessionOrder::Transport(order) => {
                if let Some(player) = &self.player {
                    player::send(player, order, rig);
                }
            }
            SessionOrder::Record => {}
        }
        Ok(())
    }

    fn play(&mut self, settings: ReplaySettings, rig: &mut RigState) -> std::io::Result<()> {
        self.player = Some(player::start(self.runtime()?, settings, rig));
        Ok(())
    }

    /// Ends both: the file gets its index, without which it would have to be salvaged, and hands that play are lifted.
    pub(crate) fn end(&mut self) {
        let Some(runtime) = self.runtime.take() else {
            return;
        };
        let (recorder, player) = (self.recorder.take(), self.player.take());
        recorder.iter().for_each(Recorder::stop_now);
        player.iter().for_each(Player::stop);
        runtime.block_on(async {
            if let Some(recorder) = recorder {
                ended("recording", recorder.ended()).await;
            }
            if let Some(player) = player {
                ended("replay", player.ended()).await;
            }
        });
        runtime.shutdown_background();
    }

    fn runtime(&mut self) -> std::io::Result<&Runtime> {
        let runtime = match self.runtime.take() {
            Some(runtime) => runtime,
            None => Builder::new_multi_thread()
                .worker_threads(THREADS)
                .thread_name("sessions")
                .enable_all()
                .build()?,
        };
        Ok(self.runtime.insert(runtime))
    }
}

impl Drop for Sessions {
    fn drop(&mut self) {
        self.end();
    }
}

/// Waits for an end, not longer than the launcher does.
async fn ended(what: &str, end: impl Future<Output = Result<(), RecorderError>>) {
    match timeout(LONGEST_END, end).await {
        Ok(Ok(())) => {}
        Ok(Err(fault)) => tracing::warn!("the {what}: {fault}"),
        Err(_) => tracing::warn!("the {what} does not end"),
    }
}

/// Settings that put a take down under a name of its own: the stylus that it was recorded of may be in the rig.
fn put_down(take: PathBuf, at_mm: [f64; 2], scale: f64, turn_deg: f64) -> ReplaySettings {
    ReplaySettings {
        device: Some(MOTION.to_owned()),
        place: Some(TakePlace {
            at_mm: Some(at_mm),
            scale: Some(scale),
            turn_deg: Some(turn_deg),
            head_m: None,
        }),
        ..ReplaySettings::new(take)
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
