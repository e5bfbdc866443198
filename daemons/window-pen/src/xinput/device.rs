//! A pen of an X server, from its valuators and buttons.

use maulstick_device::pen::{End, Presence, Reading};
use x11rb::protocol::xinput::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ButtonPressEvent, DeviceClassData,
    DeviceClassDataValuator, Fp3232, ValuatorMode, XIDeviceInfo,
};
use x11rb::protocol::xproto::Atom;

use super::tool;
use crate::reading::{Axes, PenReading};

/// Units of a tilt per radian at least and at most, where its resolution says so: drivers give a degree a unit.
const PER_RADIAN: std::ops::RangeInclusive<u32> = 20..=10_000;
/// Tilt at the ends of a range that says no more, degrees.
const STEEPEST_DEGREES: f64 = 64.0;
/// Words in the names of devices that have a pressure and are no pens.
const NO_PENS: [&str; 5] = ["pad", "touch", "finger", "cursor", "mouse"];
/// Kinds of tools that sense their rotation: the Art Pens of Wacom. All others send the wheel's least value.
const ROTATES: [u32; 3] = [0x804, 0x885, 0x10_0804];
/// The button of the tip, and of the switches on the handle, that nearest to the tip first.
const TIP: u32 = 1;
const SWITCHES: [u32; 3] = [2, 3, 8];

/// Names of valuators, as atoms of the server.
#[derive(Clone, Copy, Debug, Default)]
pub struct Labels {
    /// Of pressure.
    pub pressure: Atom,
    /// Of tilt, toward the right and toward the hand.
    pub tilt: [Atom; 2],
    /// Of rotation, or of an airbrush's wheel.
    pub wheel: Atom,
}

/// The tool that is near a device, as the driver `wacom` names it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NearTool {
    /// Its serial number; 0 if none is near.
    pub serial: u32,
    /// Its kind.
    pub kind: u32,
}

/// A valuator: its place among those of the device, and its range.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Valuator {
    place: usize,
    least: f64,
    most: f64,
    per_radian: u32,
    value: f64,
}

fn number(fixed: Fp3232) -> f64 {
    f64::from(fixed.integral) + f64::from(fixed.frac) / 4_294_967_296.0
}

impl Valuator {
    fn of(told: &DeviceClassDataValuator) -> Option<Self> {
        let valuator = Self {
            place: told.number.into(),
            least: number(told.min),
            most: number(told.max),
            per_radian: told.resolution,
            value: number(told.value),
        };
        let absolute = told.mode == ValuatorMode::ABSOLUTE;
        (absolute && valuator.most > valuator.least).then_some(valuator)
    }

    /// Its share of its range.
    fn share(&self) -> f64 {
        ((self.value - self.least) / (self.most - self.least)).clamp(0.0, 1.0)
    }

    /// A tilt, rad.
    fn tilt_rad(&self) -> f64 {
        if PER_RADIAN.contains(&self.per_radian) {
            self.value / f64::from(self.per_radian)
        } else {
            let middle = 0.5 * (self.least + self.most);
            let steepest = STEEPEST_DEGREES.to_radians();
            (self.value - middle) / (self.most - middle) * steepest
        }
    }

    /// A rotation, rad: its range is a whole turn, clockwise.
    fn twist_rad(&self) -> f64 {
        -(self.value / (self.most - self.least)) * std::f64::consts::TAU
    }
}

/// A pen of an X server.
#[derive(Clone, Debug, PartialEq)]
pub struct XinputDevice {
    id: u16,
    pressure: Valuator,
    tilt: Option<[Valuator; 2]>,
    wheel: Option<Valuator>,
    eraser: bool,
    /// The tool that is near, where the driver says so.
    near: Option<NearTool>,
    newest: Option<PenReading>,
}

impl XinputDevice {
    /// A device of the server, if it is a pen.
    #[must_use]
    pub fn of(info: &XIDeviceInfo, labels: &Labels) -> Option<Self> {
        let valuators = info.classes.iter().filter_map(|class| match &class.data {
            DeviceClassData::Valuator(told) => Some(told),
            _ => None,
        });
        let find = |label: Atom| {
            let mut all = valuators.clone();
            let found = all.find(|told| told.label == label);
            found.and_then(Valuator::of)
        };
        let name = String::from_utf8_lossy(&info.name).to_lowercase();
        let mut words = name.split(|letter: char| !letter.is_alphanumeric());
        if words.any(|word| NO_PENS.contains(&word)) {
            return None;
        }
        Some(Self {
            id: info.deviceid,
            pressure: find(labels.pressure)?,
            tilt: match labels.tilt.map(find) {
                [Some(x), Some(y)] => Some([x, y]),
                _ => None,
            },
            wheel: find(labels.wheel),
            eraser: name.contains("eraser"),
            near: None,
            newest: None,
        })
    }

