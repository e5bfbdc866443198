//! The device that a section of `rig.toml` asks for, and the decoder of its reports.

use maulstick_device::hid_collections::Collection;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;

use maulstick_device::pen::Reading;

use crate::descriptor::{self, outermost};
use crate::device_source::{Found, HidSource, Identity, Ports};
use crate::evdev::capabilities::Capabilities;
use crate::evdev::pen::EvdevPen;
use crate::evdev::ports::EventDevices;
use crate::hidraw::Hidraw;
use crate::layout::Layout;
use crate::spacemouse::{LIGHT, SpaceMouse, VENDORS};
use crate::unfit::{MOUSE_WORD, TABLET_WORD, Unfit, UnfitDevice};
use crate::wacom::Wacom;

/// Kinds of devices that `maulstick-hid` drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A tablet with a pen.
    Pen,
    /// The same through the kernel's event devices.
    EventPen,
    /// A 6-DOF mouse.
    SpaceMouse,
}

impl Kind {
    /// The kind of a section of `rig.toml`.
    ///
    /// # Errors
    /// A [`UserError`] where its driver is another daemon's.
    pub fn of_section(device: &DeviceSection) -> Result<Self, UserError> {
        match device.driver.as_str() {
            "pen" => Ok(Self::Pen),
            "evdev" => Ok(Self::EventPen),
            "spacemouse" => Ok(Self::SpaceMouse),
            other => Err(UserError::usage(format!(
                "this daemon has no driver '{other}'"
            ))),
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Pen | Self::EventPen => TABLET_WORD,
            Self::SpaceMouse => MOUSE_WORD,
        }
    }

    /// Where devices of this kind are.
    #[must_use]
    pub fn ports(self) -> Box<dyn Ports> {
        match self {
            Self::EventPen => Box::new(EventDevices::here()),
            Self::Pen | Self::SpaceMouse => Box::new(Hidraw),
        }
    }

    /// True if a device is of this kind by its public data.
    fn suits(self, found: &Found) -> bool {
        let Identity {
            vendor, product, ..
        } = found.identity;
        let usages = found.usages.iter();
        let mut collections = usages.map(|&(page, usage)| Collection { page, usage });
        match self {
            Self::EventPen => collections.any(|one| one.is_pen()),
            Self::Pen => {
                collections.any(|one| one.is_pen()) || Wacom::of(vendor, product).is_some()
            }
            Self::SpaceMouse => {
                VENDORS.contains(&vendor) && collections.any(|one| one.has_six_axes())
            }
        }
    }
}

/// Address of a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// The first that suits.
    Any,
    /// Vendor and product.
    Numbers(u16, u16),
    /// Its path below /dev.
    Path(String),
}

impl Address {
    /// Reads `address` of `rig.toml`.
    ///
    /// # Errors
    /// A [`UserError`] where it is neither.
    pub fn parse(text: Option<&str>) -> Result<Self, UserError> {
        let Some(text) = text else {
            return Ok(Self::Any);
        };
        if text.starts_with('/') {
            return Ok(Self::Path(text.to_owned()));
        }
        let numbers = text.split_once(':').and_then(|(vendor, product)| {
            let number = |text| u16::from_str_radix(text, 16).ok();
            Some(Self::Numbers(number(vendor)?, number(product)?))
        });
        numbers.ok_or_else(|| {
            UserError::usage(format!("'{text}' is no address of a HID device")).help(
                "write vendor:product in hexadecimal as in 056a:0357, or a path as /dev/hidraw3 or /dev/input/event7",
            )
        })
    }

    fn names(&self, found: &Found) -> bool {
        let identity = &found.identity;
        match self {
            Self::Any => true,
            Self::Numbers(vendor, product) => {
                (identity.vendor, identity.product) == (*vendor, *product)
            }
            Self::Path(path) => {
                let real = std::fs::canonicalize(path);
                identity.place == *path || real.is_ok_and(|real| *real == *identity.place)
            }
        }
    }
}

/// Decoder of a pen's reports.
#[derive(Clone, Debug)]
pub enum Decoder {
    /// By the descriptor.
    Described(Layout),
    /// By a table.
    Wacom(Wacom),
    /// By the kernel's events.
    Events(Box<EvdevPen>),
}

