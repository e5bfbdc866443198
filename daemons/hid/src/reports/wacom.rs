//! Wacom's tablets whose descriptors do not say where the pen is: Intuos 4 and 5, Intuos Pro 1 and 2.
//!
//! Bits are facts of Linux's `wacom_wac.c` and of OpenTabletDriver, sizes of the former, those of Intuos Pro 2
//! its active area as Wacom gives it. X and Y have 200 counts a millimetre and count from the upper left
//! corner.

use maulstick_types::stylus::axes;

use maulstick_device::pen::{End, Presence, Reading, STEEPEST_RAD};

use crate::descriptor::input_bytes;

/// Counts a metre.
const COUNTS_M: f64 = 200_000.0;
/// Numbers of Wacom.
pub const VENDOR: u16 = 0x056A;

/// Layout of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    /// Report 2 of ten bytes, big endian, 2047 of pressure.
    Intuos4,
    /// Report 0x10, little endian, 8191 of pressure.
    IntuosPro2,
}

/// A tablet of this table.
#[derive(Clone, Debug, PartialEq)]
pub struct Wacom {
    format: Format,
    counts: [u32; 2],
    /// Intuos 4: which end was brought near. A report of it comes once each time, so of a pen that was near
    /// before the first report nothing is known until it was away.
    end: Option<End>,
}

/// Product, its format, X and Y counts.
const TABLETS: [(u16, Format, [u32; 2]); 14] = [
    (0x00B8, Format::Intuos4, [31_496, 19_685]),
    (0x00B9, Format::Intuos4, [44_704, 27_940]),
    (0x00BA, Format::Intuos4, [65_024, 40_640]),
    (0x00BB, Format::Intuos4, [97_536, 60_960]),
    (0x0026, Format::Intuos4, [31_496, 19_685]),
    (0x0027, Format::Intuos4, [44_704, 27_940]),
    (0x0028, Format::Intuos4, [65_024, 40_640]),
    (0x0029, Format::Intuos4, [31_496, 19_685]),
    (0x002A, Format::Intuos4, [44_704, 27_940]),
    (0x0314, Format::Intuos4, [31_496, 19_685]),
    (0x0315, Format::Intuos4, [44_704, 27_940]),
    (0x0317, Format::Intuos4, [65_024, 40_640]),
    (0x0357, Format::IntuosPro2, [44_800, 29_600]),
    (0x0358, Format::IntuosPro2, [62_200, 43_200]),
];

impl Wacom {
    /// The tablet of these numbers, if it is of this table.
    #[must_use]
    pub fn of(vendor: u16, product: u16) -> Option<Self> {
        let found = TABLETS.iter().find(|(known, ..)| *known == product);
        found
            .filter(|_| vendor == VENDOR)
            .map(|(_, format, counts)| Self {
                format: *format,
                counts: *counts,
                end: None,
            })
    }

    /// True if an interface is the pen's, by its descriptor; such a tablet may have another for touch, whose report 2
    /// has 64 bytes.
    #[must_use]
    pub fn fits(&self, descriptor: &[u8]) -> bool {
        match self.format {
            Format::Intuos4 => {
                input_bytes(descriptor, 2).is_some_and(|bytes| (10..64).contains(&bytes))
            }
            Format::IntuosPro2 => input_bytes(descriptor, 0x10).is_some_and(|bytes| bytes >= 17),
        }
    }

    /// Width and height of the active area, m.
    #[must_use]
    pub fn area_m(&self) -> [f64; 2] {
        self.counts.map(|count| f64::from(count) / COUNTS_M)
    }

    /// Axes that the pen senses, see [`axes`].
    #[must_use]
    pub fn senses(&self) -> u32 {
        axes::POSITION | axes::PROXIMITY | axes::PRESSURE | axes::TILT | axes::SWITCHES
    }

    /// Reads a report; nothing where it is no pen's, or too short.
    pub fn decode(&mut self, report: &[u8]) -> Option<Reading> {
        match self.format {
            Format::Intuos4 => self.intuos4(report),
            Format::IntuosPro2 => self.intuos_pro2(report),
        }
    }

