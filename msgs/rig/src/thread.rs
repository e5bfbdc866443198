//! Threads by their names.

use std::thread::{Builder, JoinHandle};

use crate::user_error::UserError;

/// Starts a thread.
///
/// # Errors
/// A [`UserError`] where the system refuses it.
pub fn start<T: Send + 'static>(
    name: &str,
    run: impl FnOnce() -> T + Send + 'static,
) -> Result<JoinHandle<T>, UserError> {
    let started = Builder::new().name(name.to_owned()).spawn(run);
    started.map_err(|error| {
        UserError::failure(format!("cannot start the thread '{name}': {error}"))
            .help("the machine may have too many threads: end other programs")
    })
}

/// Starts a thread without which a program goes on; the log says if the system refuses it.
pub fn try_start<T: Send + 'static>(
    name: &str,
    run: impl FnOnce() -> T + Send + 'static,
) -> Option<JoinHandle<T>> {
    start(name, run)
        .inspect_err(|error| tracing::error!("{}", error.what))
        .ok()
}