impl Decoder {
    /// Width and height of the active area, m.
    #[must_use]
    pub fn area_m(&self) -> [f64; 2] {
        match self {
            Self::Described(layout) => layout.area_m(),
            Self::Wacom(table) => table.area_m(),
            Self::Events(pen) => pen.area_m(),
        }
    }

    /// Axes that the pen senses, see [`maulstick_types::stylus::axes`].
    #[must_use]
    pub fn senses(&self) -> u32 {
        match self {
            Self::Described(layout) => layout.senses(),
            Self::Wacom(table) => table.senses(),
            Self::Events(pen) => pen.senses(),
        }
    }

    /// True if the reports signal that the pen is away.
    #[must_use]
    pub fn tells_range(&self) -> bool {
        match self {
            Self::Described(layout) => layout.tells_range(),
            Self::Wacom(_) | Self::Events(_) => true,
        }
    }

    /// Reads a report; nothing where it is no pen's, or too short.
    pub fn decode(&mut self, report: &[u8]) -> Option<Reading> {
        match self {
            Self::Described(layout) => layout.decode(report),
            Self::Wacom(table) => table.decode(report),
            Self::Events(pen) => pen.decode(report),
        }
    }
}

/// Means of reading a device.
#[derive(Clone, Debug)]
pub enum Means {
    /// A pen.
    Pen(Decoder),
    /// A 6-DOF mouse.
    SpaceMouse,
}

/// Means of reading a device, by its numbers and its descriptor.
///
/// # Errors
/// An [`UnfitDevice`].
pub fn means(kind: Kind, identity: &Identity, bytes: &[u8]) -> Result<Means, UnfitDevice> {
    let means = match kind {
        Kind::Pen => hid_pen(identity, bytes),
        Kind::EventPen => event_pen(bytes),
        Kind::SpaceMouse => space_mouse(identity, bytes),
    };
    means.map_err(|why| UnfitDevice {
        identity: identity.clone(),
        why,
    })
}

/// The pen of a HID device.
fn hid_pen(identity: &Identity, bytes: &[u8]) -> Result<Means, Unfit> {
    let table = Wacom::of(identity.vendor, identity.product);
    if let Some(table) = table.filter(|table| table.fits(bytes)) {
        return Ok(Means::Pen(Decoder::Wacom(table)));
    }
    let descriptor = descriptor::read(bytes)?;
    match Layout::of(&descriptor) {
        Some(layout) => Ok(Means::Pen(Decoder::Described(layout))),
        None if lies_anywhere(&descriptor, is_pen) => Err(Unfit::NoPlace),
        None => Err(Unfit::NoPen(outermost(&descriptor))),
    }
}

/// A 6-DOF mouse.
fn space_mouse(identity: &Identity, bytes: &[u8]) -> Result<Means, Unfit> {
    let descriptor = descriptor::read(bytes)?;
    if !lies_anywhere(&descriptor, has_six_axes) {
        Err(Unfit::NoMouse(outermost(&descriptor)))
    } else if VENDORS.contains(&identity.vendor) {
        Ok(Means::SpaceMouse)
    } else {
        Err(Unfit::UnknownMaker)
    }
}

/// The pen of an event device.
fn event_pen(bytes: &[u8]) -> Result<Means, Unfit> {
    let capabilities = Capabilities::from_bytes(bytes).ok_or(Unfit::NoEvents)?;
    let pen = EvdevPen::of(&capabilities).ok_or(Unfit::NoAxes)?;
    Ok(Means::Pen(Decoder::Events(Box::new(pen))))
}

fn is_pen((page, usage): (u16, u16)) -> bool {
    Collection { page, usage }.is_pen()
}

fn has_six_axes((page, usage): (u16, u16)) -> bool {
    Collection { page, usage }.has_six_axes()
}

/// True if a device reports anything in a collection of such a usage.
fn lies_anywhere(
    descriptor: &hidreport::ReportDescriptor,
    wanted: impl Fn((u16, u16)) -> bool,
) -> bool {
    use hidreport::Report as _;
    let reports = descriptor.input_reports().iter();
    reports
        .flat_map(|report| report.fields().iter())
        .any(|field| descriptor::lies_in(field, &wanted))
}

