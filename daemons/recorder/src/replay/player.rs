//! The handle of a player at work.

use maulstick_streams::Recording;
use tokio::runtime::Handle;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::playback::Controls;
use super::report::ReplayReport;
use super::settings::{Call, ReplaySettings};
use super::transport::Order;
use super::{guide, session, streams};
use crate::error::RecorderError;
use crate::session_file::{PAINTING, SessionFile};
use crate::work::blocking;
use crate::work::{StopRequest, Work};

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
    pub fn result(&mut self) -> Option<Result<(), RecorderError>> {
        self.work.result()
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// A [`RecorderError`] where no rig runs, the recording lacks something, or the rig refuses it.
    pub async fn ended(self) -> Result<(), RecorderError> {
        self.work.await
    }
}

async fn play(call: Call, controls: Controls) -> Result<(), RecorderError> {
    let settings = &call.settings;
    if let Some(own) = &settings.guide {
        return guide::guide(&call, own, controls).await;
    }
    let path = settings.recording.clone();
    let recording = blocking(move || Ok(Recording::open(&path)?)).await?;
    let holds_painting = recording.attachments().contains_key(PAINTING);
    if !settings.sends()
        && holds_painting
        && let Some(session) = SessionFile::of(recording.clone())?
    {
        return session::replay(&call, &session, controls).await;
    }
    streams::replay(&call, &recording, controls).await
}
