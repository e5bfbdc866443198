//! Recordings of event devices as text, as `evemu-record` writes them:
//!
//! ```text
//! # EVEMU 1.3
//! N: Wacom Intuos Pro M Pen              # its name
//! I: 0003 056a 0357 0110                 # bus, vendor, product, version, hexadecimal
//! P: 01 00 00 00 00 00 00 00             # properties
//! B: 03 03 00 00 0f 00 00 00 00          # a type of events, and which of them there are, a bit each
//! A: 00 0 44800 4 0 200                  # an axis: code, least, most, fuzz, flat, resolution
//! E: 0.004000 0003 0000 21000            # an event: seconds.microseconds, type, code, value
//! ```

use super::capabilities::{Axis, Capabilities};
use super::frame::{self, kind};
use crate::device_source::Identity;
use crate::reports::recorded::{Event, LineFault, Recorded, RecordingError, start, time_ns};

/// Beginning of such a file.
pub const MARK: &str = "# EVEMU";

/// Reads the text of a recording.
///
/// # Errors
/// [`RecordingError`].
pub fn parse(text: &str) -> Result<Recorded, RecordingError> {
    let mut reader = Reader::default();
    for (number, line) in text.lines().enumerate() {
        // What follows a tab and # says the same in words.
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let read = match line.split_once(':') {
            Some((kind, rest)) => reader.line(kind, rest.trim()),
            None => Err(LineFault::Line(start(line))),
        };
        read.map_err(|fault| RecordingError {
            line: number + 1,
            fault,
        })?;
    }
    if reader.capabilities.axes.is_empty() {
        return Err(RecordingError {
            line: text.lines().count().max(1),
            fault: LineFault::NoAxis,
        });
    }
    let mut recorded = reader.recorded;
    recorded.descriptor = reader.capabilities.to_bytes();
    Ok(recorded)
}

/// Text that was read so far.
#[derive(Debug, Default)]
struct Reader {
    recorded: Recorded,
    capabilities: Capabilities,
    /// Bytes of keys so far: a bit a key, eight bytes a line.
    key_bytes: u16,
    frame: Vec<u8>,
}

impl Reader {
    fn line(&mut self, kind: &str, rest: &str) -> Result<(), LineFault> {
        match kind {
            "N" => rest.clone_into(&mut self.recorded.identity.name),
            "I" => self.identity(rest)?,
            "A" => self.axis(rest)?,
            "B" => self.bits(rest)?,
            "E" => self.event(rest)?,
            // Properties, lights and switches say nothing of a pen.
            _ => {}
        }
        Ok(())
    }

    fn identity(&mut self, rest: &str) -> Result<(), LineFault> {
        let mut numbers = rest
            .split_whitespace()
            .map(|word| u16::from_str_radix(word, 16));
        let mut number = || numbers.next().and_then(Result::ok);
        let (Some(bus), Some(vendor), Some(product)) = (number(), number(), number()) else {
            return Err(LineFault::Identity(start(rest)));
        };
        self.recorded.identity = Identity {
            bus,
            vendor,
            product,
            ..std::mem::take(&mut self.recorded.identity)
        };
        Ok(())
    }

    fn axis(&mut self, rest: &str) -> Result<(), LineFault> {
        let (code, numbers) = rest.split_once(' ').ok_or(LineFault::Axis)?;
        let code = u16::from_str_radix(code, 16).map_err(|_| LineFault::Axis)?;
        let numbers: Result<Vec<i32>, _> = numbers.split_whitespace().map(str::parse).collect();
        let numbers = numbers.map_err(|_| LineFault::Axis)?;
        let [least, most, _, _, rest @ ..] = &numbers[..] else {
            return Err(LineFault::Axis);
        };
        self.capabilities.axes.push(Axis {
            code,
            range: [*least, *most],
            resolution: rest.first().copied().unwrap_or(0),
        });
        Ok(())
    }

    fn bits(&mut self, rest: &str) -> Result<(), LineFault> {
        let bytes: Result<Vec<u8>, _> = rest
            .split_whitespace()
            .map(|word| u8::from_str_radix(word, 16))
            .collect();
        let bytes = bytes.map_err(|_| LineFault::Bits)?;
        let Some((1, bytes)) = bytes.split_first().map(|(first, rest)| (*first, rest)) else {
            return Ok(());
        };
        for byte in bytes {
            let first = self.key_bytes.saturating_mul(8);
            let set = (0..8).filter(|bit| byte >> bit & 1 == 1);
            let keys = set.map(|bit| first.saturating_add(bit));
            self.capabilities.keys.extend(keys);
            self.key_bytes = self.key_bytes.saturating_add(1);
        }
        Ok(())
    }

    fn event(&mut self, rest: &str) -> Result<(), LineFault> {
        let words: Vec<&str> = rest.split_whitespace().collect();
        let [time, kind, code, value, ..] = words[..] else {
            return Err(LineFault::Event);
        };
        let time_ns = time_ns(time)?;
        let hexadecimal = |word| u16::from_str_radix(word, 16).map_err(|_| LineFault::Event);
        let event = frame::Event {
            kind: hexadecimal(kind)?,
            code: hexadecimal(code)?,
            value: value.parse().map_err(|_| LineFault::Event)?,
        };
        if event.kind != kind::SYN {
            frame::push(&mut self.frame, event);
        }
        if (event.kind, event.code) != (kind::SYN, 0) {
            return Ok(());
        }
        let events = &mut self.recorded.events;
        if events.last().is_some_and(|last| time_ns < last.time_ns) {
            return Err(LineFault::Older);
        }
        let report = std::mem::take(&mut self.frame);
        if !report.is_empty() {
            events.push(Event { time_ns, report });
        }
        Ok(())
    }
}
