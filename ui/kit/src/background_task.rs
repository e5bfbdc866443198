//! Work on a thread, which the window polls and never waits for.

use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::task::Poll;
use std::time::Instant;

use eframe::egui::Context;

use crate::language;

/// Work in progress. Its result is dropped with it.
#[derive(Debug)]
pub struct BackgroundTask<T> {
    found: Receiver<T>,
}

impl<T: Send + 'static> BackgroundTask<T> {
    /// Begins work; the window of `context` is redrawn when it is done.
    #[must_use]
    pub fn start(context: &Context, name: &str, work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (to_window, found) = channel();
        let context = context.clone();
        let language = language::chosen();
        let run = move || {
            language::adopt(language);
            // The window may have dropped the task already.
            to_window.send(work()).ok();
            context.request_repaint();
        };
        let thread = std::thread::Builder::new().name(name.into()).spawn(run);
        if let Err(error) = thread {
            tracing::error!("no thread for {name}: {error}");
        }
        Self { found }
    }

    /// The result, returned once; `None` inside if the thread panicked.
    pub fn poll(&self) -> Poll<Option<T>> {
        match self.found.try_recv() {
            Ok(found) => Poll::Ready(Some(found)),
            Err(TryRecvError::Empty) => Poll::Pending,
            Err(TryRecvError::Disconnected) => Poll::Ready(None),
        }
    }

    /// Waits for its end, not beyond `until`; true if it has ended. For a window that ends.
    #[must_use]
    pub fn wait(self, until: Instant) -> bool {
        let left = until.saturating_duration_since(Instant::now());
        !matches!(
            self.found.recv_timeout(left),
            Err(RecvTimeoutError::Timeout)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ended<T: Send + 'static>(task: &BackgroundTask<T>) -> Option<T> {
        loop {
            match task.poll() {
                Poll::Ready(found) => return found,
                Poll::Pending => std::thread::yield_now(),
            }
        }
    }

    #[test]
    fn what_is_found_comes_once_and_a_fall_is_told() {
        let context = Context::default();
        let task = BackgroundTask::start(&context, "sum", || 2 + 2);
        assert_eq!(ended(&task), Some(4));
        assert_eq!(ended(&task), None);
        let fell = BackgroundTask::start(&context, "fall", || -> u8 { panic!("a damaged file") });
        assert_eq!(ended(&fell), None);
    }
}
