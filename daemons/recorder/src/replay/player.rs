//! Settings of a player, and the handle of one at work.

use std::collections::BTreeMap;
use std::path::PathBuf;

use maulstick_device::player::Rate;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_streams::Recording;
use tokio::runtime::Handle;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::place::TakePlace;
use super::playback::Controls;
use super::transport::Order;
use super::{guide, session, streams};
use crate::session_file::{PAINTING, SessionFile};
use crate::work::{StopRequest, Work};

/// Settings of a player.
#[derive(Clone, Debug)]
pub struct ReplaySettings {
    /// Recording, or take.
    pub recording: PathBuf,
    /// Rate.
    pub rate: Rate,
    /// Beginning of what is played, s after that of the recording.
    pub start_s: f64,
    /// End of what is played, s after the beginning of the recording; `None` plays to its end.
    pub end_s: Option<f64>,
    /// True if it begins anew at the end.
    pub repeats: bool,
    /// True if it begins paused.
    pub paused: bool,
    /// Patterns of the topics whose messages are sent again; where there are none a session is painted again, and of any
    /// other recording the samples of the hands are sent.
    pub topics: Vec<String>,
    /// Topics that are sent under another name, by the recorded one.
    pub renamed: BTreeMap<String, String>,
    /// Device as which samples of a stylus are sent.
    pub device: Option<String>,
    /// Device whose hand the recorded contact models move.
    pub drive: Option<String>,
    /// Guidance of a hand along the recorded strokes; nothing is played then.
    pub guide: Option<GuideSettings>,
    /// Place of a take on the desk; `None` leaves it where it was.
    pub place: Option<TakePlace>,
    /// Painting to write, in which a session is painted again; `None` names it after the recording.
    pub document: Option<PathBuf>,
    /// True if the current painting may go although it is in memory only.
    pub forget: bool,
}

/// Guidance of a hand.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideSettings {
    /// Device that the hand holds.
    pub device: String,
    /// Strength, 0 to 1.
    pub strength: f64,
}

impl ReplaySettings {
    /// Settings that play all of a recording, or a take, at the pace at which it was recorded.
    #[must_use]
    pub fn new(recording: impl Into<PathBuf>) -> Self {
        Self {
            recording: recording.into(),
            rate: Rate::Times(1.0),
            start_s: 0.0,
            end_s: None,
            repeats: false,
            paused: false,
            topics: Vec::new(),
            renamed: BTreeMap::new(),
            device: None,
            drive: None,
            guide: None,
            place: None,
            document: None,
            forget: false,
        }
    }

    /// Beginning and end of what is played of a recording of this length, ns.
    pub(super) fn range_ns(&self, length_ns: u64) -> Result<[u64; 2], UserError> {
        let length_s = length_ns as f64 * 1e-9;
        let end_s = self.end_s.unwrap_or(length_s);
        let start_s = self.start_s;
        if !(start_s >= 0.0 && start_s < end_s && start_s < length_s) {
            let what = format!("the start at {start_s} s is not before the end");
            return Err(UserError::usage(what)
                .at(self.place())
                .help(format!("it is {length_s:.1} s long")));
        }
        Ok([
            (start_s * 1e9) as u64,
            ((end_s * 1e9) as u64).min(length_ns),
        ])
    }

    /// The recording, as errors name it.
    pub(super) fn place(&self) -> String {
        self.recording.display().to_string()
    }

    /// True if messages are sent again, whatever the recording holds.
    fn sends(&self) -> bool {
        !self.topics.is_empty()
            || self.device.is_some()
            || self.drive.is_some()
            || self.place.is_some()
    }
}

/// Report of a player.
#[derive(Clone, Debug, PartialEq)]
pub enum ReplayReport {
    /// Where it is, five times a second and after each order.
    Position(Position),
    /// How far a guided hand has come, as often.
    Guiding(Guiding),
    /// The rig goes over to the painting in which a session is painted again.
    Opening {
        /// Its file.
        painting: PathBuf,
    },
    /// The rig has gone over to it.
    Painting {
        /// Its file.
        painting: PathBuf,
    },
}

/// Position of a player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Time since the beginning of the recording, s.
    pub position_s: f64,
    /// Its length, or the end of what is played, s.
    pub length_s: f64,
    /// Rate.
    pub rate: Rate,
    /// True while it stands still.
    pub paused: bool,
}

/// Progress of a guided hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guiding {
    /// When the recorded hand was where the hand is now, s; `None` between strokes.
    pub position_s: Option<f64>,
    /// Number of strokes.
    pub strokes: usize,
    /// Number of strokes that are traced.
    pub traced: usize,
    /// Strength, 0 to 1.
    pub strength: f64,
    /// True while the hand is let go.
    pub paused: bool,
}

/// A player at work. Dropped, it is asked to stop, and nobody waits for its end.
#[derive(Debug)]
pub struct Player {
    /// Reports as they come.
    pub events: UnboundedReceiver<ReplayReport>,
    orders: UnboundedSender<Order>,
    work: Work,
}

impl Player {
    /// Joins a rig and plays a recording into it.
    #[must_use]
    pub fn start(runtime: &Handle, rig: &str, settings: ReplaySettings) -> Self {
        let request = StopRequest::default();
        let (orders, from_owner) = unbounded_channel();
        let (to_owner, events) = unbounded_channel();
        let call = Call {
            settings,
            rig: rig.to_owned(),
            request: request.clone(),
        };
        let controls = Controls::new(from_owner, to_owner);
        let work = Work::begin(runtime, request, play(call, controls));
        Self {
            events,
            orders,
            work,
        }
    }

    /// Gives an order; a player that has ended takes none.
    pub fn order(&self, order: Order) {
        self.orders.send(order).ok();
    }

    /// Asks it to stop.
    pub fn stop(&self) {
        self.work.stop();
    }

    /// Its result, once it has ended; then its last reports are there too. `None` afterwards.
    pub fn result(&mut self) -> Option<Result<(), UserError>> {
        self.work.result()
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// A [`UserError`] where no rig runs, the recording lacks something, or the rig refuses it.
    pub async fn ended(self) -> Result<(), UserError> {
        self.work.await
    }
}

/// What a player was asked for.
pub(super) struct Call {
    pub(super) settings: ReplaySettings,
    rig: String,
    request: StopRequest,
}

impl Call {
    /// Joins the rig.
    pub(super) fn join(&self) -> Result<NodeHandle, UserError> {
        self.request.clone().join(&self.rig, "replay")
    }
}

async fn play(call: Call, controls: Controls) -> Result<(), UserError> {
    let settings = &call.settings;
    if let Some(own) = &settings.guide {
        return guide::guide(&call, own, controls).await;
    }
    let recording = Recording::open(&settings.recording)?;
    let holds_painting = recording.attachments().contains_key(PAINTING);
    if !settings.sends()
        && holds_painting
        && let Some(session) = SessionFile::of(recording.clone())?
    {
        return session::replay(&call, &session, controls).await;
    }
    streams::replay(&call, &recording, controls).await
}
