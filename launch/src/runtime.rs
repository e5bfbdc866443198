//! The runtime of a command that waits for many things at once, and the signals that end it.

use maulstick_rig::UserError;
use nix::sys::signal::Signal;
use tokio::runtime::Builder;
use tokio::signal::unix::{SignalKind, signal};

use crate::EXIT_INTERRUPTED;

/// Threads of a runtime: one may write a file while the other waits.
const WORKERS: usize = 2;

/// Runs a command to its end and abandons its background work.
///
/// # Errors
/// That of the command, or a [`UserError`] where no thread can be started.
pub fn block_on<T>(command: impl Future<Output = Result<T, UserError>>) -> Result<T, UserError> {
    // Zenoh blocks in place, which a runtime of one thread does not allow.
    let runtime = Builder::new_multi_thread()
        .worker_threads(WORKERS)
        .enable_all()
        .build()
        .map_err(system)?;
    let result = runtime.block_on(command);
    runtime.shutdown_background();
    result
}

/// Signals that ask a process to end: Ctrl-C, SIGTERM, and a closed terminal.
#[derive(Debug)]
pub struct EndSignals {
    interrupt: tokio::signal::unix::Signal,
    terminate: tokio::signal::unix::Signal,
    hang_up: tokio::signal::unix::Signal,
}

impl EndSignals {
    /// Watches for them, within a runtime.
    ///
    /// # Errors
    /// A [`UserError`] where the system does not allow it.
    pub fn watch() -> Result<Self, UserError> {
        let watch = |kind| signal(kind).map_err(system);
        Ok(Self {
            interrupt: watch(SignalKind::interrupt())?,
            terminate: watch(SignalKind::terminate())?,
            hang_up: watch(SignalKind::hangup())?,
        })
    }

    /// The next one. Dropped before it comes, it loses none.
    pub async fn next(&mut self) -> Signal {
        tokio::select! {
            _ = self.interrupt.recv() => Signal::SIGINT,
            _ = self.terminate.recv() => Signal::SIGTERM,
            _ = self.hang_up.recv() => Signal::SIGHUP,
        }
    }
}

/// Exit code of a process that ended because of a signal.
#[must_use]
pub fn exit_code(signal: Signal) -> i32 {
    match signal {
        Signal::SIGINT => EXIT_INTERRUPTED,
        other => 128 + other as i32,
    }
}

fn system(error: std::io::Error) -> UserError {
    UserError::failure(error.to_string())
}
