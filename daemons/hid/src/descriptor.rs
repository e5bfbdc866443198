//! Report descriptors (HID 1.11, section 6.2.2), read by `hidreport`: what may be asked of it, and what a
//! descriptor is of.
//!
//! A descriptor comes from whatever is plugged in. A few bytes may ask for billions of fields, or name
//! a usage before any page; so [`read`] walks over its items first and refuses what no device needs.

use hidreport::{Field, Report as _, ReportDescriptor, Usage};

/// A descriptor is no longer than this, bytes: the kernel gives no more.
pub const LONGEST: usize = 4096;
/// All main items together have no more fields.
const FIELDS: usize = 8192;
/// Bits of one main item.
const BITS: usize = 1 << 16;
/// Usages of all ranges together.
const USAGES: u64 = 1 << 17;
/// Usages of one collection.
const COLLECTION_USAGES: u64 = 16;
/// Collections, or globals that are kept, inside one another.
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
/// What is wrong with it, in words.
pub fn read(bytes: &[u8]) -> Result<ReportDescriptor, String> {
    check(bytes)?;
    ReportDescriptor::try_from(bytes).map_err(|error| error.to_string())
}

/// Page and number of a usage.
#[must_use]
pub fn pair(usage: &Usage) -> (u16, u16) {
    (usage.usage_page.into(), usage.usage_id.into())
}

/// What is known of the globals, as far as it bears on what a descriptor may cost.
#[derive(Clone, Copy, Default)]
struct Globals {
    has_page: bool,
    bits: usize,
    count: usize,
}

fn check(bytes: &[u8]) -> Result<(), String> {
    if bytes.is_empty() || bytes.len() > LONGEST {
        return Err(format!("it has {} bytes, not 1 to {LONGEST}", bytes.len()));
    }
    let (mut globals, mut kept) = (Globals::default(), Vec::new());
    let (mut depth, mut fields, mut usages) = (0_usize, 0_usize, 0_u64);
    let (mut named, mut least, mut most) = (0_u64, None, None);
    let mut at = 0;
    while let Some(&head) = bytes.get(at) {
        let size = [0, 1, 2, 4][usize::from(head & 3)];
        let wrong = |what: &str| Err(format!("{what} at byte {at}"));
        let Some(data) = bytes.get(at + 1..at + 1 + size) else {
            return wrong("an item is cut off");
        };
        let value = data
            .iter()
            .rev()
            .fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
        match head & 0xFC {
            0x04 => globals.has_page = true,
            0x74 => globals.bits = usize::try_from(value).unwrap_or(usize::MAX),
            0x94 => globals.count = usize::try_from(value).unwrap_or(usize::MAX),
            0xA4 => kept.push(globals),
            0xB4 => match kept.pop() {
                Some(before) => globals = before,
                None => return wrong("globals are taken back that were not kept"),
            },
            0x08 => named += 1,
            0x18 => least = Some(value),
            0x28 => most = Some(value),
            main @ (0x80 | 0x90 | 0xB0 | 0xA0) => {
                if !globals.has_page {
                    return wrong("a main item comes before any usage page");
                }
                if let (Some(least), Some(most)) = (least, most) {
                    named += u64::saturating_sub(most, least) + 1;
                }
                usages += named;
                if main == 0xA0 {
                    depth += 1;
                    if named > COLLECTION_USAGES {
                        return wrong("a collection has too many usages");
                    }
                } else {
                    let bits = globals.bits.saturating_mul(globals.count);
                    if bits > BITS {
                        return wrong("a field is too long");
                    }
                    fields += globals.count;
                }
                (named, least, most) = (0, None, None);
            }
            0xC0 => {
                depth = depth.saturating_sub(1);
                (named, least, most) = (0, None, None);
            }
            _ => {}
        }
        if depth > DEPTH || kept.len() > DEPTH || fields > FIELDS || usages > USAGES {
            return wrong("it asks for too much");
        }
        at += 1 + size;
    }
    Ok(())
}

/// What a descriptor says that its device is, in words: `a mouse and a keyboard`.
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

/// Whether a field lies, at any depth, in a collection of one of these usages.
#[must_use]
pub fn lies_in(field: &Field, wanted: impl Fn((u16, u16)) -> bool) -> bool {
    let collections = field.collections().iter();
    collections
        .flat_map(|collection| collection.usages())
        .any(|usage| wanted(pair(usage)))
}
