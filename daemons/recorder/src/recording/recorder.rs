//! Settings of a recorder, and the handle of one at work.

use std::time::Duration;

use maulstick_rig::UserError;
use maulstick_rig::pulse::Pulse;
use tokio::runtime::Handle;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

use super::event::RecorderEvent;
use super::ring::{FILES, Ring};
use super::task::Recording;
use crate::listener::Listener;
use crate::work::{StopRequest, Work};

/// Shortest time of which the newest files are kept: each needs time for its painting.
pub const LEAST_LAST: Duration = Duration::from_secs(10);
/// Number of files in a quota.
const QUOTA_FILES: u64 = 8;
/// Longest wait at the end for a copy of a painting, of which the last records may have to be done again.
const LONGEST_COPY: Duration = Duration::from_secs(3600);

/// Division of a recording into files, and which of them are kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct Division {
    /// Most bytes of a file's messages, before they are compressed.
    pub most_bytes: Option<u64>,
    /// Longest time of a file.
    pub after: Option<Duration>,
    /// Time of which the newest files are kept.
    pub last: Option<Duration>,
    /// Most bytes of all files.
    pub quota_bytes: Option<u64>,
}

impl Division {
    pub(super) fn most_of_a_file(&self) -> Option<u64> {
        let of_quota = self.quota_bytes.map(|quota| quota / QUOTA_FILES);
        self.most_bytes.into_iter().chain(of_quota).min()
    }

    pub(super) fn time_of_a_file(&self) -> Option<Duration> {
        self.after.or(self.last.map(|last| last / FILES))
    }
}

/// Settings of a recorder.
#[derive(Clone, Debug)]
pub struct RecorderSettings {
    /// Topics, as a pattern.
    pub topic: String,
    /// Length of the recording, if it has an end of its own.
    pub length: Option<Duration>,
    /// Its files.
    pub division: Division,
    /// Most messages a second of each topic that are written as JSON too; 0 for none.
    pub json_hz: u32,
    /// Longest wait at the end for a copy of the painting that is being made.
    pub longest_wait: Duration,
}

impl Default for RecorderSettings {
    fn default() -> Self {
        Self {
            topic: "**".to_owned(),
            length: None,
            division: Division::default(),
            json_hz: 20,
            longest_wait: LONGEST_COPY,
        }
    }
}

/// A recorder at work. Dropped, it is asked to stop, and nobody waits for the end of its file.
#[derive(Debug)]
pub struct Recorder {
    /// What happens to the recording.
    pub events: UnboundedReceiver<RecorderEvent>,
    work: Work,
}

impl Recorder {
    /// Joins a rig and records it, until it is stopped, the time is over, or the rig ends.
    #[must_use]
    pub fn start(runtime: &Handle, rig: &str, settings: RecorderSettings, ring: Ring) -> Self {
        let (request, rig) = (StopRequest::default(), rig.to_owned());
        let (to_owner, events) = unbounded_channel();
        let stopped = request.clone();
        let work = async move {
            let member = stopped.join(&rig, "listener")?;
            let listener = Listener::over(member, &settings.topic)?;
            Recording::record(settings, ring, listener, None, to_owner).await
        };
        let work = Work::begin(runtime, request, work);
        Self { events, work }
    }

    /// Records as a member of a rig, whose stop flag stops it; `pulse` tells the launcher that it goes on.
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
        let work = Recording::record(settings, ring, listener, Some(pulse), to_owner);
        let work = Work::begin(runtime, request, work);
        Self { events, work }
    }

    /// Asks it to stop: the file is finished.
    pub fn stop(&self) {
        self.work.stop();
    }

    /// Its result, once it has ended; then its last events are there too. `None` afterwards.
    pub fn result(&mut self) -> Option<Result<(), UserError>> {
        self.work.result()
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// A [`UserError`] where no rig runs, or a file cannot be written: what was written until then can be read.
    pub async fn ended(self) -> Result<(), UserError> {
        self.work.await
    }
}
