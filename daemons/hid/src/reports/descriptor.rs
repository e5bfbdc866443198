//! Report descriptors (HID 1.11, section 6.2.2), read by `hidreport`: what may be asked of it, and what a
//! descriptor is of.
//!
//! A descriptor comes from whatever is plugged in. A few bytes may ask for billions of fields, or name
//! a usage before any page; so [`read`] walks over its items first and refuses what no device needs. What nobody here
//! reads does not count: makers put tens of thousands of fields of their own beside a pen (firmware, heat maps,
//! certificates), or keys without usages.

use hidreport::{Field, ParserError, Report as _, ReportDescriptor, Usage};

/// A descriptor is no longer than this, bytes: the kernel gives no more.
pub const LONGEST: usize = 4096;
/// Most fields of all inputs that are read. Each has a copy of the usages of its collections, [`DEPTH`] times
/// [`COLLECTION_USAGES`] at most.
const FIELDS: usize = 8192;
/// Bits of an input that is read.
const BITS: usize = 1 << 16;
/// Bits of an input that is passed over.
const PASSED_BITS: usize = 1 << 24;
/// Usages of all ranges together.
const USAGES: u64 = 1 << 17;
/// Usages of one collection.
const COLLECTION_USAGES: u64 = 16;
/// Largest nesting of collections, or of saved globals.
const DEPTH: usize = 12;
/// Type of an item that says something of the next main item alone.
const LOCAL: u8 = 0x08;
/// An input that is passed over: one array of no usage, as long as all its fields.
const PASSED_OVER: &[u8] = &[0x09, 0x00, 0x81, 0x00];

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

/// Reads a descriptor: its inputs. Each input that is on no page in [`page`] but media keys' is one field, and of output
/// and feature reports there is nothing.
///
/// # Errors
/// [`DescriptorError`].
pub fn read(bytes: &[u8]) -> Result<ReportDescriptor, DescriptorError> {
    let needed = needed(bytes)?;
    let read = ReportDescriptor::try_from(needed.as_slice());
    read.map_err(|error: ParserError| DescriptorError::Parser(error.to_string()))
}

/// A descriptor that is not read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DescriptorError {
    /// Of no length that the kernel gives.
    #[error("it has {0} bytes, not 1 to {LONGEST}")]
    Length(usize),
    /// An item that no descriptor has there.
    #[error("{defect} at byte {at}")]
    Item {
        /// Its fault.
        defect: Defect,
        /// Its place.
        at: usize,
    },
    /// No report.
    #[error("it says nothing of a report")]
    Empty,
    /// What `hidreport` refuses.
    #[error("{0}")]
    Parser(String),
}

/// Fault of an item of a descriptor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// The bytes end within it.
    #[error("an item is cut off")]
    Cut,
    /// No page says what it is about.
    #[error("a main item comes before any usage page")]
    NoPage,
    /// A Pop without a Push.
    #[error("globals are restored that were not saved")]
    NotSaved,
    /// More bits than an input of a device has.
    #[error("a field is too long")]
    Long,
    /// More usages than a collection of a device has.
    #[error("a collection has too many usages")]
    Usages,
    /// More fields, usages or levels than a device has.
    #[error("it asks for too much")]
    Greedy,
}

/// Page and number of a usage.
#[must_use]
pub fn pair(usage: &Usage) -> (u16, u16) {
    (usage.usage_page.into(), usage.usage_id.into())
}

/// Globals, as far as they bear on the cost of a descriptor, and on whether a field is read.
#[derive(Clone, Copy, Default)]
struct Globals {
    page: Option<u16>,
    bits: usize,
    count: usize,
}

/// The usages that the next main item has, and the items that say so. They are written only before an input that is read:
/// by the specification Push saves globals alone, while `hidreport` would save and restore them too.
#[derive(Clone, Default)]
struct Locals {
    items: Vec<u8>,
    named: u64,
    /// Pages that are said with a usage.
    pages: Vec<u16>,
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

