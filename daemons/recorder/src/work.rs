//! Recorder or player at work on a runtime: its end, and the request for it.

use std::path::Path;
use std::pin::Pin;
use std::sync::atomic::{AtomicU32, Ordering};
use std::task::{Context, Poll};

use maulstick_bus::{RigFolder, Wake};
use maulstick_rig::{NodeHandle, Stop};
use tokio::runtime::Handle;
use tokio::sync::oneshot::{Receiver, channel, error::TryRecvError};
use tokio::task::spawn_blocking;

use crate::error::RecorderError;

/// Request that work stop: the flag, and the wake-up of who looks at it.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopRequest {
    pub(crate) stop: Stop,
    pub(crate) wake: Wake,
}

impl StopRequest {
    fn make(&self) {
        self.stop.request();
        self.wake.ring();
    }

    /// Joins a rig as a guest that this request stops; `kind` is the beginning of its name.
    pub(crate) fn join(self, rig: &str, kind: &str) -> Result<NodeHandle, RecorderError> {
        let (folder, _) = RigFolder::join(rig)?;
        let mut member = NodeHandle::guest(folder.path(), &guest_name(kind))?;
        (member.stop, member.wake) = (self.stop, self.wake);
        Ok(member)
    }
}

/// A name that no other guest of this machine has.
fn guest_name(kind: &str) -> String {
    static GUESTS: AtomicU32 = AtomicU32::new(0);
    let number = GUESTS.fetch_add(1, Ordering::Relaxed);
    format!("{kind}-{}-{number}", std::process::id())
}

/// Runs on a thread of the runtime for what waits for a disk.
pub(crate) async fn blocking<T: Send + 'static>(
    run: impl FnOnce() -> Result<T, RecorderError> + Send + 'static,
) -> Result<T, RecorderError> {
    let ended = spawn_blocking(run).await;
    ended.unwrap_or(Err(RecorderError::Panicked("the reader")))
}

/// Work in progress. Dropped, it is asked to stop, and nobody waits for it.
#[derive(Debug)]
pub(crate) struct Work {
    request: StopRequest,
    result: Receiver<Result<(), RecorderError>>,
}

impl Work {
    /// Begins it.
    pub(crate) fn begin(
        runtime: &Handle,
        request: StopRequest,
        work: impl Future<Output = Result<(), RecorderError>> + Send + 'static,
    ) -> Self {
        let (send, result) = channel();
        runtime.spawn(async move { send.send(work.await).ok() });
        Self { request, result }
    }

    /// Asks it to stop.
    pub(crate) fn stop(&self) {
        self.request.make();
    }

    /// Its result, once: `None` while it goes on, and after the result was taken.
    pub(crate) fn result(&mut self) -> Option<Result<(), RecorderError>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Closed) if self.result.is_terminated() => None,
            Err(TryRecvError::Closed) => Some(Err(RecorderError::Panicked("the task"))),
        }
    }
}

impl Future for Work {
    type Output = Result<(), RecorderError>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let result = Pin::new(&mut self.result).poll(context);
        result.map(|result| result.unwrap_or(Err(RecorderError::Panicked("the task"))))
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        self.stop();
    }
}

/// True while the rig of a folder runs.
pub(crate) fn has_rig(folder: &Path) -> bool {
    RigFolder::join_at(folder).is_ok()
}
