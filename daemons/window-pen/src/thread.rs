//! The thread that reads the pens of a window.

use std::os::fd::AsFd;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_rig::UserError;
use nix::sys::eventfd::{EfdFlags, EventFd};
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use crate::source::{Source, gone};
use crate::stylus::WindowStylus;
use crate::wayland::{WaylandPens, foreign_connection};
use crate::xinput::XinputPens;

/// The pens of the window of these handles.
///
/// # Errors
/// A [`UserError`] where its window system has none, with what to do.
///
/// # Safety
/// The handles are those of a living window, which outlives the pens.
#[expect(
    unsafe_code,
    reason = "a window's library hands out its connection as a pointer"
)]
pub unsafe fn pens_of(
    display: RawDisplayHandle,
    window: RawWindowHandle,
) -> Result<Box<dyn Source + Send>, UserError> {
    Ok(match (display, window) {
        (RawDisplayHandle::Wayland(display), RawWindowHandle::Wayland(window)) => {
            // SAFETY: as the caller promises.
            let connection = unsafe { foreign_connection(display) };
            let surface = window.surface.as_ptr() as usize;
            Box::new(WaylandPens::new(&connection, Some(surface))?)
        }
        (_, RawWindowHandle::Xcb(window)) => Box::new(XinputPens::new(window.window.get())?),
        (_, RawWindowHandle::Xlib(window)) => {
            Box::new(XinputPens::new(u32::try_from(window.window).unwrap_or(0))?)
        }
        _ => {
            let what = "pens of this window system are not supported";
            return Err(UserError::failure(what).help("run it on Wayland or X11"));
        }
    })
}

/// The pens of a window, read until this is dropped.
#[derive(Debug)]
pub struct PenThread {
    stop: Arc<EventFd>,
    thread: Option<JoinHandle<()>>,
}

impl PenThread {
    /// Reads the pens of a source.
    ///
    /// # Errors
    /// A [`UserError`] where the system refuses a thread.
    pub fn of(
        mut source: Box<dyn Source + Send>,
        mut stylus: WindowStylus,
    ) -> Result<Self, UserError> {
        let refused = |error: &dyn std::fmt::Display| {
            UserError::failure(format!("the window's pens cannot be read: {error}"))
        };
        let flags = EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK;
        let stop = EventFd::from_value_and_flags(0, flags).map_err(|error| refused(&error))?;
        let stop = Arc::new(stop);
        let stopped = Arc::clone(&stop);
        if !source.moves_pointer() {
            stylus.link().set_moves_no_pointer();
        }
        let run = move || {
            let fault = follow(&mut *source, &stopped, &mut stylus).err();
            if let Err(error) = stylus.end() {
                tracing::debug!("the pen is not lifted: {error}");
            }
            if let Some(fault) = fault {
                stylus.fail(&fault);
            }
        };
        let thread = std::thread::Builder::new()
            .name("pens".into())
            .spawn(run)
            .map_err(|error| refused(&error))?;
        Ok(Self {
            stop,
            thread: Some(thread),
        })
    }
}

/// Reads and sends until `stop` is set.
fn follow(
    source: &mut dyn Source,
    stop: &EventFd,
    stylus: &mut WindowStylus,
) -> Result<(), UserError> {
    let mut readings = Vec::new();
    while stop.read().is_err() {
        let timeout = stylus.due_in_ns().map(Duration::from_nanos);
        source.wait(stop.as_fd(), timeout, &mut readings)?;
        let sent = if readings.is_empty() {
            stylus.rest()
        } else {
            readings.drain(..).try_for_each(|read| stylus.read(&read))
        };
        sent.and_then(|()| stylus.serve())
            .map_err(|error| gone(&error))?;
    }
    Ok(())
}

impl Drop for PenThread {
    fn drop(&mut self) {
        if let Err(error) = self.stop.write(1) {
            tracing::debug!("the pens are not told to end: {error}");
        }
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}