    /// True if a field with these usages may be a pen's or a 6-DOF mouse's.
    fn is_read(&self, page: Option<u16>) -> bool {
        let known = |page: &u16| matches!(*page, page::DESKTOP | page::DIGITIZER | page::WACOM);
        self.usages() > 0 && page.iter().chain(&self.pages).any(known)
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

/// The items of a descriptor that are needed to read its inputs.
fn needed(bytes: &[u8]) -> Result<Vec<u8>, DescriptorError> {
    if bytes.is_empty() || bytes.len() > LONGEST {
        return Err(DescriptorError::Length(bytes.len()));
    }
    let mut walk = Walk::default();
    let mut at = 0;
    while at < bytes.len() {
        let wrong = |defect| DescriptorError::Item { defect, at };
        let (head, value, next) = item(bytes, at).ok_or_else(|| wrong(Defect::Cut))?;
        walk.pass(head, value, &bytes[at..next]).map_err(wrong)?;
        at = next;
    }
    if walk.needed.is_empty() {
        return Err(DescriptorError::Empty);
    }
    Ok(walk.needed)
}

/// A walk over the items of a descriptor.
#[derive(Default)]
struct Walk {
    /// The items that are needed so far.
    needed: Vec<u8>,
    globals: Globals,
    saved: Vec<Globals>,
    locals: Locals,
    depth: usize,
    fields: usize,
    usages: u64,
}

impl Walk {
    /// Passes an item: its head without its size, its value, all its bytes.
    fn pass(&mut self, head: u8, value: u64, whole: &[u8]) -> Result<(), Defect> {
        let is_main = matches!(head, 0x80 | 0x90 | 0xA0 | 0xB0 | 0xC0);
        if is_main && head != 0xC0 && self.globals.page.is_none() {
            return Err(Defect::NoPage);
        }
        match head {
            0x04 => self.globals.page = u16::try_from(value).ok(),
            0x74 => self.globals.bits = usize::try_from(value).unwrap_or(usize::MAX),
            0x94 => self.globals.count = usize::try_from(value).unwrap_or(usize::MAX),
            0xA4 => self.saved.push(self.globals),
            0xB4 => self.globals = self.saved.pop().ok_or(Defect::NotSaved)?,
            0x08 => {
                self.locals.named += 1;
                if let (5, Ok(page)) = (whole.len(), u16::try_from(value >> 16)) {
                    self.locals.pages.push(page);
                }
            }
            0x18 => self.locals.least = Some(value),
            0x28 => self.locals.most = Some(value),
            0x80 => self.input(value & 1 == 1, whole)?,
            0xA0 => self.collection(whole)?,
            0xC0 => self.depth = self.depth.saturating_sub(1),
            _ => {}
        }
        let is_deep = self.depth > DEPTH || self.saved.len() > DEPTH;
        if is_deep || self.fields > FIELDS || self.usages > USAGES {
            return Err(Defect::Greedy);
        }
        match head & 0x0C {
            _ if is_main => self.locals = Locals::default(),
            LOCAL => self.locals.items.extend(whole),
            _ => self.needed.extend(whole),
        }
        if head == 0xC0 {
            self.needed.extend(whole);
        }
        Ok(())
    }

    /// An input. A constant has no usages, whatever stands before it.
    fn input(&mut self, is_constant: bool, whole: &[u8]) -> Result<(), Defect> {
        let bits = self.globals.bits.saturating_mul(self.globals.count);
        let is_read = !is_constant && self.locals.is_read(self.globals.page);
        if bits > if is_read { BITS } else { PASSED_BITS } {
            return Err(Defect::Long);
        }
        if is_read {
            self.fields += self.globals.count;
            self.usages += self.locals.usages();
            self.needed.extend(self.locals.items.iter().chain(whole));
        } else {
            self.fields += 1;
            let kept = if is_constant { whole } else { PASSED_OVER };
            self.needed.extend(kept);
        }
        Ok(())
    }

    fn collection(&mut self, whole: &[u8]) -> Result<(), Defect> {
        self.depth += 1;
        if self.locals.usages() > COLLECTION_USAGES {
            return Err(Defect::Usages);
        }
        self.usages += self.locals.usages();
        self.needed.extend(self.locals.items.iter().chain(whole));
        Ok(())
    }
}

/// Usages of a device's outermost collections, each once.
#[must_use]
pub fn outermost(descriptor: &ReportDescriptor) -> Vec<(u16, u16)> {
    let mut found = Vec::new();
    let reports = descriptor.input_reports().iter();
    for field in reports.flat_map(|report| report.fields().iter()) {
        let outermost = field.collections().first();
        for usage in outermost.iter().flat_map(|collection| collection.usages()) {
            let usage = pair(usage);
            if !found.contains(&usage) {
                found.push(usage);
            }
        }
    }
    found
}

/// Description of a device by its outermost collections: `a mouse and a keyboard`.
#[must_use]
pub fn describe(outermost: &[(u16, u16)]) -> String {
    let mut found: Vec<&str> = Vec::new();
    for usage in outermost {
        let what = word(*usage);
        if !found.contains(&what) {
            found.push(what);
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
