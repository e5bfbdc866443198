//! Where in a tablet's reports its pen is, by the report descriptor.
//!
//! Usages are those of the digitizers' page 0x0D and of X and Y of page 0x01 (HID usage tables), and Wacom's
//! page 0xFF0D, which mirrors them and is finer. A tablet may have reports of both kinds for one pen: of
//! those, Wacom's are read alone. Lengths and angles come from physical ranges and units. Where there are none:
//!
//! | what | is taken for |
//! | --- | --- |
//! | X, Y | 5080 counts an inch; an area of less than 1 cm or more than 2 m is taken for 25 cm on its longer side |
//! | tilts | degrees, where the range is signed and within ±180, else the range is ±90° |
//! | twist, azimuth | degrees, where the range is signed and within ±360, else the range is once round |
//! | altitude | degrees, where the range is signed and within ±90, else the range is up to upright |
//! | distance | the range is 1 cm; so where it is more than 10 cm |
//! | pressure | a touch of a pen without has half |
//! | tip switch | a pen without touches while it has pressure |
//! | in range | a pen without is near from a report on, until it has neither touched nor reported for a second |
//!
//! Units and physical ranges hold from field to field, so one that a descriptor forgot to take back is another field's. It
//! counts as none for an angle that is no angle's: of another unit and as X or Y has it, or not within a turn.
//!
//! A device may leave off the end of a report. It is read where it says where the pen is and whether it touches; tilts,
//! twist, height and switches that were left off are as of a pen without them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use hidreport::{Field, Report, ReportDescriptor};
use maulstick_num::{atan2, sin_cos};
use maulstick_types::stylus::axes;

use maulstick_device::pen::{End, Presence, Reading, STEEPEST_RAD};

use crate::descriptor::{lies_in, page, pair};
use crate::reports::number::Number;

/// Counts a metre of a tablet that does not say, 5080 an inch.
pub(crate) const COUNTS_M: f64 = 200_000.0;
/// Sides of a tablet, m; beyond them its descriptor is wrong.
const SIDES_M: [f64; 2] = [0.01, 2.0];
/// Longer side of a tablet whose descriptor is wrong, m.
const LONGER_M: f64 = 0.25;
/// Hover height at the end of a range without units, m.
pub(crate) const HIGHEST_M: f64 = 0.01;
/// No tablet senses a pen from farther, m.
const FARTHEST_HOVER_M: f64 = 0.1;
/// Pressure of a touch without a pressure field.
pub(crate) const PRESSED: f64 = 0.5;

/// Role of a report's field for a pen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Role {
    X,
    Y,
    /// Grows with the height.
    Distance,
    /// Shrinks with the height, for HID's Z points down.
    Depth,
    Pressure,
    Tip,
    Eraser,
    Invert,
    InRange,
    /// By its bit.
    Switch(u32),
    TiltX,
    TiltY,
    Azimuth,
    Altitude,
    Twist,
}

impl Role {
    fn of(usage: (u16, u16)) -> Option<Self> {
        Some(match usage {
            (page::DESKTOP, 0x30) | (page::WACOM, 0x130) => Self::X,
            (page::DESKTOP, 0x31) | (page::WACOM, 0x131) => Self::Y,
            (page::DESKTOP, 0x32) => Self::Depth,
            (page::WACOM, 0x132) => Self::Distance,
            (page::DIGITIZER | page::WACOM, id) => match id {
                0x30 => Self::Pressure,
                0x32 => Self::InRange,
                0x3C => Self::Invert,
                0x3D => Self::TiltX,
                0x3E => Self::TiltY,
                0x3F => Self::Azimuth,
                0x40 => Self::Altitude,
                0x41 => Self::Twist,
                0x42 | 0x43 => Self::Tip,
                0x44 => Self::Switch(0),
                // Tablet pick is what XP-Pen calls its second switch.
                0x5A | 0x46 => Self::Switch(1),
                0x45 => Self::Eraser,
                _ => return None,
            },
            _ => return None,
        })
    }

    fn is_angle(self) -> bool {
        matches!(
            self,
            Self::TiltX | Self::TiltY | Self::Azimuth | Self::Altitude | Self::Twist
        )
    }

    /// True if a report without it still says where a pen is and whether it touches.
    fn may_lack(self) -> bool {
        let others = matches!(self, Self::Distance | Self::Depth | Self::Switch(_));
        self.is_angle() || others
    }
}

/// Takes physical ranges from angles that they were not meant for: without a unit of angle, and as X or Y has them.
fn drop_lengths_of_angles(numbers: &mut [(Role, Number)]) {
    let lengths = numbers
        .iter()
        .filter(|(role, _)| matches!(role, Role::X | Role::Y));
    let lengths: Vec<[f64; 2]> = lengths.filter_map(|(_, number)| number.physical).collect();
    let angles = numbers.iter_mut().filter(|(role, _)| role.is_angle());
    for (_, number) in angles.filter(|(_, number)| number.radians.is_none()) {
        number.physical = number.physical.filter(|range| !lengths.contains(range));
    }
}

