//! A thread that a node cannot do without.

use std::thread::{Builder, JoinHandle};

/// A thread of a node: whoever owns the node looks whether it still runs.
#[derive(Debug)]
pub struct Worker {
    name: &'static str,
    handle: Option<JoinHandle<()>>,
}

/// The thread fell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the thread '{name}' has ended by a fault of its own")]
pub struct WorkerPanicked {
    name: &'static str,
}

impl Worker {
    /// Starts `work` on a thread of its own.
    ///
    /// # Errors
    /// The system's error if it gives no thread.
    pub fn start(
        name: &'static str,
        work: impl FnOnce() + Send + 'static,
    ) -> std::io::Result<Self> {
        let handle = Builder::new().name(name.to_owned()).spawn(work)?;
        Ok(Self {
            name,
            handle: Some(handle),
        })
    }

    /// Checks that it still works, or has ended as it was asked to.
    ///
    /// # Errors
    /// [`WorkerPanicked`] if it panicked.
    pub fn check(&mut self) -> Result<(), WorkerPanicked> {
        match self.handle.take_if(|handle| handle.is_finished()) {
            Some(handle) => handle
                .join()
                .map_err(|_| WorkerPanicked { name: self.name }),
            None => Ok(()),
        }
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// [`WorkerPanicked`] where it panicked.
    pub fn join(mut self) -> Result<(), WorkerPanicked> {
        match self.handle.take() {
            Some(handle) => handle
                .join()
                .map_err(|_| WorkerPanicked { name: self.name }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    #[allow(clippy::panic, reason = "the fault that is seeded")]
    fn a_fallen_thread_is_told_apart_from_one_that_ended() {
        let (go, wait) = channel::<()>();
        let mut working = Worker::start("works", move || {
            wait.recv().ok();
        })
        .expect("a thread");
        assert_eq!(working.check(), Ok(()));
        drop(go);
        assert_eq!(working.join(), Ok(()));
        let fallen = Worker::start("falls", || panic!("as seeded")).expect("a thread");
        assert_eq!(fallen.join(), Err(WorkerPanicked { name: "falls" }));
    }

    #[test]
    #[allow(clippy::panic, reason = "the fault that is seeded")]
    fn a_look_is_enough_to_see_that_a_thread_fell() {
        let mut fallen = Worker::start("falls", || panic!("as seeded")).expect("a thread");
        while fallen
            .handle
            .as_ref()
            .is_some_and(|handle| !handle.is_finished())
        {
            std::thread::yield_now();
        }
        assert_eq!(fallen.check(), Err(WorkerPanicked { name: "falls" }));
    }
}
