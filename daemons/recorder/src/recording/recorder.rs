//! The handle of a recorder at work.

use std::sync::Arc;

use maulstick_rig::pulse::Pulse;
use tokio::runtime::Handle;
use tokio::sync::Notify;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

use super::event::RecorderEvent;
use super::ring::Ring;
use super::settings::RecorderSettings;
use super::task::Recording;
use crate::error::RecorderError;
use crate::listener::Listener;
use crate::work::{StopRequest, Work};

/// A recorder at work. Dropped, it is asked to stop, and nobody waits for the end of its file.
#[derive(Debug)]
pub struct Recorder {
    /// Events of the recording.
    pub events: UnboundedReceiver<RecorderEvent>,
    work: Work,
    /// Ends the wait for a copy of the painting.
    hurry: Arc<Notify>,
}

impl Recorder {
    /// Joins a rig and records it, until it is stopped, the time is over, or the rig ends.
    #[must_use]
    pub fn start(runtime: &Handle, rig: &str, settings: RecorderSettings, ring: Ring) -> Self {
        let (request, rig) = (StopRequest::default(), rig.to_owned());
        let (to_owner, events) = unbounded_channel();
        let (stopped, hurry) = (request.clone(), Arc::default());
        let hurried = Arc::clone(&hurry);
        let work = async move {
            let member = stopped.join(&rig, "listener")?;
            let listener = Listener::over(member, &settings.topic)?;
            Recording::record((settings, hurried), ring, listener, None, to_owner).await
        };
        let work = Work::begin(runtime, request, work);
        Self {
            events,
            work,
            hurry,
        }
    }

    /// Records as a member of a rig, whose stop flag stops it; `pulse` reports progress to the launcher.
    #[must_use]
    pub fn over(
        runtime: &Handle,
        listener: Listener,
        pulse: Pulse,
        settings: RecorderSettings,
        ring: Ring,
    ) -> Self {
        let (to_owner, events) = unbounded_channel();
        let request = StopRequest {
            stop: listener.member.stop.clone(),
            wake: listener.member.wake.clone(),
        };
        let hurry = Arc::default();
        let settings = (settings, Arc::clone(&hurry));
        let work = Recording::record(settings, ring, listener, Some(pulse), to_owner);
        let work = Work::begin(runtime, request, work);
        Self {
            events,
            work,
            hurry,
        }
    }

    /// Asks it to stop: the file is finished.
    pub fn stop(&self) {
        self.work.stop();
    }

    /// Asks it to stop without the painting, if its copy is not there yet: for a process that ends.
    pub fn stop_now(&self) {
        self.hurry.notify_one();
        self.stop();
    }

    /// Its result, once it has ended; then its last events are there too. `None` afterwards.
    pub fn result(&mut self) -> Option<Result<(), RecorderError>> {
        self.work.result()
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// A [`RecorderError`] where no rig runs, or a file cannot be written: what was written until then can be read.
    pub async fn ended(self) -> Result<(), RecorderError> {
        self.work.await
    }
}
