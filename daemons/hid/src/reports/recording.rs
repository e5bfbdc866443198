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

pub use super::recorded::{Event, LineFault, Recorded, RecordingError};
use super::recorded::{start, time_ns};
use crate::descriptor::LONGEST;
use crate::device_source::Identity;
use crate::evdev::evemu;
use crate::open::{self, Kind};

/// A report is no longer than this, bytes: the kernel's limit.
pub const LONGEST_REPORT: usize = 16_384;
/// Advice about a line that does not belong to a recording.
const HELP: &str = "record anew with `maulstick node hid --record` or with `hid-recorder`";

/// Reads a recording from a file.
///
/// # Errors
/// A [`UserError`] that names the line.
pub fn read(path: &Path) -> Result<Vec<Recorded>, UserError> {
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    let parsed = if text.starts_with(evemu::MARK) {
        evemu::parse(&text).map(|device| vec![device])
    } else {
        parse(&text)
    };
    parsed.map_err(|error| {
        UserError::usage(error.fault.to_string())
            .at(format!("{}:{}", path.display(), error.line))
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
            Err(fault) => first = first.or(Some(UserError::from(fault))),
        }
    }
    Err(first.unwrap_or_else(|| UserError::usage("there is no device in the recording")))
}

/// Reads the text of a recording: its devices, at least one.
///
/// # Errors
/// [`RecordingError`].
pub fn parse(text: &str) -> Result<Vec<Recorded>, RecordingError> {
    let mut found: Vec<(u32, Recorded)> = Vec::new();
    let mut now = 0;
    let mut last = 0;
    for (number, line) in text.lines().enumerate() {
        last = number + 1;
        let wrong = |fault: LineFault| RecordingError { line: last, fault };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let Some((kind, rest)) = line.split_once(':') else {
            return Err(wrong(LineFault::Line(start(line))));
        };
        let rest = rest.trim();
        if kind == "D" {
            now = rest
                .parse()
                .map_err(|_| wrong(LineFault::Device(start(rest))))?;
        }
        let at = match found.iter().position(|(known, _)| *known == now) {
            Some(at) => at,
            None => {
                found.push((now, Recorded::default()));
                found.len() - 1
            }
        };
        found[at].1.add_line(kind, rest).map_err(wrong)?;
    }
    let mut devices = Vec::new();
    for (number, device) in found {
        if device.descriptor.is_empty() {
            return Err(RecordingError {
                line: last,
                fault: LineFault::NoDescriptor(number),
            });
        }
        devices.push(device);
    }
    if devices.is_empty() {
        return Err(RecordingError {
            line: last.max(1),
            fault: LineFault::NoDevice,
        });
    }
    Ok(devices)
}

impl Recorded {
    fn add_line(&mut self, kind: &str, rest: &str) -> Result<(), LineFault> {
        match kind {
            "D" => {}
            "R" if self.descriptor.is_empty() => self.descriptor = bytes(rest, LONGEST)?,
            "R" => return Err(LineFault::TwoDescriptors),
            "N" => rest.clone_into(&mut self.identity.name),
            "P" => rest.clone_into(&mut self.identity.place),
            "I" => self.identity.set_numbers(rest)?,
            "E" => {
                let (time, report) = rest.split_once(' ').ok_or(LineFault::Report)?;
                let time_ns = time_ns(time)?;
                if self
                    .events
                    .last()
                    .is_some_and(|last| time_ns < last.time_ns)
                {
                    return Err(LineFault::Older);
                }
                let report = bytes(report, LONGEST_REPORT)?;
                self.events.push(Event { time_ns, report });
            }
            other => return Err(LineFault::Kind(start(other))),
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
    fn set_numbers(&mut self, rest: &str) -> Result<(), LineFault> {
        let wrong = || LineFault::Identity(start(rest));
        let mut numbers = rest
            .split_whitespace()
            .map(|word| u16::from_str_radix(word, 16).map_err(|_| wrong()));
        let mut next = || numbers.next().unwrap_or_else(|| Err(wrong()));
        (self.bus, self.vendor, self.product) = (next()?, next()?, next()?);
        Ok(())
    }
}

fn counted(bytes: &[u8]) -> String {
    let mut text = bytes.len().to_string();
    for byte in bytes {
        // Writing to a string does not fail.
        write!(text, " {byte:02x}").ok();
    }
    text
}

fn bytes(text: &str, most: usize) -> Result<Vec<u8>, LineFault> {
    let mut words = text.split_whitespace();
    let count = words.next().and_then(|word| word.parse::<usize>().ok());
    let Some(count) = count.filter(|count| (1..=most).contains(count)) else {
        return Err(LineFault::Count(most));
    };
    let mut found = Vec::with_capacity(count);
    for word in words {
        match u8::from_str_radix(word, 16) {
            Ok(byte) if word.len() <= 2 => found.push(byte),
            _ => return Err(LineFault::Byte(start(word))),
        }
    }
    if found.len() == count {
        Ok(found)
    } else {
        Err(LineFault::Bytes {
            announced: count,
            found: found.len(),
        })
    }
}
