//! Events of a recording in the order of time, read ahead beside the player.

use tokio::sync::mpsc::{Receiver, Sender, channel};
use tokio::task::spawn_blocking;

use crate::error::RecorderError;

/// Events that are read ahead.
const AHEAD: usize = 1024;

/// An event and its time since the beginning, ns; the end of the file, or why it could not be read.
type Item<T> = Result<Option<(u64, T)>, RecorderError>;

/// Events that are still to come.
#[derive(Debug)]
pub(super) struct Events<T> {
    items: Receiver<Item<T>>,
    /// The next one, looked at and not yet taken.
    next: Option<(u64, T)>,
    has_ended: bool,
}

/// Takes events for [`Events`].
pub(super) struct Feed<T>(Sender<Item<T>>);

impl<T> Feed<T> {
    /// Hands on an event; false once nobody wants more.
    pub(super) fn push(&self, at_ns: u64, what: T) -> bool {
        self.0.blocking_send(Ok(Some((at_ns, what)))).is_ok()
    }
}

impl<T: Send + 'static> Events<T> {
    /// Reads them with `read`, which may wait for the disk.
    pub(super) fn read(
        read: impl FnOnce(&Feed<T>) -> Result<(), RecorderError> + Send + 'static,
    ) -> Self {
        let (send, items) = channel(AHEAD);
        spawn_blocking(move || {
            let feed = Feed(send);
            let end = read(&feed).map(|()| None);
            // The player may have gone back, and reads anew.
            feed.0.blocking_send(end).ok();
        });
        Self {
            items,
            next: None,
            has_ended: false,
        }
    }

    /// Time of the next event, ns; `None` at the end.
    ///
    /// # Errors
    /// A [`RecorderError`] where the recording cannot be read.
    pub(super) async fn next_ns(&mut self) -> Result<Option<u64>, RecorderError> {
        if self.next.is_none() && !self.has_ended {
            self.next = self.items.recv().await.unwrap_or(Ok(None))?;
            self.has_ended = self.next.is_none();
        }
        Ok(self.next.as_ref().map(|(at_ns, _)| *at_ns))
    }

    /// The next event, after [`next_ns`](Self::next_ns).
    pub(super) fn take(&mut self) -> Option<T> {
        self.next.take().map(|(_, what)| what)
    }
}
