//! Devices and reports of a recording, whatever wrote it, and the faults of its lines.

use crate::device_source::Identity;

/// Longest time that a recording spans, s.
const LONGEST_S: u64 = 100_000;

/// A report and its time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// Time since the beginning of the recording, ns.
    pub time_ns: u64,
    /// The report, with its number if the device numbers them.
    pub report: Vec<u8>,
}

/// A device of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    /// Its identity.
    pub identity: Identity,
    /// Its report descriptor.
    pub descriptor: Vec<u8>,
    /// Its reports, in order of time.
    pub events: Vec<Event>,
}

/// A line of a recording that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {fault}")]
pub struct RecordingError {
    /// Number of the line, from 1.
    pub line: usize,
    /// Its fault.
    pub fault: LineFault,
}

/// Fault of a line of a recording.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LineFault {
    /// No colon.
    #[error("'{0}' is not a line of a recording")]
    Line(String),
    /// A letter of no line.
    #[error("'{0}:' is none of D:, R:, N:, P:, I:, E:")]
    Kind(String),
    /// `D:` without a number.
    #[error("'{0}' is not the number of a device")]
    Device(String),
    /// The text ends without a device.
    #[error("there is no device in it")]
    NoDevice,
    /// The text ends without the descriptor of a device.
    #[error("device {0} has no line R: with its report descriptor")]
    NoDescriptor(u32),
    /// A second `R:`.
    #[error("the device has two descriptors")]
    TwoDescriptors,
    /// `E:` without a report.
    #[error("a report is its time, its number of bytes, and the bytes")]
    Report,
    /// A report or an event before the one above it.
    #[error("it is older than the one before")]
    Older,
    /// `I:` without its three numbers.
    #[error("'{0}' is not bus, vendor and product, three hexadecimal numbers")]
    Identity(String),
    /// Bytes without their number, or too many of them.
    #[error("the number of bytes comes first, 1 to {0}")]
    Count(usize),
    /// A byte that is not one.
    #[error("'{0}' is not a byte in hexadecimal")]
    Byte(String),
    /// Another number of bytes than announced.
    #[error("{announced} bytes are announced, {found} follow")]
    Bytes {
        /// The number before them.
        announced: usize,
        /// Their number.
        found: usize,
    },
    /// A time that is not one.
    #[error("'{0}' is not a time in seconds, with six digits behind the point")]
    Time(String),
    /// A text of evemu without an axis.
    #[error("no line A: has an axis")]
    NoAxis,
    /// `A:` of evemu without its numbers.
    #[error("an axis is its code, least, most, fuzz, flat and resolution")]
    Axis,
    /// `B:` of evemu with something else.
    #[error("bits are bytes in hexadecimal")]
    Bits,
    /// `E:` of evemu with something else.
    #[error("an event is its time, type, code and value")]
    Event,
}

/// Beginning of a wrong line, to be quoted.
pub(crate) fn start(text: &str) -> String {
    text.chars().take(24).collect()
}

/// Time of a line, ns.
pub(crate) fn time_ns(text: &str) -> Result<u64, LineFault> {
    let wrong = || LineFault::Time(start(text));
    let (seconds, micros) = text.split_once('.').ok_or_else(wrong)?;
    if micros.len() != 6 {
        return Err(wrong());
    }
    let number = |digits: &str| {
        let all = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
        digits.parse::<u64>().ok().filter(|_| all).ok_or_else(wrong)
    };
    let (seconds, micros) = (number(seconds)?, number(micros)?);
    if seconds > LONGEST_S || micros >= 1_000_000 {
        return Err(wrong());
    }
    Ok((seconds * 1_000_000 + micros) * 1000)
}