/// The sides of a tablet of so many counts, m: as it says, unless that is no tablet's.
pub(crate) fn plausible_m(sides_m: [f64; 2], counts: [f64; 2]) -> [f64; 2] {
    let [least, most] = SIDES_M;
    if sides_m.iter().all(|side| (least..=most).contains(side)) {
        return sides_m;
    }
    let longer = counts[0].max(counts[1]);
    counts.map(|count| (count / longer * LONGER_M).max(least))
}

/// The reports of one pen.
#[derive(Clone, Debug)]
pub struct Layout {
    reports: Vec<PenReport>,
    area_m: [f64; 2],
    senses: u32,
    tells_range: bool,
}

/// A report that says where the pen is.
#[derive(Clone, Debug)]
struct PenReport {
    id: Option<u8>,
    /// Bytes up to the end of the last field that it is not read without.
    bytes: usize,
    is_wacoms: bool,
    numbers: Vec<(Role, Number)>,
}

impl Layout {
    /// Finds the pen of a descriptor; `None` if it has no pen.
    #[must_use]
    pub fn of(descriptor: &ReportDescriptor) -> Option<Self> {
        let reports = descriptor.input_reports().iter();
        let mut reports: Vec<_> = reports.filter_map(PenReport::of).collect();
        let wacoms = reports.iter().any(|report| report.is_wacoms);
        reports.retain(|report| report.is_wacoms == wacoms);
        let first = reports.first()?;
        let area_m = first.area_m();
        let mut senses = axes::POSITION | axes::PROXIMITY;
        for (role, _) in reports.iter().flat_map(|report| &report.numbers) {
            senses |= match role {
                Role::Pressure => axes::PRESSURE,
                Role::TiltX | Role::Azimuth => axes::TILT,
                Role::Twist => axes::TWIST,
                Role::Switch(_) => axes::SWITCHES,
                _ => 0,
            };
        }
        let tells_range = reports
            .iter()
            .any(|report| report.number(Role::InRange).is_some());
        Some(Self {
            reports,
            area_m,
            senses,
            tells_range,
        })
    }

    /// Width and height of the active area, m.
    #[must_use]
    pub fn area_m(&self) -> [f64; 2] {
        self.area_m
    }

    /// Axes that the pen senses, see [`axes`].
    #[must_use]
    pub fn senses(&self) -> u32 {
        self.senses
    }

    /// True if the reports signal that the pen is away.
    #[must_use]
    pub fn tells_range(&self) -> bool {
        self.tells_range
    }

    /// Reads a report; nothing where it is another's than the pen's, or ends before it says where the pen is and whether
    /// it touches.
    #[must_use]
    pub fn decode(&self, report: &[u8]) -> Option<Reading> {
        let fits = |pen: &&PenReport| match pen.id {
            Some(id) => report.first() == Some(&id),
            None => true,
        };
        let pen = self.reports.iter().find(fits)?;
        (report.len() >= pen.bytes).then(|| pen.decode(report, self.area_m))
    }
}

impl PenReport {
    fn of(report: &impl Report) -> Option<Self> {
        let is_pen = |usage: (u16, u16)| match usage {
            (page::DIGITIZER, id) => matches!(id, 0x01 | 0x02 | 0x20),
            (page::WACOM, _) => true,
            _ => false,
        };
        let mut is_wacoms = false;
        let mut numbers: Vec<(Role, Number)> = Vec::new();
        for field in report
            .fields()
            .iter()
            .filter(|field| lies_in(field, is_pen))
        {
            let Field::Variable(variable) = field else {
                continue;
            };
            let usage = pair(&variable.usage);
            let Some(role) = Role::of(usage) else {
                continue;
            };
            // Of several pens in a report the first is read, but both tip switches are the tip.
            let is_known = numbers.iter().any(|(known, _)| *known == role);
            if let (false, Some(number)) = (is_known && role != Role::Tip, Number::new(variable)) {
                is_wacoms |= role == Role::X && usage.0 == page::WACOM;
                numbers.push((role, number));
            }
        }
        let has = |role: Role| numbers.iter().any(|(known, _)| *known == role);
        let is_pen = has(Role::X) && has(Role::Y) && (has(Role::Tip) || has(Role::Pressure));
        if !is_pen {
            return None;
        }
        drop_lengths_of_angles(&mut numbers);
        let needed = numbers.iter().filter(|(role, _)| !role.may_lack());
        Some(Self {
            id: report.report_id().map(u8::from),
            bytes: needed.map(|(_, number)| number.end()).max().unwrap_or(0),
            is_wacoms,
            numbers,
        })
    }

    fn number(&self, role: Role) -> Option<&Number> {
        let found = self.numbers.iter().find(|(known, _)| *known == role);
        found.map(|(_, number)| number)
    }

