//! Handshake with a WoodenHaptics or Polhem stylus: it confirms the device, and finds the length of its lines.
//!
//! A lone newline is no command to the firmware and is answered all the same, so it is a safe question; the devices'
//! own host repeats it each 100 ms, and so do we. Then a command of no force must be answered by a pose: lines of 63
//! bytes first, which both published firmwares take, then lines of 64 bytes.

use glam::DVec3;
use nix::errno::Errno;

use super::frame::{Answer, Length, Line, Lines, PROBE, ParsedLine};
use super::link::Wire;

/// Waits for an answer, ms.
const PATIENCE_MS: u32 = 100;
/// Number of probes.
const PROBES: usize = 5;
/// Tries of a line of either length.
const TRIES: usize = 3;
/// Time without a byte after which the line is quiet, ms.
const QUIET_MS: u32 = 5;
/// Bytes of unreadable input that are kept.
const KEPT: usize = 40;

/// The reason why the device at the other end cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HandshakeError {
    /// It says nothing.
    Silent,
    /// It says what no such device says; how that begins.
    Foreign(String),
    /// It sends encoders, but no positions.
    NoPoses,
    /// The wire is broken.
    Broken(Errno),
}

/// Wakes the device; `wait` lets a millisecond pass. Returns how long its lines are to be.
///
/// # Errors
/// A [`HandshakeError`] after a second at most.
pub fn handshake(wire: &mut dyn Wire, wait: &mut dyn FnMut()) -> Result<Length, HandshakeError> {
    let mut listener = Listener::default();
    let mut is_awake = false;
    for _ in 0..PROBES {
        let answer = listener.ask(wire, PROBE, wait)?;
        is_awake = answer.is_some();
        if is_awake {
            break;
        }
    }
    if !is_awake {
        return Err(if listener.foreign.is_empty() {
            HandshakeError::Silent
        } else {
            HandshakeError::Foreign(String::from_utf8_lossy(&listener.foreign).into_owned())
        });
    }
    for length in [Length::Short, Length::Long] {
        for _ in 0..TRIES {
            listener.hush(wire, wait)?;
            let line = Line::force(DVec3::ZERO, length);
            if let Some(Answer::Pose(_)) = listener.ask(wire, line.as_bytes(), wait)? {
                listener.hush(wire, wait)?;
                return Ok(length);
            }
        }
    }
    Err(HandshakeError::NoPoses)
}

/// Input of the handshake.
#[derive(Default)]
struct Listener {
    lines: Lines,
    /// Beginning of the unreadable input.
    foreign: Vec<u8>,
}

impl Listener {
    /// Sends a line, and waits for an answer.
    fn ask(
        &mut self,
        wire: &mut dyn Wire,
        line: &[u8],
        wait: &mut dyn FnMut(),
    ) -> Result<Option<Answer>, HandshakeError> {
        match wire.write(line) {
            Ok(_) | Err(Errno::EAGAIN | Errno::EINTR) => {}
            Err(errno) => return Err(HandshakeError::Broken(errno)),
        }
        for _ in 0..PATIENCE_MS {
            wait();
            if let (Some(answer), _) = self.listen(wire)? {
                return Ok(Some(answer));
            }
        }
        self.keep();
        Ok(None)
    }

    /// Waits until the line is quiet, so that no late answer is taken for the next one.
    fn hush(&mut self, wire: &mut dyn Wire, wait: &mut dyn FnMut()) -> Result<(), HandshakeError> {
        let mut quiet_ms = 0;
        for _ in 0..PATIENCE_MS {
            wait();
            quiet_ms = match self.listen(wire)? {
                (_, 0) => quiet_ms + 1,
                _ => 0,
            };
            if quiet_ms == QUIET_MS {
                break;
            }
        }
        Ok(())
    }

    /// The newest answer, and how many bytes came.
    fn listen(&mut self, wire: &mut dyn Wire) -> Result<(Option<Answer>, usize), HandshakeError> {
        let mut bytes = [0; 256];
        let count = match wire.read(&mut bytes) {
            Ok(0) => return Err(HandshakeError::Broken(Errno::EPIPE)),
            Ok(count) => count,
            Err(Errno::EAGAIN | Errno::EINTR) => 0,
            Err(errno) => return Err(HandshakeError::Broken(errno)),
        };
        let mut newest = None;
        for byte in bytes.iter().take(count) {
            if *byte == b'\n' {
                self.keep();
            }
            match self.lines.push(*byte) {
                Some(ParsedLine::Answer(answer)) => {
                    newest = Some(answer);
                    self.foreign.clear();
                }
                Some(ParsedLine::Garbage) | None => {}
            }
        }
        Ok((newest, count))
    }

    /// Keeps the line so far, if it is the first that there is to show.
    fn keep(&mut self) {
        let line = self.lines.unfinished().trim_ascii();
        if self.foreign.is_empty() {
            self.foreign
                .extend_from_slice(&line[..line.len().min(KEPT)]);
        }
    }
}
