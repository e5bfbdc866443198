//! Recordings of devices as text, as `hid-recorder` writes them; those of [`evemu`] are read too.
//!
//! ```text
//! D: 0                                   # a device begins; may be left out for a single one
//! R: 3 05 0d 09                          # its report descriptor: how many bytes, and they
//! N: Wacom Intuos Pro M                  # its name
//! P: usb-0000:00:14.0-2/input0           # where it was plugged in
//! I: 3 056a 03f7                         # bus, vendor, product, hexadecimal
//! E: 000000.004000 2 06 20               # a report: seconds.microseconds, how many bytes, and they
//! ```

use std::fmt::Write as _;
use std::path::Path;

use maulstick_rig::UserError;

use crate::descriptor::LONGEST;
use crate::device_source::Identity;
use crate::evdev::evemu;
use crate::open::{self, Kind};

/// A report is no longer than this, bytes: the kernel's limit.
pub const LONGEST_REPORT: usize = 16_384;
/// A recording spans no more time than this, s.
const LONGEST_S: u64 = 100_000;
/// Advice about a line that does not belong to a recording.
const HELP: &str = "record anew with `maulstick node hid --record` or with `hid-recorder`";

/// A report, and when it came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// Since the recording's begin, ns.
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

/// Reads a recording from a file.
///
/// # Errors
/// A [`UserError`] that names the line.
pub fn read(path: &Path) -> Result<Vec<Recorded>, UserError> {
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    let parsed = match text.starts_with(evemu::MARK) {
        true => evemu::parse(&text).map(|device| vec![device]),
        false => parse(&text),
    };
    parsed.map_err(|(line, what)| {
        UserError::usage(what)
            .at(format!("{}:{line}", path.display()))
            .help(HELP)
    })
}

/// The first device of a recording that can stand in for one of `kind`.
///
/// # Errors
/// A [`UserError`] that says what the first of them is instead.
pub fn playable(kind: Kind, recorded: Vec<Recorded>) -> Result<Recorded, UserError> {
    let mut first = None;
    for device in recorded {
        match open::means(kind, &device.identity, &device.descriptor) {
            Ok(_) => return Ok(device),
            Err(fault) => first = first.or(Some(fault)),
        }
    }
    Err(first.unwrap_or_else(|| UserError::usage("there is no device in the recording")))
}

/// Reads the text of a recording: its devices, at least one.
///
/// # Errors
/// The number of the line that is wrong, from 1, and what is wrong with it.
pub fn parse(text: &str) -> Result<Vec<Recorded>, (usize, String)> {
    let mut found: Vec<(u32, Recorded)> = Vec::new();
    let mut now = 0;
    let mut last = 0;
    for (number, line) in text.lines().enumerate() {
        last = number + 1;
        let wrong = |what: String| (last, what);
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let Some((kind, rest)) = line.split_once(':') else {
            return Err(wrong(format!(
                "'{}' is no line of a recording",
                start(line)
            )));
        };
        let rest = rest.trim();
        if kind == "D" {
            now = rest
                .parse()
                .map_err(|_| wrong(format!("'{}' is no number of a device", start(rest))))?;
        }
        let at = match found.iter().position(|(known, _)| *known == now) {
            Some(at) => at,
            None => {
                found.push((now, Recorded::default()));
                found.len() - 1
            }
        };
        found[at].1.take(kind, rest).map_err(wrong)?;
    }
    let mut devices = Vec::new();
    for (number, device) in found {
        if device.descriptor.is_empty() {
            return Err((
                last,
                format!("device {number} has no line R: with its report descriptor"),
            ));
        }
        devices.push(device);
    }
    match devices.is_empty() {
        true => Err((last.max(1), "there is no device in it".to_owned())),
        false => Ok(devices),
    }
}