    /// The number of a role, if a report is long enough to have it.
    fn sent(&self, report: &[u8], role: Role) -> Option<&Number> {
        self.number(role)
            .filter(|number| number.end() <= report.len())
    }

    fn area_m(&self) -> [f64; 2] {
        let counts = [Role::X, Role::Y].map(|role| {
            let number = self.number(role);
            number.map_or((1.0, None), |number| {
                (number.most - number.least, number.metres)
            })
        });
        // One axis may say what both are.
        let known = counts[0].1.or(counts[1].1).unwrap_or(1.0 / COUNTS_M);
        let sides = counts.map(|(count, metres)| count * metres.unwrap_or(known));
        plausible_m(sides, counts.map(|(count, _)| count))
    }

    /// State of a switch; `None` if there is no such switch.
    fn is_on(&self, report: &[u8], role: Role) -> Option<bool> {
        let mut all = self.numbers.iter().filter(|(known, _)| *known == role);
        let first = all.next()?.1.count(report) > 0.0;
        Some(first || all.any(|(_, number)| number.count(report) > 0.0))
    }

    fn decode(&self, report: &[u8], area_m: [f64; 2]) -> Reading {
        let share = |role| self.sent(report, role).map(|number| number.share(report));
        let is_on = |role| self.is_on(report, role);
        let pressure = share(Role::Pressure);
        let touches = is_on(Role::Tip).unwrap_or(pressure > Some(0.0));
        let erases = is_on(Role::Eraser).unwrap_or(false);
        let presence = if touches || erases {
            Presence::Touching
        } else if is_on(Role::InRange).unwrap_or(true) {
            Presence::Hovering
        } else {
            Presence::Away
        };
        let switches = self.numbers.iter().filter_map(|(role, number)| match role {
            Role::Switch(bit) if number.count(report) > 0.0 => Some(1 << bit),
            _ => None,
        });
        Reading {
            presence,
            end: if erases || is_on(Role::Invert).unwrap_or(false) {
                End::Eraser
            } else {
                End::Tip
            },
            point_m: [
                share(Role::X).unwrap_or(0.0) * area_m[0],
                // A tablet counts toward the hand.
                (1.0 - share(Role::Y).unwrap_or(0.0)) * area_m[1],
            ],
            height_m: self.height_m(report),
            pressure: pressure.unwrap_or(PRESSED),
            tilt_rad: self.tilt_rad(report),
            twist_rad: self.twist_rad(report),
            switches: switches.fold(0, |all: u32, bit: u32| all | bit),
        }
    }

    fn height_m(&self, report: &[u8]) -> f64 {
        let height = |number: &Number, share: f64| {
            let range = number
                .metres
                .map(|count| count * (number.most - number.least))
                .filter(|range| *range <= FARTHEST_HOVER_M);
            share * range.unwrap_or(HIGHEST_M)
        };
        if let Some(distance) = self.sent(report, Role::Distance) {
            return height(distance, distance.share(report));
        }
        self.sent(report, Role::Depth)
            .map_or(0.0, |depth| height(depth, 1.0 - depth.share(report)))
    }

    /// X tilt is to the right, Y tilt toward the hand; azimuth goes counter-clockwise from x, and altitude
    /// up from the tablet.
    fn tilt_rad(&self, report: &[u8]) -> Option<[f64; 2]> {
        let tilt = |role| {
            let number = self.sent(report, role)?;
            Some(number.angle(report, 180.0, PI, 0.5))
        };
        if let (Some(x), Some(y)) = (tilt(Role::TiltX), tilt(Role::TiltY)) {
            return Some([x, -y].map(|tilt| tilt.clamp(-STEEPEST_RAD, STEEPEST_RAD)));
        }
        let azimuth = self
            .sent(report, Role::Azimuth)?
            .angle(report, 360.0, TAU, 0.0);
        let altitude = self.sent(report, Role::Altitude)?;
        let altitude = if altitude.is_signed() {
            altitude.angle(report, 90.0, PI, 0.5).abs()
        } else {
            // Altitudes above the tablet alone.
            altitude.angle(report, 90.0, FRAC_PI_2, 0.0)
        };
        let ((sin_up, cos_up), (sin, cos)) = (sin_cos(altitude), sin_cos(azimuth));
        Some([cos, sin].map(|along| {
            atan2(along * cos_up, sin_up.max(1e-9)).clamp(-STEEPEST_RAD, STEEPEST_RAD)
        }))
    }

    /// HID counts a twist clockwise for who looks from above.
    fn twist_rad(&self, report: &[u8]) -> Option<f64> {
        let clockwise = self
            .sent(report, Role::Twist)?
            .angle(report, 360.0, TAU, 0.0);
        Some(wrapped(-clockwise))
    }
}

/// The same angle within −π and π, rad.
#[must_use]
pub fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
