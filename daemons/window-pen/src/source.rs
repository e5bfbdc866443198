//! Pens of a window system, whichever it is.

use std::os::fd::BorrowedFd;
use std::time::Duration;

use maulstick_rig::UserError;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};

use crate::reading::PenReading;

/// Pens of a window system.
pub trait Source {
    /// Waits until the window system has something to say, `stop` does, or the time is over, and appends the readings
    /// that came.
    ///
    /// # Errors
    /// A [`UserError`] where the connection is gone.
    fn wait(
        &mut self,
        stop: BorrowedFd<'_>,
        timeout: Option<Duration>,
        readings: &mut Vec<PenReading>,
    ) -> Result<(), UserError>;

    /// True where the window system moves the pointer with a pen.
    fn moves_pointer(&self) -> bool;
}

/// Waits until one of two descriptors can be read, or the time is over; true if the first can.
pub(crate) fn readable(
    own: BorrowedFd<'_>,
    stop: BorrowedFd<'_>,
    timeout: Option<Duration>,
) -> Result<bool, UserError> {
    let mut both = [own, stop].map(|fd| PollFd::new(fd, PollFlags::POLLIN));
    let timeout = timeout.map_or(PollTimeout::NONE, |timeout| {
        // A time that is not over is not waited for in a loop.
        let ms =
            timeout.as_millis() + u128::from(!timeout.subsec_nanos().is_multiple_of(1_000_000));
        PollTimeout::try_from(ms).unwrap_or(PollTimeout::MAX)
    });
    match poll(&mut both, timeout) {
        Ok(_) => Ok(both[0].any().unwrap_or(false)),
        Err(Errno::EINTR) => Ok(false),
        Err(error) => Err(gone(&error)),
    }
}

/// The connection to the window system is gone.
pub(crate) fn gone(why: &dyn std::fmt::Display) -> UserError {
    UserError::failure(format!("the window's pens are lost: {why}"))
        .help("close the window and open it again")
}