/// Initialisation that some tablets need before they report: XP-Pen's Deco L (from OpenTabletDriver).
const BEGINNINGS: [(u16, u16, &[u8]); 1] = [(0x28BD, 0x0935, &[0x02, 0xB0, 0x04])];

/// A device that is open.
pub struct Opened {
    /// It.
    pub source: Box<dyn HidSource>,
    /// Its identity.
    pub identity: Identity,
    /// Means of reading it; a device that was asked for by its address and cannot be read may still be recorded.
    pub means: Result<Means, UserError>,
}

/// Opens the first device that suits.
///
/// # Errors
/// A [`UserError`] that says what is missing: tried again later, it may be there.
pub fn open(ports: &mut dyn Ports, kind: Kind, address: &Address) -> Result<Opened, UserError> {
    let all = ports.list()?;
    let mut found: Vec<_> = all.iter().filter(|found| address.names(found)).collect();
    if found.is_empty() {
        return Err(missing(kind, address, &all));
    }
    // One that is asked for is looked at even if it seems to be something else.
    let is_any = *address == Address::Any;
    found.sort_by_key(|found| !kind.suits(found));
    found.retain(|found| !is_any || kind.suits(found));
    let mut first: Option<Result<Opened, UserError>> = None;
    for found in found {
        let opened = ports.open(found).map(|source| {
            let identity = found.identity.clone();
            let means = means(kind, &identity, source.descriptor()).map_err(UserError::from);
            Opened {
                source,
                identity,
                means,
            }
        });
        match opened {
            Ok(mut opened) if opened.means.is_ok() => {
                begin(kind, &mut opened);
                return Ok(opened);
            }
            other => first = first.or(Some(other)),
        }
    }
    match first {
        None => Err(missing(kind, address, &all)),
        Some(Ok(Opened {
            means: Err(fault), ..
        })) if is_any => Err(fault),
        Some(other) => other,
    }
}

/// Tells a device what it waits for. That it refuses is no reason not to listen.
fn begin(kind: Kind, opened: &mut Opened) {
    let numbers = (opened.identity.vendor, opened.identity.product);
    if kind == Kind::Pen
        && let Err(fault) = opened.source.grab()
    {
        let place = fault.place.unwrap_or_default();
        tracing::warn!("{}: {place}: {}", opened.identity, fault.what);
    }
    let order = match kind {
        Kind::EventPen => None,
        Kind::SpaceMouse => Some(&LIGHT[..]),
        Kind::Pen => BEGINNINGS
            .iter()
            .find(|(vendor, product, _)| (*vendor, *product) == numbers)
            .map(|(.., order)| *order),
    };
    if let Some(Err(fault)) = order.map(|order| opened.source.write(order)) {
        tracing::warn!("{}", fault.what);
    }
}

/// The error that no device suits, among these.
#[must_use]
pub fn missing(kind: Kind, address: &Address, all: &[Found]) -> UserError {
    let mut there: Vec<_> = all.iter().map(|found| found.identity.to_string()).collect();
    there.dedup();
    let what = match address {
        Address::Any => format!("no {} is plugged in", kind.word()),
        Address::Numbers(vendor, product) => format!("no {vendor:04x}:{product:04x} is plugged in"),
        Address::Path(path) => format!("no HID device is plugged in at {path}"),
    };
    UserError::failure(what).help(if there.is_empty() {
        "plug it in".to_owned()
    } else {
        format!("plug it in; there are {}", there.join(", "))
    })
}

/// Description of a device for the log.
#[must_use]
pub fn description(identity: &Identity, means: &Means) -> String {
    match means {
        Means::Pen(decoder) => {
            let [width, height] = decoder.area_m().map(|side| (1e3 * side).round());
            let place = &identity.place;
            format!("{identity} at {place}, {width} x {height} mm")
        }
        Means::SpaceMouse => {
            let known = SpaceMouse::called(identity.vendor, identity.product);
            format!(
                "{identity} at {} ({})",
                identity.place,
                known.unwrap_or("6-DOF mouse")
            )
        }
    }
}