    /// Axes that it senses.
    #[must_use]
    pub fn axes(&self) -> Axes {
        Axes {
            pressure: true,
            tilt: self.tilt.is_some(),
            twist: self.rotation().is_some(),
            range: self.near.is_some(),
        }
    }

    /// Its wheel, where that is the rotation of its tool.
    fn rotation(&self) -> Option<&Valuator> {
        let rotates = self.near.is_some_and(|near| ROTATES.contains(&near.kind));
        self.wheel.as_ref().filter(|_| rotates)
    }

    /// Sets the tool that is near it, where its driver says so.
    pub fn set_near(&mut self, near: Option<NearTool>) {
        self.near = near;
    }

    /// True if the server describes both in the same way.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        let ranges = |device: &Self| {
            let tilts = device.tilt.iter().flatten();
            let all = [&device.pressure]
                .into_iter()
                .chain(tilts)
                .chain(&device.wheel);
            all.map(|it| (it.place, it.least, it.most, it.per_radian))
                .collect::<Vec<_>>()
        };
        (self.id, self.eraser) == (other.id, other.eraser) && ranges(self) == ranges(other)
    }

    /// Its reading at an event; `None` where the event is not of its own.
    pub fn read(&mut self, event: &ButtonPressEvent) -> Option<PenReading> {
        if event.deviceid != self.id {
            return None;
        }
        self.take_values(&event.valuator_mask, &event.axisvalues);
        let is_down = |button: u32| {
            let word = event.button_mask.get(button as usize / 32);
            word.is_some_and(|word| word >> (button % 32) & 1 == 1)
        };
        // The mask is that of before the event.
        let down = |button: u32| match (event.event_type, event.detail == button) {
            (BUTTON_PRESS_EVENT, true) => true,
            (BUTTON_RELEASE_EVENT, true) => false,
            _ => is_down(button),
        };
        let switches = SWITCHES
            .iter()
            .enumerate()
            .filter(|(_, button)| down(**button));
        let [x, y] = [event.event_x, event.event_y].map(|at| f64::from(at) / 65_536.0);
        let reading = Reading {
            presence: if down(TIP) {
                Presence::Touching
            } else {
                Presence::Hovering
            },
            end: if self.eraser { End::Eraser } else { End::Tip },
            point_m: [0.0; 2],
            height_m: 0.0,
            pressure: self.pressure.share(),
            // Theirs leans toward the hand with y.
            tilt_rad: self.tilt.map(|[x, y]| [x.tilt_rad(), -y.tilt_rad()]),
            twist_rad: self.rotation().map(Valuator::twist_rad),
            switches: switches.fold(0, |all, (place, _)| all | 1 << place),
        };
        // The driver names the tool a little after its first events: until it leaves it stays the one that it began as.
        let serial = self.near.map_or(0, |near| near.serial);
        let began = self.newest.map(|newest| newest.tool);
        let read = PenReading {
            tool: began.unwrap_or_else(|| tool(self.id, serial, self.eraser)),
            axes: self.axes(),
            time_ms: event.time,
            point_px: [x, y],
            reading,
        };
        self.newest = Some(read);
        Some(read)
    }

    /// Its tool has left, if its driver says that none is near.
    pub fn left(&mut self, time_ms: u32) -> Option<PenReading> {
        if self.near.is_none_or(|near| near.serial != 0) {
            return None;
        }
        let newest = self.newest.take()?;
        Some(PenReading {
            time_ms,
            reading: Reading {
                presence: Presence::Away,
                ..newest.reading
            },
            ..newest
        })
    }

    /// Stores the values of the valuators that an event has.
    fn take_values(&mut self, mask: &[u32], values: &[Fp3232]) {
        let told = (0..32 * mask.len()).filter(|place| mask[place / 32] >> (place % 32) & 1 == 1);
        for (place, value) in told.zip(values) {
            let tilts = self.tilt.iter_mut().flatten();
            let own = [&mut self.pressure]
                .into_iter()
                .chain(tilts)
                .chain(&mut self.wheel);
            for valuator in own.filter(|valuator| valuator.place == place) {
                valuator.value = number(*value);
            }
        }
    }
}
