//! The lines that a WoodenHaptics or Polhem stylus and its host exchange, as the devices' own firmware
//! (forsslund/polhemstylus, `polhem_teensy.ino`, 2020-11) and host (forsslund/haptikfabrikenapi, uAPI
//! v0.2) write them.
//!
//! The host's lines are seven whole numbers, three for the motors, a command and three that it may
//! need, filled up with spaces. The device answers each with one line: six encoders and a flag, or,
//! once a force was asked for, where the stylus is. Some firmware ends that line twice. So a line ends
//! where a newline is, an empty one says nothing, and no length counts.

use std::io::Write;

use glam::DVec3;

/// Longest line that the firmware takes in, bytes, its newline included.
const LONGEST: usize = 64;
/// Longest line of a device that is looked at, bytes.
const LONGEST_ANSWER: usize = 128;
/// Largest force of the devices, N.
pub const MAX_FORCE_N: f64 = 5.0;
/// Largest that a line can say along an axis, N: an i16 of mN.
const LARGEST_N: f64 = 32.767;
/// No stylus of these is farther from its origin along an axis, mm.
pub const FARTHEST_MM: f64 = 1000.0;
/// No gimbal turns farther, rad: two turns.
pub const FARTHEST_RAD: f64 = 4.0 * std::f64::consts::PI;

/// The line that requests an answer and nothing else: it is no command, so motors get no current in this tick, and the
/// device's watchdog is not reset.
pub const PROBE: &[u8] = b"\n";

/// Length of a command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// 63 bytes, as hosts of 2020 send. The published firmware ends a line at its newline.
    Short,
    /// 64 bytes, as uAPI v0.2 sends.
    Long,
}

impl Length {
    /// Bytes, the newline included.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::Short => LONGEST - 1,
            Self::Long => LONGEST,
        }
    }
}

/// A command line.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    bytes: [u8; LONGEST],
    length: Length,
}

impl Line {
    /// Requests a force, N, in the device's own axes (x toward the user, y right, z up), and the pose of the stylus. A
    /// force beyond the device's is cut to it along its own direction, NaN counts as 0.
    #[must_use]
    pub fn force(force: DVec3, length: Length) -> Self {
        let force = if force.is_finite() {
            force.clamp_length_max(MAX_FORCE_N)
        } else {
            DVec3::ZERO
        };
        let millinewtons = force
            .to_array()
            .map(|part| (part.clamp(-LARGEST_N, LARGEST_N) * 1000.0).round() as i16);
        Self::new(millinewtons, 2, length)
    }

    /// Asks for no current, and for the encoders.
    #[must_use]
    pub fn encoders(length: Length) -> Self {
        Self::new([0; 3], 0, length)
    }

    fn new(motors: [i16; 3], command: i16, length: Length) -> Self {
        let mut bytes = [b' '; LONGEST];
        let [a, b, c] = motors;
        // At most 30 characters: they fit.
        write!(&mut bytes[..], "{a} {b} {c} {command} 0 0 0").ok();
        bytes[length.bytes() - 1] = b'\n';
        Self { bytes, length }
    }

    /// Bytes on the wire.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.length.bytes()]
    }
}

/// Pose of the stylus, in the device's own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// x toward the user, y right, z up, mm, each within [`FARTHEST_MM`].
    pub position_mm: [f64; 3],
    /// t_A, λ, t_D and t_E of the arm and its gimbal, rad, each within [`FARTHEST_RAD`].
    pub angles_rad: [f64; 4],
    /// The flag of the calibration's button.
    pub info: i16,
}

/// The encoders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoders {
    /// a to f, counts.
    pub counts: [i16; 6],
    /// The flag of the calibration's button.
    pub info: i16,
}

impl Encoders {
    /// True while the stylus' button is pressed: units that have one add 10 000 counts to encoder d.
    #[must_use]
    pub fn is_pressed(&self) -> bool {
        self.counts[3] > 5000
    }
}

/// Answer of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// Pose of the stylus.
    Pose(Pose),
    /// Its encoders.
    Encoders(Encoders),
}

/// Kind of a line from the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParsedLine {
    /// An answer.
    Answer(Answer),
    /// No answer of such a device.
    Garbage,
}

/// Reads a line without its newline; None where it is empty.
#[must_use]
pub fn read(line: &[u8]) -> Option<ParsedLine> {
    if line.iter().all(u8::is_ascii_whitespace) {
        return None;
    }
    let answer = std::str::from_utf8(line).ok().and_then(|text| {
        pose(text)
            .map(Answer::Pose)
            .or_else(|| encoders(text).map(Answer::Encoders))
    });
    Some(answer.map_or(ParsedLine::Garbage, ParsedLine::Answer))
}

fn pose(text: &str) -> Option<Pose> {
    let mut words = text.split_ascii_whitespace();
    let mut number = |farthest: f64| {
        let value: f64 = words.next()?.parse().ok()?;
        (-farthest..=farthest).contains(&value).then_some(value)
    };
    let mut position_mm = [0.0; 3];
    for part in &mut position_mm {
        *part = number(FARTHEST_MM)?;
    }
    let mut angles_rad = [0.0; 4];
    for part in &mut angles_rad {
        *part = number(FARTHEST_RAD)?;
    }
    let info = words.next()?.parse().ok()?;
    words.next().is_none().then_some(Pose {
        position_mm,
        angles_rad,
        info,
    })
}

fn encoders(text: &str) -> Option<Encoders> {
    let mut words = text.split_ascii_whitespace();
    let mut counts = [0; 6];
    for part in &mut counts {
        *part = words.next()?.parse().ok()?;
    }
    let info = words.next()?.parse().ok()?;
    words.next().is_none().then_some(Encoders { counts, info })
}

/// Puts lines together from what comes in pieces.
#[derive(Clone, Copy, Debug)]
pub struct Lines {
    line: [u8; LONGEST_ANSWER],
    /// Bytes since the newline before; more than there is room for make garbage.
    length: usize,
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            line: [0; LONGEST_ANSWER],
            length: 0,
        }
    }
}

impl Lines {
    /// Takes in a byte; what it completes, if it does.
    pub fn push(&mut self, byte: u8) -> Option<ParsedLine> {
        if byte != b'\n' {
            if let Some(place) = self.line.get_mut(self.length) {
                *place = byte;
            }
            self.length = self.length.saturating_add(1);
            return None;
        }
        let length = std::mem::take(&mut self.length);
        self.line
            .get(..length)
            .map_or(Some(ParsedLine::Garbage), read)
    }

    /// Received part of a line that has not ended.
    #[must_use]
    pub fn unfinished(&self) -> &[u8] {
        &self.line[..self.length.min(LONGEST_ANSWER)]
    }
}
