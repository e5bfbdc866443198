//! The dialogue with a WoodenHaptics or Polhem stylus: one line, one answer, paced by us.
//!
//! Nothing waits here. Time is the time that the servo reports, so the dialogue runs on any clock. An answer that does
//! not come is given up: a probe asks whether the device is there, its motors have no current meanwhile, and the
//! dialogue is resumed when the line has been quiet, so that no late answer is taken for the next one. The device's own
//! watchdog ends the force 100 ms after the last command.

use nix::errno::Errno;

use super::frame::{Answer, Lines, PROBE, ParsedLine};
use crate::device::driver::DeviceError;

/// Byte transport to a device and back, without waiting.
pub trait Wire: Send {
    /// Takes what has come into `bytes`; returns how much, 0 where the other end is gone.
    ///
    /// # Errors
    /// `EAGAIN` where nothing has come; another where the wire is broken.
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Errno>;
    /// Sends what of `bytes` can be sent at once; returns how much.
    ///
    /// # Errors
    /// `EAGAIN` where nothing can be sent; another where the wire is broken.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Errno>;
}

/// Time after which an answer is given up, s: five times what an exchange over USB takes.
pub const ANSWER_S: f64 = 0.01;
/// Time without a byte after which the line is quiet, s.
pub const QUIET_S: f64 = 0.005;
/// Time between two probes, s, which is that of the devices' own host.
pub const PROBE_S: f64 = 0.1;
/// Time without an answer after which the device is gone, s.
pub const GONE_S: f64 = 1.0;
/// Pieces taken in at a time, so that a device that babbles does not hold up the servo.
const PIECES: usize = 4;

/// State of the dialogue.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dialogue {
    /// Nothing is in flight.
    Free,
    /// A line is in flight.
    Asked { since_s: f64 },
    /// An answer was lost, and a probe is in flight.
    Lost {
        probed_s: f64,
        noise_s: f64,
        answered: bool,
    },
}

/// The dialogue over a wire.
#[derive(Debug)]
pub struct Link<W> {
    wire: W,
    lines: Lines,
    dialogue: Dialogue,
    now_s: f64,
    answered_s: f64,
    /// Lines since the last answer that were none.
    garbage: u32,
    lost: u64,
}

impl<W: Wire> Link<W> {
    /// A dialogue with nothing in flight.
    pub fn new(wire: W) -> Self {
        Self {
            wire,
            lines: Lines::default(),
            dialogue: Dialogue::Free,
            now_s: 0.0,
            answered_s: 0.0,
            garbage: 0,
            lost: 0,
        }
    }

    /// True if a line may be sent.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.dialogue == Dialogue::Free
    }

    /// Answers that were given up so far.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Takes in the input of the last `step_s` s: the newest answer, if it is one to our last line.
    ///
    /// # Errors
    /// If the device is unplugged, or sends nothing readable for a second.
    pub fn poll(&mut self, step_s: f64) -> Result<Option<Answer>, DeviceError> {
        self.now_s += step_s;
        let now_s = self.now_s;
        let (answer, noise) = self.listen()?;
        if answer.is_some() {
            (self.answered_s, self.garbage) = (now_s, 0);
        }
        match &mut self.dialogue {
            Dialogue::Free => {}
            Dialogue::Asked { .. } if answer.is_some() => self.dialogue = Dialogue::Free,
            Dialogue::Asked { since_s } if now_s - *since_s < ANSWER_S => {}
            Dialogue::Asked { .. } => {
                self.lost += 1;
                self.probe()?;
            }
            Dialogue::Lost {
                probed_s,
                noise_s,
                answered,
            } => {
                *answered |= answer.is_some();
                if noise == Noise::Some {
                    *noise_s = now_s;
                }
                if *answered && now_s - *noise_s >= QUIET_S {
                    self.dialogue = Dialogue::Free;
                } else if now_s - *probed_s >= PROBE_S {
                    self.probe()?;
                }
                return self.patience().map(|()| None);
            }
        }
        self.patience()?;
        Ok(answer)
    }

    /// Sends a line, if nothing is in flight. A wire that is full takes it another time.
    ///
    /// # Errors
    /// If the device is unplugged.
    pub fn send(&mut self, line: &[u8]) -> Result<(), DeviceError> {
        if !self.is_free() {
            return Ok(());
        }
        match self.wire.write(line) {
            Ok(sent) if sent == line.len() => {
                self.dialogue = Dialogue::Asked {
                    since_s: self.now_s,
                };
                Ok(())
            }
            // The probe's newline ends what was cut off.
            Ok(_) => self.probe(),
            Err(Errno::EAGAIN | Errno::EINTR) => Ok(()),
            Err(errno) => Err(unplugged(errno)),
        }
    }

    /// Sends a last line, whatever is in flight. A newline goes first: a line that was cut off would corrupt this one.
    pub fn part(&mut self, line: &[u8]) {
        self.wire.write(PROBE).ok();
        self.wire.write(line).ok();
    }

    fn probe(&mut self) -> Result<(), DeviceError> {
        self.dialogue = Dialogue::Lost {
            probed_s: self.now_s,
            noise_s: self.now_s,
            answered: false,
        };
        match self.wire.write(PROBE) {
            Ok(_) | Err(Errno::EAGAIN | Errno::EINTR) => Ok(()),
            Err(errno) => Err(unplugged(errno)),
        }
    }

    /// The newest answer, and whether anything came at all.
    fn listen(&mut self) -> Result<(Option<Answer>, Noise), DeviceError> {
        let (mut newest, mut noise) = (None, Noise::None);
        let mut bytes = [0; 256];
        for _ in 0..PIECES {
            let count = match self.wire.read(&mut bytes) {
                Ok(0) => return Err(unplugged(Errno::EPIPE)),
                Ok(count) => count,
                Err(Errno::EINTR) => continue,
                Err(Errno::EAGAIN) => break,
                Err(errno) => return Err(unplugged(errno)),
            };
            noise = Noise::Some;
            for byte in bytes.iter().take(count) {
                match self.lines.push(*byte) {
                    Some(ParsedLine::Answer(answer)) => newest = Some(answer),
                    Some(ParsedLine::Garbage) => self.garbage = self.garbage.saturating_add(1),
                    None => {}
                }
            }
        }
        Ok((newest, noise))
    }

    fn patience(&self) -> Result<(), DeviceError> {
        if self.now_s - self.answered_s < GONE_S {
            return Ok(());
        }
        Err(match self.garbage {
            0 => DeviceError {
                what: "the stylus does not answer any more",
                code: 0,
                help: "switch it off and on, and look at its cable",
            },
            _ => DeviceError {
                what: "the stylus sends only what cannot be read",
                code: 0,
                help: "end what else uses its port, unplug it and plug it in again",
            },
        })
    }
}

/// Result of a read: a byte, or nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Noise {
    /// Nothing arrived.
    None,
    /// A byte arrived.
    Some,
}

fn unplugged(errno: Errno) -> DeviceError {
    DeviceError {
        what: "the stylus is unplugged",
        code: errno as i64,
        help: "plug it in again",
    }
}
