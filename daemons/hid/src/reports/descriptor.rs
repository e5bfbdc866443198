//! Report descriptors (HID 1.11, section 6.2.2), read by `hidreport`: what may be asked of it, and what a
//! descriptor is of.
//!
//! A descriptor comes from whatever is plugged in. A few bytes may ask for billions of fields, or name
//! a usage before any page; so [`read`] walks over its items first and refuses what no device needs.

use hidreport::{Field, Report as _, ReportDescriptor, Usage};

/// A descriptor is no longer than this, bytes: the kernel gives no more.
pub const LONGEST: usize = 4096;
/// Most fields of all main items together. Each has a copy of the usages of its collections, [`DEPTH`] times
/// [`COLLECTION_USAGES`] at most.
const FIELDS: usize = 8192;
/// Bits of one main item.
const BITS: usize = 1 << 16;
/// Usages of all ranges together.
const USAGES: u64 = 1 << 17;
/// Usages of one collection.
const COLLECTION_USAGES: u64 = 16;
/// Largest nesting of collections, or of saved globals.
const DEPTH: usize = 12;

/// Usage pages.
pub mod page {
    /// Mice, keyboards, axes.
    pub const DESKTOP: u16 = 0x01;
    /// Pens, touch.
    pub const DIGITIZER: u16 = 0x0D;
    /// Media keys.
    pub const CONSUMER: u16 = 0x0C;
    /// Wacom's own mirror of the digitizers' page.
    pub const WACOM: u16 = 0xFF0D;
}

/// Reads a descriptor.
///
/// # Errors
/// The error, in words.
pub fn read(bytes: &[u8]) -> Result<ReportDescriptor, String> {
    check(bytes)?;
    ReportDescriptor::try_from(bytes).map_err(|error| error.to_string())
}

/// Page and number of a usage.
#[must_use]
pub fn pair(usage: &Usage) -> (u16, u16) {
    (usage.usage_page.into(), usage.usage_id.into())
}

/// Globals and locals, as far as they bear on the cost of a descriptor. By the specification Push saves globals alone;
/// `hidreport` saves and restores the locals too.
#[derive(Clone, Copy, Default)]
struct Known {
    has_page: bool,
    bits: usize,
    count: usize,
    locals: Locals,
}

/// The usages that the next main item has.
#[derive(Clone, Copy, Default)]
struct Locals {
    named: u64,
    least: Option<u64>,
    most: Option<u64>,
}

impl Locals {
    fn usages(&self) -> u64 {
        let range = match (self.least, self.most) {
            (Some(least), Some(most)) => most.saturating_sub(least) + 1,
            _ => 0,
        };
        self.named + range
    }
}

/// The short item at a place: its head without its size, its value, and where the next one is.
fn item(bytes: &[u8], at: usize) -> Option<(u8, u64, usize)> {
    let head = *bytes.get(at)?;
    let end = at + 1 + [0, 1, 2, 4][usize::from(head & 3)];
    let data = bytes.get(at + 1..end)?.iter().rev();
    let value = data.fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
    Some((head & 0xFC, value, end))
}

/// Bytes of the input report of a number, including the number; `None` if there is no such report. An error in a
/// descriptor ends it.
#[must_use]
pub fn input_bytes(bytes: &[u8], number: u8) -> Option<u64> {
    let (mut at, mut bits) = (0, 0_u64);
    let (mut size, mut count, mut report) = (0_u64, 0_u64, None);
    while let Some((head, value, next)) = item(bytes, at) {
        match head {
            0x74 => size = value,
            0x84 => report = Some(value),
            0x94 => count = value,
            0x80 if report == Some(u64::from(number)) => {
                bits = bits.saturating_add(size.saturating_mul(count));
            }
            _ => {}
        }
        at = next;
    }
    (bits > 0).then(|| 1 + bits.div_ceil(8))
}

fn check(bytes: &[u8]) -> Result<(), String> {
    if bytes.is_empty() || bytes.len() > LONGEST {
        return Err(format!("it has {} bytes, not 1 to {LONGEST}", bytes.len()));
    }
    let (mut known, mut kept) = (Known::default(), Vec::new());
    let (mut depth, mut fields, mut usages) = (0_usize, 0_usize, 0_u64);
    let mut at = 0;
    while at < bytes.len() {
        let wrong = |what: &str| Err(format!("{what} at byte {at}"));
        let Some((head, value, next)) = item(bytes, at) else {
            return wrong("an item is cut off");
        };
        match head {
            0x04 => known.has_page = true,
            0x74 => known.bits = usize::try_from(value).unwrap_or(usize::MAX),
            0x94 => known.count = usize::try_from(value).unwrap_or(usize::MAX),
            0xA4 => kept.push(known),
            0xB4 => match kept.pop() {
                Some(before) => known = before,
                None => return wrong("globals are taken back that were not kept"),
            },
            0x08 => known.locals.named += 1,
            0x18 => known.locals.least = Some(value),
            0x28 => known.locals.most = Some(value),
            main @ (0x80 | 0x90 | 0xB0 | 0xA0) => {
                if !known.has_page {
                    return wrong("a main item comes before any usage page");
                }
                let named = known.locals.usages();
                usages += named;
                if main == 0xA0 {
                    depth += 1;
                    if named > COLLECTION_USAGES {
                        return wrong("a collection has too many usages");
                    }
                } else {
                    let bits = known.bits.saturating_mul(known.count);
                    if bits > BITS {
                        return wrong("a field is too long");
                    }
                    fields += known.count;
                }
                known.locals = Locals::default();
            }
            0xC0 => {
                depth = depth.saturating_sub(1);
                known.locals = Locals::default();
            }
            _ => {}
        }
        if depth > DEPTH || kept.len() > DEPTH || fields > FIELDS || usages > USAGES {
            return wrong("it asks for too much");
        }
        at = next;
    }
    Ok(())
}

/// Description of a device by its descriptor: `a mouse and a keyboard`.
#[must_use]
pub fn describe(descriptor: &ReportDescriptor) -> String {
    let mut found: Vec<&str> = Vec::new();
    let reports = descriptor.input_reports().iter();
    for field in reports.flat_map(|report| report.fields().iter()) {
        let outermost = field.collections().first();
        for usage in outermost.iter().flat_map(|collection| collection.usages()) {
            let what = word(pair(usage));
            if !found.contains(&what) {
                found.push(what);
            }
        }
    }
    match found.split_last() {
        None => "nothing that it reports".to_owned(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

fn word(usage: (u16, u16)) -> &'static str {
    match usage {
        (page::DESKTOP, 0x01 | 0x02) => "a mouse",
        (page::DESKTOP, 0x04 | 0x05) => "a game controller",
        (page::DESKTOP, 0x06 | 0x07) => "a keyboard",
        (page::DESKTOP, 0x08) => "a 6-DOF mouse",
        (page::DESKTOP, 0x80) => "a power button",
        (page::DIGITIZER, 0x01..=0x03) | (page::WACOM, _) => "a pen",
        (page::DIGITIZER, 0x04) => "a touch screen",
        (page::DIGITIZER, 0x05) => "a touch pad",
        (page::CONSUMER, _) => "media keys",
        (0xFF00.., _) => "a format of its maker's own",
        _ => "something else",
    }
}

/// True if a field is, at any depth, in a collection of one of these usages.
#[must_use]
pub fn lies_in(field: &Field, wanted: impl Fn((u16, u16)) -> bool) -> bool {
    let collections = field.collections().iter();
    collections
        .flat_map(|collection| collection.usages())
        .any(|usage| wanted(pair(usage)))
}