    fn intuos4(&mut self, report: &[u8]) -> Option<Reading> {
        let [2, flags, x0, x1, y0, y1, d6, d7, d8, d9, ..] = *report else {
            return None;
        };
        match flags {
            // The pen came near: its tool's number, of which bit 3 is that of the eraser.
            flags if flags & 0xFC == 0xC0 => {
                let tool = u16::from(x0) << 4 | u16::from(x1) >> 4;
                self.end = Some(if tool & 8 != 0 { End::Eraser } else { End::Tip });
                return None;
            }
            // It is gone, or is about to go: sensed still, but no more said of.
            flags if matches!(flags & 0xFE, 0x80 | 0x20) => {
                return Some(Reading {
                    end: self.end.unwrap_or(End::Tip),
                    ..Reading::AWAY
                });
            }
            // Of what else is put on the tablet (mice, wheels of airbrushes) the flags are others.
            flags if flags & 0xB8 != 0xA0 => return None,
            _ => {}
        }
        let end = self.end?;
        let wide = |high: u8, low: u8, bit: u8| {
            u32::from(high) << 9 | u32::from(low) << 1 | u32::from(bit & 1)
        };
        let pressure = u32::from(d6) << 3 | u32::from(d7 & 0xC0) >> 5 | u32::from(flags & 1);
        let tilt = [
            f64::from((d7 << 1) & 0x7E | d8 >> 7) - 64.0,
            f64::from(d8 & 0x7F) - 64.0,
        ];
        let near = [wide(x0, x1, d9 >> 1), wide(y0, y1, d9)];
        // These tablets have no tip switch; the kernel takes more than 10 of 2047 for a touch.
        let touches = pressure > 10;
        Some(self.reading(
            near,
            [f64::from(pressure) / 2047.0, f64::from(d9 >> 2) / 63.0],
            tilt,
            touches,
            end,
            u32::from(flags >> 1 & 3),
        ))
    }

    fn intuos_pro2(&self, report: &[u8]) -> Option<Reading> {
        let [
            0x10,
            flags,
            x0,
            x1,
            x2,
            y0,
            y1,
            y2,
            p0,
            p1,
            tilt_x,
            tilt_y,
            _,
            _,
            _,
            _,
            distance,
            ..,
        ] = *report
        else {
            return None;
        };
        let end = if flags & 0x10 != 0 {
            End::Eraser
        } else {
            End::Tip
        };
        if flags & 0x20 == 0 {
            return Some(Reading {
                end,
                ..Reading::AWAY
            });
        }
        let wide = |low, middle, high| u32::from_le_bytes([low, middle, high, 0]);
        let pressure = u16::from_le_bytes([p0, p1]);
        let tilt = [tilt_x, tilt_y].map(|tilt| f64::from(tilt.cast_signed()));
        Some(self.reading(
            [wide(x0, x1, x2), wide(y0, y1, y2)],
            [f64::from(pressure) / 8191.0, f64::from(distance) / 63.0],
            tilt,
            flags & 1 != 0,
            end,
            u32::from(flags >> 1 & 3),
        ))
    }

    /// Of counts, pressure and distance as shares, and tilts in degrees to the right and toward the hand.
    fn reading(
        &self,
        counts: [u32; 2],
        [pressure, distance]: [f64; 2],
        [tilt_x, tilt_y]: [f64; 2],
        touches: bool,
        end: End,
        switches: u32,
    ) -> Reading {
        let at = |axis: usize| f64::from(counts[axis].min(self.counts[axis])) / COUNTS_M;
        let tilt = |degrees: f64| degrees.to_radians().clamp(-STEEPEST_RAD, STEEPEST_RAD);
        Reading {
            presence: if touches {
                Presence::Touching
            } else {
                Presence::Hovering
            },
            end,
            point_m: [at(0), self.area_m()[1] - at(1)],
            height_m: 0.01 * distance.min(1.0),
            pressure: pressure.min(1.0),
            tilt_rad: Some([tilt(tilt_x), tilt(-tilt_y)]),
            twist_rad: None,
            switches,
        }
    }
}