impl Recorded {
    fn take(&mut self, kind: &str, rest: &str) -> Result<(), String> {
        match kind {
            "D" => {}
            "R" if self.descriptor.is_empty() => self.descriptor = bytes(rest, LONGEST)?,
            "R" => return Err("the device has two descriptors".to_owned()),
            "N" => rest.clone_into(&mut self.identity.name),
            "P" => rest.clone_into(&mut self.identity.place),
            "I" => self.identity.take_numbers(rest)?,
            "E" => {
                let (time, report) = rest
                    .split_once(' ')
                    .ok_or("a report is its time, how many bytes it has, and they")?;
                let time_ns = time_ns(time)?;
                if self
                    .events
                    .last()
                    .is_some_and(|last| time_ns < last.time_ns)
                {
                    return Err("the report is older than the one before".to_owned());
                }
                let report = bytes(report, LONGEST_REPORT)?;
                self.events.push(Event { time_ns, report });
            }
            other => {
                return Err(format!(
                    "'{}:' is none of D:, R:, N:, P:, I:, E:",
                    start(other)
                ));
            }
        }
        Ok(())
    }

    /// The device without its reports, as text.
    #[must_use]
    pub fn heading(&self, number: u32) -> String {
        let Identity {
            bus,
            vendor,
            product,
            name,
            place,
        } = &self.identity;
        // A name is one line, whatever the device calls itself.
        let line = |text: &str| text.replace(['\n', '\r'], " ");
        format!(
            "D: {number}\nR: {}\nN: {}\nP: {}\nI: {bus:x} {vendor:04x} {product:04x}\n",
            counted(&self.descriptor),
            line(name),
            line(place),
        )
    }
}

impl Event {
    /// The report as a line of text.
    #[must_use]
    pub fn line(&self) -> String {
        let microseconds = self.time_ns / 1000;
        format!(
            "E: {:06}.{:06} {}\n",
            microseconds / 1_000_000,
            microseconds % 1_000_000,
            counted(&self.report)
        )
    }
}

impl Identity {
    fn take_numbers(&mut self, rest: &str) -> Result<(), String> {
        let wrong = || format!("'{}' is no bus, vendor and product", start(rest));
        let mut numbers = rest
            .split_whitespace()
            .map(|word| u16::from_str_radix(word, 16).map_err(|_| wrong()));
        let mut next = || numbers.next().unwrap_or_else(|| Err(wrong()));
        (self.bus, self.vendor, self.product) = (next()?, next()?, next()?);
        Ok(())
    }
}

/// Quotation of a wrong line.
fn start(text: &str) -> String {
    text.chars().take(24).collect()
}

fn counted(bytes: &[u8]) -> String {
    let mut text = bytes.len().to_string();
    for byte in bytes {
        // Writing to a string does not fail.
        write!(text, " {byte:02x}").ok();
    }
    text
}

fn bytes(text: &str, most: usize) -> Result<Vec<u8>, String> {
    let mut words = text.split_whitespace();
    let count = words.next().and_then(|word| word.parse::<usize>().ok());
    let Some(count) = count.filter(|count| (1..=most).contains(count)) else {
        return Err(format!("the number of bytes comes first, 1 to {most}"));
    };
    let mut found = Vec::with_capacity(count);
    for word in words {
        match u8::from_str_radix(word, 16) {
            Ok(byte) if word.len() <= 2 => found.push(byte),
            _ => return Err(format!("'{}' is no byte in hexadecimal", start(word))),
        }
    }
    match found.len() == count {
        true => Ok(found),
        false => Err(format!("{count} bytes are said, {} follow", found.len())),
    }
}

/// Time of a line, ns.
pub(crate) fn time_ns(text: &str) -> Result<u64, String> {
    let wrong = || format!("'{}' is no time in seconds", start(text));
    let (seconds, micros) = text.split_once('.').ok_or_else(wrong)?;
    if micros.len() != 6 {
        return Err(format!(
            "'{}' is no time in seconds with six digits behind the point",
            start(text)
        ));
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
